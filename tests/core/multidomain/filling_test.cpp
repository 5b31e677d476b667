#include "core/multidomain/filling.h"

#include <gtest/gtest.h>

#include <numbers>
#include <random>

#include "core/mesh/sample_meshes.h"

namespace lamella {
namespace {

constexpr double kPi = std::numbers::pi;

template <int D>
Partition<D> one(ZonePtr<D> zone) {
  return Partition<D>({{"zone", std::move(zone)}});
}

template <int D>
Filling fill(const SimplexMesh<D>& mesh, const Partition<D>& partition, int depth = 3,
             int threads = 0) {
  FillingParams params;
  params.depth = depth;
  params.threads = threads;
  auto filling = filling_ratios<D>(mesh, partition, params);
  EXPECT_TRUE(filling.ok());
  return std::move(*filling);
}

template <int D>
void share_of_a_linear_function_is_a_volume() {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> value(-1, 1);
  for (int round = 0; round < 200; ++round) {
    std::array<double, D + 1> v, opposite;
    for (int i = 0; i <= D; ++i) {
      v[i] = value(random);
      opposite[i] = -v[i];
    }
    const double share = negative_share<D>(v);
    EXPECT_NEAR(share + negative_share<D>(opposite), 1, 1e-12);
    // Cutting an edge in the middle must not change anything.
    std::array<double, D + 1> a = v, b = v;
    a[0] = b[D] = 0.5 * (v[0] + v[D]);
    EXPECT_NEAR(share, 0.5 * (negative_share<D>(a) + negative_share<D>(b)), 1e-12);
  }
}
TEST(Filling, ShareOfALinearFunctionIsAVolume) {
  share_of_a_linear_function_is_a_volume<2>();
  share_of_a_linear_function_is_a_volume<3>();
}

template <int D>
void half_space_is_exact() {
  const Vec<D> normal = Vec<D>::Ones() + 0.3 * Vec<D>::Unit(0);
  const auto mesh = unit_box<D>(4);
  const auto partition = one<D>(half_space_zone<D>(normal, 0.4 * normal.sum()));
  const auto opposite = one<D>(half_space_zone<D>(-normal, -0.4 * normal.sum()));
  for (const int depth : {0, 3}) {
    const Filling filling = fill<D>(mesh, partition, depth);
    const Filling other = fill<D>(mesh, opposite, depth);
    double volume = 0;
    for (std::size_t e = 0; e < mesh.elements.size(); ++e) {
      EXPECT_NEAR(filling.ratio(e, 0), other.ratio(e, 1), 1e-6);
      EXPECT_NEAR(filling.ratio(e, 0) + filling.ratio(e, 1), 1, 1e-6);
      volume += filling.ratio(e, 0) * signed_measure<D>(mesh.corners(mesh.elements[e]));
    }
    EXPECT_NEAR(volume, filling_errors<D>(mesh, filling)[0].volume, 1e-12);
    EXPECT_NEAR(volume, filling_errors<D>(mesh, fill<D>(mesh, partition, 6))[0].volume, 1e-6);
  }
}
TEST(Filling, HalfSpaceIsExactWithoutBisection) {
  half_space_is_exact<2>();
  half_space_is_exact<3>();
}

TEST(Filling, VolumeOfABallConvergesWithTheDepth) {
  const double exact = 4 * kPi / 3 * 0.3 * 0.3 * 0.3;
  const auto mesh = unit_box<3>(5);
  const auto partition = one<3>(ball_zone<3>(Vec<3>(0.51, 0.48, 0.5), 0.3));
  std::vector<double> errors;
  for (const int depth : {0, 3, 6, 9})
    errors.push_back(
        std::abs(filling_errors<3>(mesh, fill<3>(mesh, partition, depth))[0].volume / exact - 1));
  // Three bisections halve the pieces, and a flat border in them errs with their square.
  for (std::size_t i = 1; i < errors.size(); ++i) EXPECT_LT(errors[i], 0.4 * errors[i - 1]);
  EXPECT_LT(errors.back(), 5e-3);
}

TEST(Filling, OverlapGoesToTheFirstAndSharesSumUpToOne) {
  const auto mesh = unit_box<3>(8);
  const ZonePtr<3> a = ball_zone<3>(Vec<3>(0.4, 0.5, 0.5), 0.22);
  const ZonePtr<3> b = ball_zone<3>(Vec<3>(0.62, 0.5, 0.5), 0.2);
  const Filling ab = fill<3>(mesh, Partition<3>({{"a", a}, {"b", b}}), 6);
  const Filling alone = fill<3>(mesh, one<3>(a), 6);
  const Filling both = fill<3>(mesh, one<3>(union_zone<3>({a, b})), 6);
  for (std::size_t e = 0; e < mesh.elements.size(); ++e) {
    EXPECT_NEAR(ab.ratio(e, 0) + ab.ratio(e, 1) + ab.ratio(e, 2), 1, 1e-6);
    EXPECT_NEAR(ab.ratio(e, 0), alone.ratio(e, 0), 0.02);
    EXPECT_NEAR(ab.ratio(e, 2), both.ratio(e, 1), 0.02);
  }
  EXPECT_NEAR(filling_errors<3>(mesh, ab)[0].volume, filling_errors<3>(mesh, alone)[0].volume,
              1e-4 * 0.05);
}

TEST(Filling, AgreesWithTheSamplingOfTheThesis) {
  const auto mesh = unit_box<3>(3);
  const ZonePtr<3> zone = cylinder_zone(Vec<3>(0.2, 0.3, 0.2), Vec<3>(0.7, 0.6, 0.9), 0.25);
  const Filling filling = fill<3>(mesh, one<3>(zone), 9);
  for (std::size_t e = 0; e < mesh.elements.size(); ++e) {
    // Not uniform: corners count too much (section B.3.1), which leaves a few hundredths.
    const double sampled = sampled_share<3>(mesh.corners(mesh.elements[e]), *zone, 0.02);
    EXPECT_NEAR(filling.ratio(e, 0), sampled, 0.08);
    if (!filling.mixed(e)) {
      EXPECT_NEAR(filling.ratio(e, 0), sampled, 1e-6);
    }
  }
}

TEST(Filling, ErrorIsThatOfAMeanValue) {
  // Cells of which a half space takes the third: g (1 - g) |T| each, (6.12).
  const auto mesh = box_mesh<3>({1, 1, 1}, Vec<3>::Zero(), Vec<3>::Ones());
  const Filling filling = fill<3>(mesh, one<3>(half_space_zone<3>(Vec<3>(0, 0, 1), 0.5)), 0);
  double squared = 0, volume = 0;
  for (std::size_t e = 0; e < mesh.elements.size(); ++e) {
    const double g = filling.ratio(e, 0);
    squared += g * (1 - g) / 6;
    volume += g / 6;
  }
  const auto errors = filling_errors<3>(mesh, filling);
  EXPECT_NEAR(volume, 0.5, 1e-6);
  EXPECT_NEAR(errors[0].l2, std::sqrt(squared), 1e-9);
  EXPECT_NEAR(errors[0].l2, errors[1].l2, 1e-6);
  EXPECT_NEAR(errors[0].relative_l2, std::sqrt(squared / volume), 1e-6);
}

TEST(Filling, ManyBodiesDoNotDependOnThreads) {
  std::vector<Region<3>> regions;
  for (int i = 0; i < 60; ++i) {
    const Vec<3> center(0.1 + 0.8 * ((i * 7) % 10) / 10.0, 0.1 + 0.8 * ((i * 3) % 10) / 10.0,
                        0.1 + 0.8 * (i / 10) / 6.0);
    regions.push_back({"ball " + std::to_string(i), ball_zone<3>(center, 0.04)});
  }
  const Partition<3> partition(regions);
  const auto mesh = unit_box<3>(10);
  const Filling one_thread = fill<3>(mesh, partition, 3, 1), two = fill<3>(mesh, partition, 3, 2);
  ASSERT_EQ(one_thread.first, two.first);
  for (std::size_t s = 0; s < two.shares.size(); ++s) {
    EXPECT_EQ(one_thread.shares[s].region, two.shares[s].region);
    EXPECT_EQ(one_thread.shares[s].ratio, two.shares[s].ratio);
  }
  const double exact = 4 * kPi / 3 * 6.4e-5;
  const auto errors = filling_errors<3>(mesh, fill<3>(mesh, partition, 9));
  for (int i = 0; i < 60; ++i) EXPECT_NEAR(errors[i].volume, exact, 0.1 * exact);
}

TEST(Filling, CancelStopsIt) {
  std::stop_source stop;
  stop.request_stop();
  const auto filling = filling_ratios<3>(unit_box<3>(4), one<3>(ball_zone<3>(Vec<3>::Zero(), 1)),
                                         {}, Progress({}, stop.get_token()));
  ASSERT_FALSE(filling.ok());
  EXPECT_EQ(filling.error().code, Code::cancelled);
}

}  // namespace
}  // namespace lamella
