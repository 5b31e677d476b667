#include "core/cad/load_parts.h"

#include <algorithm>
#include <cstdio>

#include "core/cad/cad_child.h"
#include "core/geometry/improve_triangles.h"
#include "core/geometry/self_intersection.h"
#include "core/geometry/soup.h"
#include "core/io/stl.h"

namespace lamella {
namespace {

/// Takes the needles out where that leaves the surface sound, and tells of facets that cross.
void improve(Part& part, const Progress& progress) {
  const double size = diagonal_of(part.surface.points);
  const SelfIntersections before = find_self_intersections(part.surface, progress);
  if (progress.cancelled()) return;
  if (before.pairs > 0) {
    part.notes.push_back(counted(before.pairs, "pair") + " of facets cross" +
                         (before.pairs == 1 ? "es" : "") + ", the first at " +
                         place_text(before.place) + ": meshing may fail there.");
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

double facets_area(const Triangles& t) {
  double area = 0;
  for (std::size_t f = 0; f < t.facets.size(); ++f)
    area += 0.5 * facet_normal<3>(t.corners(f)).norm();
  return area;
}

std::string percent(double share) { return length_text(100 * share) + " %"; }

struct WrappedBodies {
  std::vector<ReferenceSurface<3>> bodies;
  double error = 0;  // mm, both ways
  WrapReport report;
};

/// Wraps; once more on a grid of half the spacing where walls are lost.
Result<WrappedBodies> wrap_bodies(const Triangles& triangles, const LoadParams& params,
                                  const std::string& why, std::vector<std::string>& notes,
                                  const Progress& progress) {
  WrapParams how;
  how.spacing = params.wrap_spacing.value_or(0);
  Result<Wrapped> wrapped = wrap(triangles, how, progress.portion(0, 0.5));
  if (!wrapped) return wrapped.error();
  if (!params.wrap_spacing && wrapped->from_file.distance >= wrapped->spacing) {
    how.spacing = 0.5 * wrapped->spacing;
    Result<Wrapped> again = wrap(triangles, how, progress.portion(0.5, 0.9));
    if (!again) return again.error();
    const bool finer = again->spacing < 0.9 * wrapped->spacing;  // there was memory for it
    if (finer) wrapped = std::move(again);
  }
  const double error = std::max(wrapped->to_file.distance, wrapped->from_file.distance);
  std::string text = why + "Wrapped: within " + length_text(error) + " mm of the file's surface (" +
                     length_text(wrapped->to_file.distance) + " mm from it at most at " +
                     place_text(wrapped->to_file.place) + ", which lies within " +
                     length_text(wrapped->from_file.distance) + " mm of the wrap), on a grid of " +
                     length_text(wrapped->spacing) + " mm.";
  const double area = facets_area(wrapped->surface);
  WrapReport report{{},
                    wrapped->spacing,
                    wrapped->to_file,
                    wrapped->from_file,
                    wrapped->bridged_area / area,
                    wrapped->specks};
  if (report.bridged > 1e-4) text += " " + percent(report.bridged) + " of the wrap close holes.";
  if (wrapped->specks > 0)
    text += " " + counted(wrapped->specks, "shell") + " smaller than two cells left out.";
  notes.push_back(text);
  SoupParams sound;
  sound.repair = false;
  auto bodies = surfaces_from_triangles(std::move(wrapped->surface), sound, nullptr,
                                        progress.portion(0.9, 1));
  if (!bodies) return bodies.error();
  return WrappedBodies{*std::move(bodies), error, std::move(report)};
}

Triangles triangles_of(const ReferenceSurface<3>& surface) {
  return {surface.points, surface.facets};
}

/// One body made sound: as it is, or wrapped where it crosses itself. Several, when the wrap falls
/// apart.
Result<std::vector<Part>> finish(ReferenceSurface<3> surface, const LoadParams& params,
                                 std::optional<WrapReport>& wrap, const Progress& progress) {
  std::vector<Part> parts(1);
  if (params.repair == Repair::automatic) {
    const SelfIntersections crossing = find_self_intersections(surface, progress);
    if (progress.cancelled()) return cancelled_error();
    Triangles mended = triangles_of(surface);
    if (crossing.pairs > 0 &&
        mend_crossings(mended, 0.1 * diagonal_of(surface.points), &parts[0].notes, progress)) {
      SoupParams sound;
      sound.repair = false;
      auto bodies = surfaces_from_triangles(std::move(mended), sound, nullptr, progress);
      if (!bodies) return bodies.error();
      parts.resize(bodies->size());
      for (std::size_t k = 0; k < parts.size(); ++k) parts[k].surface = std::move((*bodies)[k]);
      surface = {};
    } else if (crossing.pairs > 0) {
      std::vector<std::string> notes;
      Result<WrappedBodies> wrapped = wrap_bodies(triangles_of(surface), params,
                                                  counted(crossing.pairs, "pair") +
                                                      " of facets cross each other, the first at " +
                                                      place_text(crossing.place) + ". ",
                                                  notes, progress);
      if (!wrapped) return wrapped.error();
      parts.clear();
      for (auto& body : wrapped->bodies) {
        parts.emplace_back();
        parts.back().chord_error = wrapped->error;
        parts.back().surface = std::move(body);
      }
      parts[0].notes = std::move(notes);
      wrap = std::move(wrapped->report);
      surface = {};
    }
  }
  if (!surface.points.empty()) parts[0].surface = std::move(surface);
  for (Part& part : parts) {
    part.cad_volume = enclosed_measure(part.surface);
    improve(part, progress);
    if (progress.cancelled()) return cancelled_error();
  }
  return parts;
}

/// Parts of triangles that lack connectivity or soundness.
Result<std::vector<Part>> parts_of(Triangles triangles, const std::string& name,
                                   const LoadParams& params, std::vector<std::string> notes,
                                   std::vector<WrapReport>& wraps, const Progress& progress) {
  std::vector<ReferenceSurface<3>> surfaces;
  std::optional<WrapReport> whole;
  double error = 0;
  std::optional<Error> refused;
  const bool finite = std::all_of(triangles.points.begin(), triangles.points.end(),
                                  [](const Vec<3>& p) { return p.allFinite(); });
  bool wrapped = params.repair == Repair::wrap && finite;
  if (!wrapped) {
    SoupParams soup;
    soup.repair = params.repair == Repair::automatic;
    std::vector<std::string> repairs;
    auto bodies = surfaces_from_triangles(triangles, soup, &repairs, progress.portion(0, 0.3));
    if (bodies) {
      surfaces = *std::move(bodies);
      notes.insert(notes.begin(), repairs.begin(), repairs.end());
    } else if (params.repair == Repair::none || bodies.error().code != Code::bad_input || !finite) {
      return bodies.error();
    } else {
      refused = bodies.error();
      wrapped = true;
    }
  }
  if (wrapped) {
    const std::string why =
        refused ? "Small repairs did not do: " + refused->message + ". " : std::string();
    auto bodies = wrap_bodies(triangles, params, why, notes, progress.portion(0.3, 0.8));
    // Of a surface that encloses nothing the first finding tells more.
    if (!bodies && refused && bodies.error().code == Code::bad_input) return *refused;
    if (!bodies) return bodies.error();
    surfaces = std::move(bodies->bodies);
    error = bodies->error;
    whole = std::move(bodies->report);
  }
  const std::size_t crossings = surfaces.size() > 1 ? crossings_of(surfaces, progress) : 0;
  std::vector<Part> parts;
  // Each with the parts it became, as first and last.
  std::vector<std::pair<WrapReport, std::array<std::size_t, 2>>> of_parts;
  for (auto& surface : surfaces) {
    std::optional<WrapReport> own;
    Result<std::vector<Part>> finished =
        finish(std::move(surface), params, own, progress.portion(0.8, 1));
    if (!finished) return finished.error();
    if (own) of_parts.push_back({*std::move(own), {parts.size(), parts.size() + finished->size()}});
    for (Part& part : *finished) {
      part.chord_error = std::max(part.chord_error, error);
      parts.push_back(std::move(part));
    }
  }
  for (std::size_t k = 0; k < parts.size(); ++k)
    parts[k].name = name + (parts.size() > 1 ? " " + std::to_string(k + 1) : "");
  if (whole) of_parts.push_back({*std::move(whole), {0, parts.size()}});
  for (auto& [report, range] : of_parts) {
    for (std::size_t k = range[0]; k < range[1]; ++k) report.bodies.push_back(parts[k].name);
    wraps.push_back(std::move(report));
  }
  if (parts.size() > 1) {
    notes.push_back("The file holds " + std::to_string(parts.size()) + " separate bodies.");
    if (crossings > 0) {
      notes.push_back(
          "The bodies cross each other in " + std::to_string(crossings) +
          " pairs of facets: each is meshed alone, so what they share is meshed twice. A wrap "
          "unites them.");
    }
  }
  parts[0].notes.insert(parts[0].notes.begin(), notes.begin(), notes.end());
  return parts;
}

Error about(const std::filesystem::path& file, Error error) {
  if (error.code != Code::cancelled)
    error.message = file.filename().string() + ": " + error.message;
  return error;
}

Result<std::vector<Part>> load_stl(const std::filesystem::path& file, const LoadParams& params,
                                   FileDiagnosis* diagnosis, std::vector<WrapReport>& wraps,
                                   const Progress& progress) {
  auto soup = read_stl(file, progress.portion(0, 0.2, "Reading STL"));
  if (!soup) return soup.error();
  for (auto& facet : *soup) {
    for (Vec<3>& p : facet) p *= params.unit;
  }
  Triangles triangles = merge_exact(*soup);
  if (diagnosis) {
    diagnosis->bodies = diagnose_bodies(triangles, {}, progress.portion(0.2, 0.4, "Diagnosing"));
    diagnosis->unit_guess = guess_unit(diagonal_of(triangles.points) / params.unit);
  }
  if (progress.cancelled()) return cancelled_error();
  char unit[160];
  std::snprintf(unit, sizeof(unit), "An STL has no unit: one file unit was taken as %g mm%s",
                params.unit,
                params.unit == 1 && guess_unit(diagonal_of(triangles.points)) != "mm"
                    ? ", which makes the part small; is it in another?"
                    : ".");
  auto parts = parts_of(std::move(triangles), file.stem().string(), params, {unit}, wraps,
                        progress.portion(0.4, 1, "Closing"));
  if (!parts) return about(file, parts.error());
  return parts;
}

Result<std::vector<Part>> load_cad(const std::filesystem::path& file, const LoadParams& params,
                                   FileDiagnosis* diagnosis, std::vector<WrapReport>& wraps,
                                   const Progress& progress) {
  CadContent content;
  const Result<void> done = read_cad_in_child(file, params, progress.portion(0, 0.9), content);
  if (diagnosis) {
    diagnosis->free_shells = content.free_shells;
    diagnosis->free_faces = content.free_faces;
  }
  if (!done) return done.error();
  std::vector<Part> parts;
  const Progress rest = progress.portion(0.9, 1, "Closing");
  for (CadBody& body : content.bodies) {
    if (progress.cancelled()) return cancelled_error();
    if (diagnosis) {
      Diagnosis found =
          diagnose(body.rough.facets.empty() ? triangles_of(body.part.surface) : body.rough, {},
                   Progress({}, progress.stop_token()));
      found.name = body.part.name;
      found.exact_shape_valid = body.exact_shape_valid;
      diagnosis->bodies.push_back(std::move(found));
    }
    if (body.refusal && params.repair == Repair::none) return about(file, *body.refusal);
    if (!body.refusal && body.rough.facets.empty() && params.repair != Repair::wrap) {
      parts.push_back(std::move(body.part));
      continue;
    }
    std::vector<std::string> notes = body.part.notes;
    if (body.refusal) notes.push_back(body.refusal->message + ".");
    Triangles rough =
        body.rough.facets.empty() ? triangles_of(body.part.surface) : std::move(body.rough);
    auto made = parts_of(std::move(rough), body.part.name, params, std::move(notes), wraps, rest);
    if (!made && body.refusal && made.error().code != Code::cancelled)
      return about(file, *body.refusal);
    if (!made) return about(file, made.error());
    for (Part& part : *made) {
      part.color = body.part.color;
      parts.push_back(std::move(part));
    }
  }
  return parts;
}

Result<std::vector<Part>> load(const std::filesystem::path& file, const LoadParams& params,
                               FileDiagnosis* diagnosis, std::vector<WrapReport>& wraps,
                               const Progress& progress) {
  if (params.chord_tolerance && !(*params.chord_tolerance > 0)) {
    return Error{Code::usage, "the chord tolerance must be positive", "Give a length in mm."};
  }
  if (params.wrap_spacing && !(*params.wrap_spacing > 0)) {
    return Error{Code::usage, "the spacing of a wrap must be positive", "Give a length in mm."};
  }
  if (!(params.cad_seconds > 0) || (params.cad_memory && !(*params.cad_memory > 0))) {
    return Error{Code::usage, "the limits of reading must be positive", ""};
  }
  if (!(params.angle_tolerance > 0) || !(params.unit > 0)) {
    return Error{Code::usage, "the angle tolerance and the unit must be positive", ""};
  }
  const std::string extension = extension_of(file);
  if (extension == ".stl") return load_stl(file, params, diagnosis, wraps, progress);
  if (cad_format_of(file)) return load_cad(file, params, diagnosis, wraps, progress);
  return Error{
      Code::bad_input, file.filename().string() + ": '" + extension + "' is no format of parts",
      "Lamella reads STEP (.step, .stp), IGES (.iges, .igs), BREP (.brep, .brp) and STL (.stl)."};
}

}  // namespace

Result<std::vector<Part>> load_parts(const std::filesystem::path& file, const LoadParams& params,
                                     const Progress& progress) {
  std::vector<WrapReport> wraps;
  return load(file, params, nullptr, wraps, progress);
}

Inspection inspect_parts(const std::filesystem::path& file, const LoadParams& params,
                         const Progress& progress) {
  FileDiagnosis diagnosis;
  std::vector<WrapReport> wraps;
  Result<std::vector<Part>> parts = load(file, params, &diagnosis, wraps, progress);
  return {std::move(diagnosis), std::move(wraps), std::move(parts)};
}

}  // namespace lamella
