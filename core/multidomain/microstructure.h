#pragma once

#include <cstdint>
#include <optional>

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/multidomain/partition.h"

namespace lamella {

/// What a microstructure (7.2) fills: a convex zone.
struct Specimen {
  ZonePtr<3> zone;
  double volume = 0;  ///< mm^3
};
Specimen box_specimen(const Vec<3>& low, const Vec<3>& high);
Specimen cylinder_specimen(const Vec<3>& from, const Vec<3>& to, double radius);

struct PolycrystalOptions {
  int grains = 100;      ///< >= 1
  double spacing = 0.7;  ///< least distance of seeds, in (volume / grains)^(1/3); up to about 0.85
  int relaxations = 0;   ///< steps of Lloyd: each seed goes to the centroid of its grain
  std::uint64_t seed = 1;
  int threads = 0;
};
/// Seeds of the grains, which are their Voronoi cells. The same seed gives the same grains
/// everywhere. Errors: bad_input (no such spacing can be had), cancelled.
Result<std::vector<Vec<3>>> polycrystal_seeds(const Specimen& specimen,
                                              const PolycrystalOptions& options,
                                              const Progress& progress = {});

struct BallInclusion {
  Vec<3> center;
  double radius;
};
struct InclusionOptions {
  std::optional<int> count{};
  std::optional<double> fraction{};  ///< of the volume, reached to half an inclusion; one of both
  double radius_min = 1, radius_max = 1;  ///< mm, evenly distributed between
  double gap = 0;                         ///< mm, least distance to one another and to the wall
  std::uint64_t seed = 1;
};
/// Balls inside the specimen that do not overlap, the largest first, each where chance puts it;
/// when there is no room the others are shaken. Some 35 % of the volume can be filled, less where
/// walls and gaps take their share. Errors: bad_input (they do not fit), cancelled.
Result<std::vector<BallInclusion>> pack_balls(const Specimen& specimen,
                                              const InclusionOptions& options,
                                              const Progress& progress = {});

struct FiberInclusion {
  Vec<3> from, to;  ///< the centers of its flat ends
  double radius;
};
struct FiberOptions {
  std::optional<int> count{};
  std::optional<double> fraction{};  ///< as of InclusionOptions; one of both
  double length = 10, radius = 0.5;  ///< mm
  double gap = 0;                    ///< mm, as of InclusionOptions
  /// Second order orientation tensor, the mean of p p^T: symmetric, not negative, trace 1. A third
  /// of the unit matrix: all directions alike; p p^T: aligned.
  Mat<3> orientation = Mat<3>::Identity() / 3;
  std::uint64_t seed = 1;
};
/// The same with cylinders, whose directions are angular central Gaussian with that tensor.
Result<std::vector<FiberInclusion>> pack_fibers(const Specimen& specimen,
                                                const FiberOptions& options,
                                                const Progress& progress = {});

/// Regions "grain 1", "inclusion 1" or "fiber 1" and so on.
std::vector<Region<3>> regions_of(const std::vector<Vec<3>>& grain_seeds);
std::vector<Region<3>> regions_of(const std::vector<BallInclusion>& balls);
std::vector<Region<3>> regions_of(const std::vector<FiberInclusion>& fibers);

}  // namespace lamella
