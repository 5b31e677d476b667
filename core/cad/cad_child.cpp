#include "core/cad/cad_child.h"

#include <unistd.h>

#include <algorithm>
#include <optional>
#include <type_traits>
#include <utility>

#include "core/base/bytes.h"
#include "core/base/child_process.h"
#include "core/cad/occt_guard.h"

namespace lamella {
namespace {

// What goes through the pipe, in one order for both ends: `io` writes or reads.

template <class Io, class P>
void members(Io& io, P& part) requires std::is_same_v<std::remove_const_t<P>, Part> {
  io.text(part.name);
  io.value(part.color);
  auto& s = part.surface;
  io.array(s.points);
  io.array(s.facets);
  io.array(s.facet_face);
  io.list(s.faces, [&](auto& face) {
    io.text(face.name);
    io.value(face.color);
  });
  io.array(s.feature_edges);
  io.array(s.corners);
  io.value(part.cad_volume);
  io.value(part.chord_error);
  io.list(part.notes, [&](auto& note) { io.text(note); });
}

template <class Io, class C>
void members(Io& io, C& content) requires std::is_same_v<std::remove_const_t<C>, CadContent> {
  io.value(content.free_shells);
  io.value(content.free_faces);
  io.list(content.bodies, [&](auto& body) {
    members(io, body.part);
    io.maybe(body.refusal, [&](auto& refusal) { members(io, refusal); });
    io.array(body.rough.points);
    io.array(body.rough.facets);
    io.value(body.exact_shape_valid);
  });
}

bool within(std::int32_t index, std::size_t count) {
  return index >= 0 && static_cast<std::size_t>(index) < count;
}

template <std::size_t N>
bool within(const std::array<std::int32_t, N>& indices, std::size_t count) {
  return std::all_of(indices.begin(), indices.end(),
                     [&](std::int32_t i) { return within(i, count); });
}

template <class T>
bool within(const std::vector<T>& indices, std::size_t count) {
  return std::all_of(indices.begin(), indices.end(), [&](const T& i) { return within(i, count); });
}

/// A reader that goes wrong without a crash must not send its caller astray.
bool sound(const CadBody& body) {
  const ReferenceSurface<3>& s = body.part.surface;
  const std::size_t points = s.points.size();
  return within(s.facets, points) && within(s.feature_edges, points) && within(s.corners, points) &&
         s.facet_face.size() == s.facets.size() && within(s.facet_face, s.faces.size()) &&
         within(body.rough.facets, body.rough.points.size());
}

/// Bytes that a reader may take when nothing is asked: three quarters of the machine's.
std::uint64_t default_memory() {
  const long pages = ::sysconf(_SC_PHYS_PAGES), size = ::sysconf(_SC_PAGESIZE);
  return pages > 0 && size > 0
             ? static_cast<std::uint64_t>(pages) / 4 * 3 * static_cast<std::uint64_t>(size)
             : 0;
}

}  // namespace

std::string to_bytes(const CadContent& content, const Result<void>& outcome) {
  return bytes_of([&](ByteWriter& out) {
    const std::optional<Error> error = outcome ? std::nullopt : std::optional(outcome.error());
    out.maybe(error, [&](const Error& e) { members(out, e); });
    members(out, content);
  });
}

bool from_bytes(const std::string& bytes, CadContent& content, Result<void>& outcome) {
  ByteReader in(bytes);
  std::optional<Error> error;
  in.maybe(error, [&](Error& e) { members(in, e); });
  outcome = error ? Result<void>(*error) : Result<void>();
  members(in, content);
  return in.done() && std::all_of(content.bodies.begin(), content.bodies.end(), sound);
}

Result<void> read_cad_in_child(const std::filesystem::path& file, const LoadParams& params,
                               const Progress& progress, CadContent& content, const CadWork& work) {
  const std::string name = file.filename().string();
  const ChildWork in_child = [&](const Progress& through) {
    CadContent found;
    const Result<void> outcome =
        guarded_alone(name, [&] { return work(file, params, through, found); });
    return to_bytes(found, outcome);
  };
  const ChildLimits limits{
      params.cad_seconds,
      params.cad_memory ? static_cast<std::uint64_t>(*params.cad_memory * 1e6) : default_memory()};
  // Nobody else may be inside OCCT, its locks held, when the process is copied.
  std::optional<OcctLock> alone(std::in_place);
  Result<std::string> bytes = run_in_child(in_child, limits, progress, [&] { alone.reset(); });
  if (!bytes) {
    Error error = bytes.error();
    if (error.code == Code::cancelled) return error;
    error.message = name + ": the CAD library could not read it, " + error.message;
    error.hint = error.code == Code::memory
                     ? "Allow it more memory, or export the parts one by one."
                     : "The model may be damaged: export it again, or as another format. One that "
                       "is only large needs a longer time limit.";
    return error;
  }
  Result<void> outcome;
  if (from_bytes(*bytes, content, outcome)) return outcome;
  content = {};
  return Error{Code::failed, name + ": the CAD library gave surfaces that make no sense.",
               "The model may be damaged: export it again, or as another format."};
}

}  // namespace lamella
