#pragma once

#include <gtest/gtest.h>

#include <algorithm>

#include "core/base/atomic_file.h"
#include "core/io/mesh_file.h"
#include "core/mesh/validate.h"
#include "tests/support/damage.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/three_bodies.h"

namespace lamella::test {

/// What every format owes its user, whatever it holds itself: tests are instantiated for each.
class FormatContract : public testing::TestWithParam<MeshFormat> {
 protected:
  const TemporaryFolder folder;
  const MeshFormat& format() const { return GetParam(); }
  std::filesystem::path file() const { return folder / ("m" + format().endings.front()); }
};

TEST_P(FormatContract, NamesAreasVolumesMetricAndRatiosReadBack) {
  for (const ThreeBodies& made : {ThreeBodies(), three_bodies_of_odd_names()}) {
    const Result<ExportCertificate> proof =
        write_mesh_file(format(), made.mesh, made.with_metric(), file());
    ASSERT_TRUE(proof.ok()) << proof.error().message;
    EXPECT_TRUE(proof->agrees);
    if (format().boundary_only) continue;
    const Result<MeshContent> back = read_mesh_file(format(), file());
    ASSERT_TRUE(back.ok()) << back.error().message;
    EXPECT_TRUE(validate<3>(back->mesh).ok());
    ASSERT_EQ(back->metric.size(), made.metric.size());
    EXPECT_LE((back->metric[9] - made.metric[9]).norm(), 1e-9 * made.metric[9].norm());
    EXPECT_EQ(back->mesh.bodies, made.mesh.bodies);
    EXPECT_EQ(back->mesh.groups, made.mesh.groups);
    const MeshSummary read = summarize(back->mesh);
    EXPECT_NEAR(read.bodies[1].measure, 16, 1e-9);
    EXPECT_NEAR(read.groups[1].measure, 8, 1e-9);
    ASSERT_EQ(back->of_elements.size(), 3u);
    for (const std::string& body : made.mesh.bodies)
      EXPECT_TRUE(std::any_of(back->of_elements.begin(), back->of_elements.end(),
                              [&](const ElementField& f) { return f.name == "filling " + body; }))
          << body;
    for (std::size_t e = 0; e < back->mesh.elements.size(); ++e) {
      double sum = 0;
      for (const ElementField& field : back->of_elements) sum += field.values[e];
      ASSERT_EQ(sum, 1) << e;
    }
  }
}

TEST_P(FormatContract, MetersComeBackAsMillimeters) {
  const ThreeBodies made;
  const auto proof =
      write_mesh_file(format(), made.mesh, made.with_metric(), file(), LengthUnit::m);
  ASSERT_TRUE(proof.ok()) << proof.error().message;
  if (format().boundary_only) return;
  const Result<MeshContent> raw = format().read(file(), {});
  ASSERT_TRUE(raw.ok());
  EXPECT_NEAR(raw->mesh.points.back()[0], 6e-3, 1e-12);
}

TEST_P(FormatContract, AnUnlistedBoundaryIsListedAndAnUnusedNodeDoesNoHarm) {
  ThreeBodies made;
  SimplexMesh<3>& mesh = made.mesh;
  for (auto* list : {&mesh.facet_group, &mesh.facet_face}) list->erase(list->begin());
  mesh.facets.erase(mesh.facets.begin());
  mesh.points.insert(mesh.points.begin() + 1, Vec<3>(50, 50, 50));
  made.metric.insert(made.metric.begin() + 1, 3 * Metric<3>::Identity());
  for (auto& e : mesh.elements)
    for (NodeId& v : e) ++v;
  for (auto& f : mesh.facets)
    for (NodeId& v : f) ++v;
  const auto proof = write_mesh_file(format(), mesh, made.with_metric(), file());
  ASSERT_TRUE(proof.ok()) << proof.error().message;
  if (format().groups && !format().boundary_only) {
    EXPECT_EQ(proof->read_back.groups.back().name, "unnamed");
    EXPECT_EQ(proof->read_back.groups.back().count, 1u);
  }
}

TEST_P(FormatContract, TheMeshIsGoodWithoutItsSidecar) {
  if (format().boundary_only) return;
  const ThreeBodies made;
  ASSERT_TRUE(write_mesh_file(format(), made.mesh, {}, file()).ok());
  std::filesystem::remove(sidecar_of(file()));
  const Result<MeshContent> back = read_mesh_file(format(), file());
  ASSERT_TRUE(back.ok()) << back.error().message;
  EXPECT_TRUE(validate<3>(back->mesh).ok());
  const MeshSummary written = summarize(made.mesh), read = summarize(back->mesh);
  ASSERT_EQ(read.bodies.size(), format().bodies ? 3u : 1u);
  if (!format().groups) return;
  for (std::size_t g = 0; g < written.groups.size(); ++g)
    EXPECT_EQ(read.groups[g].count, written.groups[g].count);
}

TEST_P(FormatContract, ASidecarOfAnotherMeshIsLeftAlone) {
  if (format().boundary_only || format().provenance) return;
  const ThreeBodies made;
  ASSERT_TRUE(write_mesh_file(format(), made.mesh, {}, file()).ok());
  const Result<MeshContent> before = format().read(file(), {});
  ASSERT_TRUE(before.ok());
  ASSERT_TRUE(write_file(sidecar_of(file()),
                         R"({"nodes": 3, "elements": 1, "unit": "m", "bodies": [{"name": "other",
                             "name_in_file": "cover"}]})")
                  .ok());
  const Result<MeshContent> back = read_mesh_file(format(), file());
  ASSERT_TRUE(back.ok());
  EXPECT_EQ(back->mesh.bodies, before->mesh.bodies);
}

TEST_P(FormatContract, CutFilesAreRefusedNotTaken) {
  const ThreeBodies made;
  ASSERT_TRUE(write_mesh_file(format(), made.mesh, {}, file()).ok());
  if (format().boundary_only || format().name == "openfoam") return;
  const std::string bytes = read_file(file()).value();
  for (const double share : {0.0, 0.05, 0.3, 0.5}) {
    const auto length = static_cast<std::size_t>(share * static_cast<double>(bytes.size()));
    ASSERT_TRUE(write_file(file(), bytes.substr(0, length)).ok());
    const Result<MeshContent> cut = read_mesh_file(format(), file());
    if (cut) {
      // A text that ends between two lists is a file of its own; it must not pass for the whole.
      EXPECT_FALSE(certify("m", format().title, summarize(made.mesh), summarize(cut->mesh)).agrees)
          << share;
      continue;
    }
    EXPECT_EQ(cut.error().code, Code::bad_input) << share;
    EXPECT_NE(cut.error().message.find("m" + format().endings.front()), std::string::npos);
  }
}

TEST_P(FormatContract, ADamagedFileIsAnErrorOrAMesh) {
  if (format().boundary_only) return;
  const ThreeBodies made;
  ASSERT_TRUE(write_mesh_file(format(), made.mesh, made.with_metric(), file()).ok());
  // A format may be several files, of which one is damaged.
  std::vector<std::pair<std::filesystem::path, std::string>> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder.path()))
    if (entry.is_regular_file()) files.emplace_back(entry.path(), read_file(entry.path()).value());
  std::sort(files.begin(), files.end());
  std::mt19937 random(1);
  // VTK and the others believe lengths of any size: seconds a file.
  const bool library = format().name == "vtu" || format().name == "exodus" ||
                       format().name == "med" || format().name == "cgns";
  const int rounds = damage_rounds(library ? 5 : 100);
  for (int k = 0; k < rounds; ++k) {
    const auto& [path, bytes] = files[random() % files.size()];
    ASSERT_TRUE(write_file(path, damaged(bytes, random)).ok());
    const Result<MeshContent> content = read_mesh_file(format(), file());
    if (content) {
      const MeshReport found = inspect<3>(content->mesh).value();
      EXPECT_EQ(found.bad_arrays + found.bad_indices + found.bad_points, 0u)
          << "round " << k << ": " << found.first_finding;
    } else {
      EXPECT_FALSE(content.error().message.empty()) << "round " << k;
    }
    ASSERT_TRUE(write_file(path, bytes).ok());
  }
}

TEST_P(FormatContract, ACancelledExportLeavesNoMesh) {
  std::stop_source stop;
  stop.request_stop();
  const ThreeBodies made;
  const auto proof = write_mesh_file(format(), made.mesh, {}, file(), LengthUnit::mm,
                                     Progress({}, stop.get_token()));
  ASSERT_FALSE(proof.ok());
  EXPECT_EQ(proof.error().code, Code::cancelled);
  EXPECT_TRUE(folder.names().empty());
}

inline std::string format_name(const testing::TestParamInfo<MeshFormat>& info) {
  return info.param.name;
}

}  // namespace lamella::test
