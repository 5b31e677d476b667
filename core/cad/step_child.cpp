#include "core/cad/step_child.h"

#include <unistd.h>

#include <algorithm>

#include "core/base/bytes.h"
#include "core/base/child_process.h"
#include "core/cad/occt_guard.h"

namespace lamella {
namespace {

void put(ByteWriter& out, const std::vector<std::string>& texts) {
  out.value(static_cast<std::uint64_t>(texts.size()));
  for (const std::string& text : texts) out.text(text);
}

void take(ByteReader& in, std::vector<std::string>& texts) {
  texts.resize(in.count(sizeof(std::uint64_t)));
  for (std::string& text : texts) in.text(text);
}

void put(ByteWriter& out, const Error& error) {
  out.value(error.code);
  out.text(error.message);
  out.text(error.hint);
}

void take(ByteReader& in, Error& error) {
  in.value(error.code);
  in.text(error.message);
  in.text(error.hint);
}

void put(ByteWriter& out, const Part& part) {
  out.text(part.name);
  out.value(part.color);
  const ReferenceSurface<3>& s = part.surface;
  out.array(s.points);
  out.array(s.facets);
  out.array(s.facet_face);
  out.value(static_cast<std::uint64_t>(s.faces.size()));
  for (const SurfaceFace& face : s.faces) {
    out.text(face.name);
    out.value(face.color);
  }
  out.array(s.feature_edges);
  out.array(s.corners);
  out.value(part.cad_volume);
  out.value(part.chord_error);
  put(out, part.notes);
}

void take(ByteReader& in, Part& part) {
  in.text(part.name);
  in.value(part.color);
  ReferenceSurface<3>& s = part.surface;
  in.array(s.points);
  in.array(s.facets);
  in.array(s.facet_face);
  s.faces.resize(in.count(sizeof(std::uint64_t)));
  for (SurfaceFace& face : s.faces) {
    in.text(face.name);
    in.value(face.color);
  }
  in.array(s.feature_edges);
  in.array(s.corners);
  in.value(part.cad_volume);
  in.value(part.chord_error);
  take(in, part.notes);
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
bool sound(const StepBody& body) {
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

std::string to_bytes(const StepContent& content, const Result<void>& outcome) {
  ByteWriter out;
  out.value(outcome.ok());
  if (!outcome) put(out, outcome.error());
  out.value(content.free_shells);
  out.value(content.free_faces);
  out.value(static_cast<std::uint64_t>(content.bodies.size()));
  for (const StepBody& body : content.bodies) {
    put(out, body.part);
    out.value(body.refusal.has_value());
    if (body.refusal) put(out, *body.refusal);
    out.array(body.rough.points);
    out.array(body.rough.facets);
    out.value(body.exact_shape_valid);
  }
  return out.take();
}

bool from_bytes(const std::string& bytes, StepContent& content, Result<void>& outcome) {
  ByteReader in(bytes);
  bool flag = false;
  in.value(flag);
  outcome = {};
  if (!flag) {
    Error error;
    take(in, error);
    outcome = error;
  }
  in.value(content.free_shells);
  in.value(content.free_faces);
  content.bodies.resize(in.count(sizeof(std::uint64_t)));
  for (StepBody& body : content.bodies) {
    take(in, body.part);
    in.value(flag);
    if (flag) take(in, body.refusal.emplace());
    in.array(body.rough.points);
    in.array(body.rough.facets);
    in.value(body.exact_shape_valid);
  }
  return in.done() && std::all_of(content.bodies.begin(), content.bodies.end(), sound);
}

Result<void> read_step_in_child(const std::filesystem::path& file, const LoadParams& params,
                                const Progress& progress, StepContent& content,
                                const StepWork& work) {
  const std::string name = file.filename().string();
  const ChildWork in_child = [&](const Progress& through) {
    StepContent found;
    const Result<void> outcome =
        guarded_alone(name, [&] { return work(file, params, through, found); });
    return to_bytes(found, outcome);
  };
  const ChildLimits limits{
      params.cad_seconds,
      params.cad_memory ? static_cast<std::uint64_t>(*params.cad_memory * 1e6) : default_memory()};
  // Nobody else may be inside OCCT, its locks held, when the process is copied.
  Result<std::string> bytes = Error{};
  {
    const OcctLock alone;
    bytes = run_in_child(in_child, limits, progress);
  }
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
