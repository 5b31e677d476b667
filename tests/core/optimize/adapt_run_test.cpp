#include <atomic>
#include <chrono>
#include <cstring>
#include <thread>

#include "tests/support/adapt_cases.h"

/// Threads and cancel: how an adaption runs, not what it makes.
namespace lamella::test {
namespace {

using Clock = std::chrono::steady_clock;

template <class T>
bool same_bytes(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

template <int D>
void expect_identical(const Adapted<D>& a, const Adapted<D>& b) {
  EXPECT_TRUE(same_bytes(a.mesh.points, b.mesh.points));
  EXPECT_TRUE(same_bytes(a.mesh.elements, b.mesh.elements));
  EXPECT_TRUE(same_bytes(a.mesh.element_body, b.mesh.element_body));
  EXPECT_TRUE(same_bytes(a.mesh.facets, b.mesh.facets));
  EXPECT_TRUE(same_bytes(a.mesh.facet_group, b.mesh.facet_group));
  EXPECT_TRUE(same_bytes(a.mesh.facet_face, b.mesh.facet_face));
  EXPECT_TRUE(same_bytes(a.metric, b.metric));
  EXPECT_EQ(a.report.splits, b.report.splits);
  EXPECT_EQ(a.report.collapses, b.report.collapses);
  EXPECT_EQ(a.report.swaps, b.report.swaps);
  EXPECT_EQ(a.report.moves, b.report.moves);
  EXPECT_EQ(a.report.sweeps, b.report.sweeps);
}

template <class T>
class AdaptRun : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(AdaptRun, Dimensions);

template <int D>
MetricFunction<D> uniform_metric(double h) {
  return [h](const Vec<D>&) { return isotropic_metric<D>(h); };
}

TYPED_TEST(AdaptRun, ThreadsMakeTheSameMesh) {
  constexpr int D = TypeParam::value;
  const auto metric = uniform_metric<D>(D == 2 ? 0.008 : 0.062);
  const auto box = unit_box<D>(D == 2 ? 90 : 10);
  AdaptParams params;
  params.sweeps = 2;
  params.threads = 1;
  const auto one = adapted<D>(box, metric, params);
  ASSERT_GT(one.mesh.elements.size(), 24000u) << "too small for several blocks";
  for (int threads : {2, 7}) {
    params.threads = threads;
    expect_identical<D>(one, adapted<D>(box, metric, params));
  }
}

TYPED_TEST(AdaptRun, ThreadsMakeTheSameMeshUnderAFunction) {
  constexpr int D = TypeParam::value;
  const MetricFunction<D> metric = [](const Vec<D>& x) {
    return isotropic_metric<D>((D == 2 ? 0.006 : 0.05) * (1 + x[0]));
  };
  const auto box = unit_box<D>(D == 2 ? 90 : 12);
  AdaptParams params;
  params.sweeps = 1;
  params.threads = 1;
  const auto one = adapt<D>(box, {}, nullptr, params, {}, metric);
  params.threads = 2;
  const auto two = adapt<D>(box, {}, nullptr, params, {}, metric);
  ASSERT_TRUE(one.ok() && two.ok());
  ASSERT_GT(one->mesh.elements.size(), 24000u) << "too small for several blocks";
  expect_identical<D>(*one, *two);
}

template <int D>
struct Job {
  SimplexMesh<D> box = unit_box<D>(D == 2 ? 60 : 8);
  MetricFunction<D> metric = uniform_metric<D>(D == 2 ? 0.012 : 0.08);
  MetricField<D> field = sample_metric<D>(metric, box.points);
};

/// A cancelled adaption leaves a mesh of the same domain and its input alone.
template <int D>
void expect_sound(const Job<D>& job, const Result<Adapted<D>>& r) {
  ASSERT_TRUE(r.ok()) << r.error().message;
  expect_valid(r->mesh);
  expect_same_shape(job.box, r->mesh);
  ASSERT_EQ(r->metric.size(), r->mesh.points.size());
  for (std::size_t n = 1; n < r->metric.size(); ++n) ASSERT_TRUE(is_spd<D>(r->metric[n]));
  const Job<D> fresh;
  EXPECT_TRUE(same_bytes(job.box.points, fresh.box.points));
  EXPECT_TRUE(same_bytes(job.box.elements, fresh.box.elements));
  EXPECT_TRUE(same_bytes(job.box.facets, fresh.box.facets));
  EXPECT_TRUE(same_bytes(job.field, fresh.field));
}

TYPED_TEST(AdaptRun, ACancelFromTheSinkLeavesAValidMesh) {
  constexpr int D = TypeParam::value;
  const Job<D> job;
  double slowest = 0;
  for (int tenth = 1; tenth <= 9; ++tenth) {
    SCOPED_TRACE(tenth);
    std::stop_source stop;
    Clock::time_point asked;
    double at = 0;
    const Progress progress(
        [&](double fraction, std::string_view) {
          if (fraction >= 0.1 * tenth && !stop.stop_requested()) {
            asked = Clock::now();
            at = fraction;
            stop.request_stop();
          }
        },
        stop.get_token());
    const auto r = adapt<D>(job.box, job.field, nullptr, {}, progress);
    slowest = std::max(slowest, std::chrono::duration<double>(Clock::now() - asked).count());
    expect_sound(job, r);
    // An adaption that settles early may be done when the fraction is passed.
    EXPECT_EQ(r->report.cancelled, at < 1);
    if (tenth <= 5) {
      EXPECT_LT(at, 1);
    }
  }
  this->RecordProperty("seconds_from_cancel_to_return", std::to_string(slowest));
}

TYPED_TEST(AdaptRun, ACancelAtAnyMomentLeavesAValidMesh) {
  constexpr int D = TypeParam::value;
  const Job<D> job;
  const auto begin = Clock::now();
  const auto whole = adapt<D>(job.box, job.field);
  const double seconds = std::chrono::duration<double>(Clock::now() - begin).count();
  ASSERT_TRUE(whole.ok());
  EXPECT_FALSE(whole->report.cancelled);
  std::mt19937 rng(D);
  double slowest = 0;
  int cancelled = 0;
  for (int i = 0; i < 8; ++i) {
    std::stop_source stop;
    Clock::time_point asked;
    const double wait = seconds * uniform(rng, 0.02, 0.8);
    std::jthread asker([&] {
      std::this_thread::sleep_for(std::chrono::duration<double>(wait));
      asked = Clock::now();
      stop.request_stop();
    });
    const auto r = adapt<D>(job.box, job.field, nullptr, {}, Progress({}, stop.get_token()));
    const auto end = Clock::now();
    asker.join();
    if (end > asked)
      slowest = std::max(slowest, std::chrono::duration<double>(end - asked).count());
    expect_sound(job, r);
    cancelled += r->report.cancelled;
  }
  EXPECT_GT(cancelled, 0);
  this->RecordProperty("seconds_from_cancel_to_return", std::to_string(slowest));
}

TYPED_TEST(AdaptRun, AskedToStopBeforeItBeginsItReturnsItsInput) {
  constexpr int D = TypeParam::value;
  const Job<D> job;
  std::stop_source stop;
  stop.request_stop();
  const auto r = adapt<D>(job.box, job.field, nullptr, {}, Progress({}, stop.get_token()));
  expect_sound(job, r);
  EXPECT_TRUE(r->report.cancelled);
  EXPECT_EQ(r->mesh.elements.size(), job.box.elements.size());
  EXPECT_EQ(as_sets(r->mesh.elements), as_sets(job.box.elements));
}

TYPED_TEST(AdaptRun, ProgressOnlyRisesAndEndsAtOne) {
  constexpr int D = TypeParam::value;
  const auto box = unit_box<D>(2);
  double last = 0;
  bool falls = false;
  const Progress progress([&](double fraction, std::string_view) {
    falls = falls || fraction < last;
    last = fraction;
  });
  const MetricFunction<D> metric = uniform_metric<D>(0.2);
  ASSERT_TRUE(adapt<D>(box, sample_metric<D>(metric, box.points), nullptr, {}, progress).ok());
  EXPECT_FALSE(falls);
  EXPECT_EQ(last, 1);
}

}  // namespace
}  // namespace lamella::test
