#include "core/cad/load_parts.h"

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <numeric>

#include "core/cad/occt_guard.h"
#include "core/cad/step_reader.h"
#include "core/cad/tessellate.h"
#include "core/geometry/improve_triangles.h"
#include "core/geometry/self_intersection.h"
#include "core/geometry/soup.h"
#include "core/io/stl.h"

namespace lamella {
namespace {

std::string extension_of(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

Result<std::vector<Part>> load_step(const std::filesystem::path& file, const LoadParams& params,
                                    const Progress& progress) {
  std::vector<Part> parts;
  Result<void> done = guarded(file.filename().string(), [&] {
    return read_step(file, progress,
                     [&](const TopoDS_Shape& solid, SolidInfo info, const Progress& portion) {
                       Result<Part> part = tessellate(solid, std::move(info), params, portion);
                       if (!part) {
                         Error error = part.error();
                         if (error.code != Code::cancelled) {
                           error.message = file.filename().string() + ": " + error.message;
                         }
                         return Result<void>(error);
                       }
                       parts.push_back(*std::move(part));
                       return Result<void>();
                     });
  });
  if (!done) return done.error();
  return parts;
}

/// Takes the needles out where that leaves the surface sound, and tells of facets that cross.
void improve(Part& part, const Progress& progress) {
  Vec<3> low = part.surface.points[0];
  Vec<3> high = low;
  for (const Vec<3>& p : part.surface.points) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  const double size = (high - low).norm();
  const SelfIntersections before = find_self_intersections(part.surface, progress);
  if (progress.cancelled()) return;
  if (before.pairs > 0) {
    part.notes.push_back(std::to_string(before.pairs) +
                         " pairs of facets cross each other: meshing may fail there.");
    return;
  }
  ImproveParams params;
  params.tolerance = 1e-5 * size;
  params.shortest_edge = 2e-3 * size;
  ReferenceSurface<3> better = part.surface;
  improve_triangles(better, params, progress);
  if (!check_closed(better).ok() || find_self_intersections(better, progress).pairs > 0) return;
  // Slivers have no normal: only now do their neighbors show their features.
  find_features(better, SoupParams{}.feature_angle);
  part.surface = std::move(better);
  part.chord_error = params.tolerance;
}

/// Pairs of facets that cross, in all bodies together.
std::size_t crossings_of(const std::vector<ReferenceSurface<3>>& bodies, const Progress& progress) {
  ReferenceSurface<3> all;
  for (const auto& body : bodies) {
    const auto first = static_cast<std::int32_t>(all.points.size());
    all.points.insert(all.points.end(), body.points.begin(), body.points.end());
    for (const auto& f : body.facets) {
      all.facets.push_back({f[0] + first, f[1] + first, f[2] + first});
    }
  }
  return find_self_intersections(all, progress).pairs;
}

Result<std::vector<Part>> load_stl(const std::filesystem::path& file, const LoadParams& params,
                                   const Progress& progress) {
  auto soup = read_stl(file, progress.portion(0, 0.4, "Reading STL"));
  if (!soup) return soup.error();
  for (auto& facet : *soup) {
    for (Vec<3>& p : facet) p *= params.unit;
  }
  std::vector<std::string> notes;
  auto surfaces = surfaces_from_soup(*soup, {}, &notes, progress.portion(0.4, 1, "Closing"));
  if (!surfaces) {
    Error error = surfaces.error();
    if (error.code != Code::cancelled) {
      error.message = file.filename().string() + ": " + error.message;
    }
    return error;
  }
  char unit[64];
  std::snprintf(unit, sizeof(unit), "An STL has no unit: one file unit was taken as %g mm.",
                params.unit);
  notes.push_back(unit);
  const std::size_t crossings = surfaces->size() > 1 ? crossings_of(*surfaces, progress) : 0;
  std::vector<Part> parts;
  for (auto& surface : *surfaces) {
    Part part;
    part.name = file.stem().string();
    if (surfaces->size() > 1) part.name += " " + std::to_string(parts.size() + 1);
    part.cad_volume = enclosed_measure(surface);
    part.surface = std::move(surface);
    improve(part, progress);
    if (progress.cancelled()) return cancelled_error();
    parts.push_back(std::move(part));
  }
  if (parts.size() > 1) {
    notes.push_back("The file holds " + std::to_string(parts.size()) + " separate bodies.");
    if (crossings > 0) {
      notes.push_back(
          "The bodies cross each other in " + std::to_string(crossings) +
          " pairs of facets: each is meshed alone, so what they share is meshed twice.");
    }
  }
  parts[0].notes.insert(parts[0].notes.begin(), notes.begin(), notes.end());
  return parts;
}

}  // namespace

Result<std::vector<Part>> load_parts(const std::filesystem::path& file, const LoadParams& params,
                                     const Progress& progress) {
  if (params.chord_tolerance && !(*params.chord_tolerance > 0)) {
    return Error{Code::usage, "the chord tolerance must be positive", "Give a length in mm."};
  }
  if (!(params.angle_tolerance > 0) || !(params.unit > 0)) {
    return Error{Code::usage, "the angle tolerance and the unit must be positive", ""};
  }
  const std::string extension = extension_of(file);
  if (extension == ".stl") return load_stl(file, params, progress);
  if (extension == ".step" || extension == ".stp") return load_step(file, params, progress);
  return Error{Code::bad_input,
               file.filename().string() + ": '" + extension + "' is no format of parts",
               "Lamella reads STEP (.step, .stp) and STL (.stl)."};
}

}  // namespace lamella
