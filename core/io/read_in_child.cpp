#include "core/io/read_in_child.h"

#include "core/base/bytes.h"
#include "core/base/child_process.h"

namespace lamella {
namespace {

// What goes through the pipe, in one order for both ends: `io` writes or reads.
template <class Io, class C>
void members(Io& io, C& content) {
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

std::string to_bytes(const Result<MeshContent>& result) {
  ByteWriter out;
  out.value(result.ok());
  if (result.ok()) {
    members(out, *result);
  } else {
    out.value(result.error().code);
    out.text(result.error().message);
    out.text(result.error().hint);
  }
  return out.take();
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
  const Result<std::string> bytes = run_in_child(
      [&](const Progress& through) { return to_bytes(read(file, through)); }, limits, progress);
  const auto damaged = [&](const std::string& how) {
    return Error{Code::bad_input, "\"" + file.string() + "\": it could not be read, " + how,
                 "The file is likely damaged; write or copy it again."};
  };
  if (!bytes) {
    if (bytes.error().code == Code::cancelled) return bytes.error();
    return damaged(bytes.error().message);
  }
  ByteReader in(*bytes);
  bool good = false;
  in.value(good);
  if (!good) {
    Error error;
    in.value(error.code);
    in.text(error.message);
    in.text(error.hint);
    return in.done() ? error : damaged("its reader gave no answer.");
  }
  MeshContent content;
  members(in, content);
  if (!in.done()) return damaged("its reader gave no answer.");
  return content;
}

}  // namespace lamella
