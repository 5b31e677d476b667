#include <benchmark/benchmark.h>

#include <ctime>

#include "core/mesh/sample_meshes.h"
#include "core/metric/analytic.h"
#include "core/optimize/adapt.h"

namespace lamella {
namespace {

/// Adapts the unit box of D! simplices `rounds` times to a named metric, which is exact at the
/// nodes before each. The rates count the elements of the last mesh against wall time, and against
/// the time of all threads together.
template <int D>
void adapt_box(benchmark::State& state, const char* metric_name, int rounds, int threads) {
  const auto function = named_metric<D>(metric_name);
  if (!function) return state.SkipWithError(function.error().message.c_str());
  AdaptParams params;
  params.threads = threads;
  std::size_t nodes = 0, elements = 0;
  const std::clock_t start = std::clock();
  for (auto _ : state) {
    SimplexMesh<D> mesh = unit_box<D>(1);
    for (int i = 0; i < rounds; ++i) {
      const MetricField<D> metric = sample_metric<D>(*function, mesh.points);
      Result<Adapted<D>> adapted = adapt<D>(mesh, metric, nullptr, params, {}, *function);
      if (!adapted) return state.SkipWithError(adapted.error().message.c_str());
      mesh = std::move(adapted->mesh);
    }
    nodes = mesh.node_count();
    elements = mesh.element_count();
  }
  const double cpu = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  state.counters["elements/cpu_s"] =
      static_cast<double>(elements) * static_cast<double>(state.iterations()) / cpu;
  state.counters["nodes"] = static_cast<double>(nodes);
  state.counters["elements"] = static_cast<double>(elements);
  state.counters["elements/s"] = benchmark::Counter(static_cast<double>(elements),
                                                    benchmark::Counter::kIsIterationInvariantRate);
}

void uniform_cube(benchmark::State& state) {
  adapt_box<3>(state, "uniform:h=0.05", 1, static_cast<int>(state.range(0)));
}
void polar_cube(benchmark::State& state) {
  adapt_box<3>(state, "polar-2", 4, static_cast<int>(state.range(0)));
}
void hypercube(benchmark::State& state) {
  adapt_box<4>(state, "uniform:h=0.333333333", 3, static_cast<int>(state.range(0)));
}

// MeasureProcessCPUTime: the CPU column holds all threads together.
BENCHMARK(uniform_cube)
    ->ArgName("threads")
    ->Arg(1)
    ->Arg(2)
    ->Unit(benchmark::kSecond)
    ->UseRealTime()
    ->MeasureProcessCPUTime();
BENCHMARK(polar_cube)
    ->ArgName("threads")
    ->Arg(1)
    ->Arg(2)
    ->Unit(benchmark::kSecond)
    ->Iterations(1)
    ->UseRealTime()
    ->MeasureProcessCPUTime();
BENCHMARK(hypercube)
    ->ArgName("threads")
    ->Arg(1)
    ->Arg(2)
    ->Unit(benchmark::kSecond)
    ->UseRealTime()
    ->MeasureProcessCPUTime();

}  // namespace
}  // namespace lamella
