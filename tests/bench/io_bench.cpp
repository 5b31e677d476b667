#include <benchmark/benchmark.h>

#include <fstream>
#include <string>

#include "core/io/mesh_file.h"
#include "core/io_vtk/vtk_formats.h"
#include "core/mesh/sample_meshes.h"
#include "core/project/project_file.h"
#include "tests/support/temporary_folder.h"

namespace lamella {
namespace {

/// A million tetrahedra with a metric, written and read in one format.
struct Case {
  SimplexMesh<3> mesh = box_mesh<3>({55, 55, 55}, Vec<3>(0, 0, 0), Vec<3>(7.3, 9.1, 11.7));
  MetricField<3> metric = MetricField<3>(mesh.points.size(), 2.123456789 * Metric<3>::Identity());
  MeshFields fields;
  MeshFormats formats;
  test::TemporaryFolder folder;

  Case() {
    fields.metric = &metric;
    formats.add(own_formats());
    formats.add(vtk_formats());
  }
};

/// A line of /proc/self/status in MB.
double status_mb(const std::string& key) {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;)
    if (double kb = 0; word == key && status >> kb) return kb / 1000;
  return 0;
}

/// Tells the most memory that was resident while it lived, above what was when it began.
class Peak {
 public:
  explicit Peak(benchmark::State& state) : state_(state) {
    std::ofstream("/proc/self/clear_refs") << 5;  // VmHWM begins anew
    before_ = status_mb("VmRSS:");
  }
  ~Peak() { state_.counters["MB_above"] = status_mb("VmHWM:") - before_; }

 private:
  benchmark::State& state_;
  double before_ = 0;
};

void write_million(benchmark::State& state, const char* name) {
  const Case made;
  const MeshFormat& format = **made.formats.called(name);
  const Peak peak(state);
  for (auto _ : state)
    if (!format.write(made.mesh, made.fields, made.folder / ("m" + format.endings[0]), {}))
      return state.SkipWithError("not written");
}

void read_million(benchmark::State& state, const char* name) {
  const Case made;
  const MeshFormat& format = **made.formats.called(name);
  const auto file = made.folder / ("m" + format.endings[0]);
  if (!format.write(made.mesh, made.fields, file, {})) return state.SkipWithError("not written");
  const Peak peak(state);
  for (auto _ : state)
    if (!format.read(file, {})) return state.SkipWithError("not read");
}

/// The same in a project: mesh written, read again and compared, packed and proven.
void save_million(benchmark::State& state) {
  const Case made;
  const MeshFormat& format = **made.formats.called("vtu");
  ProjectContent content;
  content.write_mesh = [&](const std::filesystem::path& vtu) -> Result<void> {
    const auto proof = write_mesh_file(format, made.mesh, made.fields, vtu);
    if (!proof) return proof.error();
    return {};
  };
  const Peak peak(state);
  for (auto _ : state)
    if (!save_project(content, made.folder / "m.lamella")) return state.SkipWithError("not saved");
}
BENCHMARK(save_million)->Unit(benchmark::kMillisecond)->UseRealTime();

#define LAMELLA_FORMAT(name)                                                                   \
  BENCHMARK_CAPTURE(write_million, name, #name)->Unit(benchmark::kMillisecond)->UseRealTime(); \
  BENCHMARK_CAPTURE(read_million, name, #name)->Unit(benchmark::kMillisecond)->UseRealTime()
LAMELLA_FORMAT(msh);
LAMELLA_FORMAT(msh22);
LAMELLA_FORMAT(vtu);
LAMELLA_FORMAT(medit);
LAMELLA_FORMAT(abaqus);
LAMELLA_FORMAT(unv);
LAMELLA_FORMAT(nastran);
LAMELLA_FORMAT(openfoam);
LAMELLA_FORMAT(cimlib);
LAMELLA_FORMAT(exodus);

}  // namespace
}  // namespace lamella
