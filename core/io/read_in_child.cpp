#include "core/io/read_in_child.h"

#include <optional>
#include <type_traits>

#include "core/base/bytes.h"
#include "core/base/child_process.h"

namespace lamella {
namespace {

// What goes through the pipe, in one order for both ends: `io` writes or reads.
template <class Io, class C>
void members(Io& io, C& content) requires std::is_same_v<std::remove_const_t<C>, MeshContent> {
  auto& mesh = content.mesh;
  io.array(mesh.points);
  io.array(mesh.elements);
  io.array(mesh.element_body);
  io.array(mesh.facets);
  io.array(mesh.facet_group);
  io.array(mesh.facet_face);
  io.list(mesh.bodies, [&](auto& name) { io.text(name); });
  io.list(mesh.groups, [&](auto& name) { io.text(name); });
  io.array(content.metric);
  io.array(content.thickness);
  io.array(content.layers);
  io.array(content.quality);
  io.list(content.of_elements, [&](auto& field) {
    io.text(field.name);
    io.array(field.values);
  });
  io.list(content.of_nodes, [&](auto& field) {
    io.text(field.name);
    io.value(field.components);
    io.array(field.values);
  });
  io.list(content.tensors, [&](auto& field) {
    io.text(field.name);
    io.value(field.of_nodes);
    io.array(field.values);
  });
  io.value(content.unit);
  io.text(content.provenance);
}

}  // namespace

Result<MeshContent> read_in_child(
    const std::filesystem::path& file,
    const std::function<Result<MeshContent>(const std::filesystem::path&, const Progress&)>& read,
    const Progress& progress) {
  std::error_code ec;
  const std::uintmax_t found = std::filesystem::file_size(file, ec);
  const double size = ec ? 0 : static_cast<double>(found);
  const ChildLimits limits{60 + 1e-6 * size, static_cast<std::uint64_t>(1e9 + 100 * size)};
  const auto damaged = [&](const std::string& how) {
    return Error{Code::bad_input, "\"" + file.string() + "\": it could not be read, " + how,
                 "The file is likely damaged; write or copy it again."};
  };
  MeshContent content;
  std::optional<Error> error;
  bool whole = false;
  const Result<void> done = stream_from_child(
      [&](const ByteSink& sink, const Progress& through) {
        const Result<MeshContent> result = read(file, through);
        ByteWriter out(sink);
        const std::optional<Error> refusal = result ? std::nullopt : std::optional(result.error());
        out.maybe(refusal, [&](const Error& e) { members(out, e); });
        if (result) members(out, *result);
      },
      limits, progress,
      [&](const ByteSource& source) {
        ByteReader in(source, limits.bytes);
        in.maybe(error, [&](Error& e) { members(in, e); });
        if (!error) members(in, content);
        whole = in.done();
      });
  if (!done && done.error().code == Code::cancelled) return done.error();
  if (!done) return damaged(done.error().message);
  if (!whole) return damaged("its reader gave no answer.");
  if (error) return *error;
  return content;
}

}  // namespace lamella
