#include "core/io/vtu.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <sstream>

#include "core/base/atomic_file.h"
#include "tests/support/foreign_program.h"
#include "tests/support/measures.h"
#include "tests/support/temporary_folder.h"

namespace lamella {
namespace {

class AppendedVtu : public testing::Test {
 protected:
  const test::TemporaryFolder folder;
  const test::ThreeBodies made = test::three_different_bodies();
  const std::filesystem::path file = folder / "m.vtu";

  void SetUp() override { ASSERT_TRUE(write_vtu(made.mesh, made.with_metric(), file)); }
};

// Python's own XML and zlib: no code of ours, and none of VTK's.
TEST_F(AppendedVtu, AReaderOfAnotherKindSeesEveryNameAndMeasure) {
  LAMELLA_NEEDS_PROGRAM("python3");
  const std::string said = test::output_of(
      folder.path(), "python3 " LAMELLA_SOURCE_DIR "/tests/support/read_vtu.py m.vtu");
  test::Measures seen;
  std::map<std::string, double> filled;
  std::istringstream lines(said);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string kind, name;
    double value = 0;
    if (!(words >> kind >> value)) continue;
    std::getline(words >> std::ws, name);
    if (kind == "volume") seen.volumes[name] = value;
    if (kind == "area") seen.areas[name] = value;
    if (kind == "filled") filled[name] = value;
  }
  expect_measures(seen, test::measures_of(made.mesh));
  EXPECT_EQ(test::number_behind(said, "points "), 140) << said;
  EXPECT_EQ(test::number_behind(said, "tetrahedra "), 432);
  EXPECT_EQ(test::number_behind(said, "triangles "), static_cast<double>(made.mesh.facets.size()));
  EXPECT_NE(said.find("unit mm\n"), std::string::npos);
  ASSERT_EQ(filled.size(), 3u);
  for (const ElementField& field : made.fields.of_elements) {
    double volume = 0;
    for (std::size_t e = 0; e < field.values.size(); ++e)
      volume += field.values[e] * signed_measure<3>(made.mesh.corners(made.mesh.elements[e]));
    EXPECT_NEAR(filled.at(field.name.substr(kFillingField.size())) / volume, 1, 1e-9);
  }
  Metric<3> sum = Metric<3>::Zero();
  for (std::size_t v = 1; v < made.metric.size(); ++v) sum += made.metric[v];
  constexpr const char* names[] = {"XX ", "YY ", "ZZ ", "XY ", "YZ ", "XZ "};
  for (std::size_t c = 0; c < 6; ++c)
    EXPECT_NEAR(test::number_behind(said, std::string("metric ") + names[c]),
                sum(kVtkTensor[c][0], kVtkTensor[c][1]), 1e-9 * sum.norm());
}

TEST_F(AppendedVtu, ThreadsDoNotChangeTheFile) {
  const SimplexMesh<3> large = box_mesh<3>({30, 30, 30}, Vec<3>(0, 0, 0), Vec<3>(7.3, 9.1, 11.7));
  ASSERT_TRUE(write_vtu(large, {}, file));
  const std::string first = read_file(file).value();
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  ASSERT_TRUE(write_vtu(large, {}, file));
  EXPECT_EQ(read_file(file).value(), first);
}

TEST_F(AppendedVtu, ReadsWhatItWrote) {
  const std::optional<MeshContent> back = read_appended_vtu(file);
  ASSERT_TRUE(back);
  EXPECT_EQ(back->mesh.points, made.mesh.points);
  EXPECT_EQ(back->mesh.elements, made.mesh.elements);
  EXPECT_EQ(back->mesh.element_body, made.mesh.element_body);
  EXPECT_EQ(back->mesh.facets, made.mesh.facets);
  EXPECT_EQ(back->mesh.facet_group, made.mesh.facet_group);
  EXPECT_EQ(back->mesh.bodies, made.mesh.bodies);
  EXPECT_EQ(back->mesh.groups, made.mesh.groups);
  ASSERT_EQ(back->of_elements.size(), 3u);
  EXPECT_EQ(back->of_elements[1].values, made.fields.of_elements[1].values);
}

// More nodes than a block holds, so that tuples and cells lie across the borders of blocks.
TEST_F(AppendedVtu, ReadsMoreThanABlock) {
  SimplexMesh<3> large = box_mesh<3>({30, 30, 30}, Vec<3>(0, 0, 0), Vec<3>(7.3, 9.1, 11.7));
  MetricField<3> metric;
  for (const Vec<3>& x : large.points) metric.push_back(x * x.transpose());
  MeshFields fields;
  fields.metric = &metric;
  ASSERT_TRUE(write_vtu(large, fields, file));
  const std::optional<MeshContent> back = read_appended_vtu(file);
  ASSERT_TRUE(back);
  EXPECT_EQ(back->mesh.points, large.points);
  EXPECT_EQ(back->mesh.elements, large.elements);
  EXPECT_EQ(back->mesh.facets, large.facets);
  metric[0] = back->metric.at(0);
  EXPECT_EQ(back->metric, metric);
}

TEST_F(AppendedVtu, LeavesWhatIsNotSoundToOthers) {
  const std::string good = read_file(file).value();
  const auto read_with = [&](const std::string& what, const std::string& by) {
    std::string bytes = good;
    const std::size_t at = bytes.find(what);
    EXPECT_NE(at, std::string::npos) << what;
    EXPECT_EQ(what.size(), by.size()) << "other offsets would be wrong by themselves";
    bytes.replace(at, what.size(), by);
    EXPECT_TRUE(write_file(file, bytes));
    return read_appended_vtu(file).has_value();
  };
  EXPECT_TRUE(read_with("LittleEndian", "LittleEndian"));
  EXPECT_FALSE(read_with("LittleEndian", "BigEndianOf "));
  EXPECT_FALSE(read_with("UnstructuredGrid", "PolygonDataGrids"));
  EXPECT_FALSE(read_with("NumberOfPoints=\"140\"", "NumberOfPoints=\"139\""));
  EXPECT_FALSE(read_with("\"Int32\" Name=\"connectivity\"", "\"Int64\" Name=\"connectivity\""));
  EXPECT_FALSE(read_with("</VTKFile>", "          "));
  // Every byte of the packed data counts: zlib has a sum of each block.
  const std::size_t begin = good.find("<AppendedData");
  int refused = 0;
  for (std::size_t k = 1; k <= 20; ++k) {
    std::string bytes = good;
    bytes[begin + k * (bytes.size() - begin) / 22] ^= 0x55;
    ASSERT_TRUE(write_file(file, bytes));
    refused += read_appended_vtu(file) ? 0 : 1;
  }
  EXPECT_EQ(refused, 20);
}

}  // namespace
}  // namespace lamella
