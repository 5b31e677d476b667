#include "core/io_vtk/vtu.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/atomic_file.h"
#include "core/io/export_certificate.h"
#include "core/io/vtu.h"
#include "tests/support/box_mesh.h"
#include "tests/support/temporary_folder.h"

namespace lamella {
namespace {

/// What is written by hand, as VTK reads it.
class Vtu : public testing::Test {
 protected:
  const test::TemporaryFolder folder;
  const SimplexMesh<3> mesh = test::box_mesh(2, 2, 1, true);
  MetricField<3> metric;
  std::vector<double> thickness, layers, quality;

  void SetUp() override {
    for (const Vec<3>& x : mesh.points) {
      metric.push_back((x + Vec<3>(1, 2, 4)) * (x + Vec<3>(1, 2, 4)).transpose() +
                       Metric<3>::Identity());
      thickness.push_back(x.norm() + 0.1);
      layers.push_back(x[0] > 1 ? std::nan("") : 4);
    }
    quality.assign(mesh.elements.size(), 0.75);
  }
  Result<void> write(const Progress& progress = {}) const {
    MeshFields fields;
    fields.metric = &metric;
    fields.thickness = &thickness;
    fields.layers = &layers;
    fields.quality = &quality;
    fields.of_elements = {{"filling A", std::vector<double>(mesh.elements.size(), 0.3)}};
    fields.of_nodes = {{"pressure", 1, layers}, {"velocity", 3, {}}};
    for (const Vec<3>& x : mesh.points)
      for (int c = 0; c < 3; ++c) fields.of_nodes[1].values.push_back(2 * x[c]);
    return write_vtu(mesh, fields, folder / "m.vtu", progress);
  }
};

TEST_F(Vtu, VtkReadsMeshNamesAndFields) {
  ASSERT_TRUE(write().ok());
  EXPECT_EQ(folder.names(), std::vector<std::string>{"m.vtu"});
  const Result<MeshContent> back = read_vtu(folder / "m.vtu");
  ASSERT_TRUE(back.ok()) << back.error().message;
  const ExportCertificate proof =
      certify("m.vtu", "VTK VTU", summarize(mesh), summarize(back->mesh));
  EXPECT_TRUE(proof.agrees) << proof.finding;
  EXPECT_EQ(back->mesh.points, mesh.points);
  EXPECT_EQ(back->mesh.elements, mesh.elements);
  EXPECT_EQ(back->mesh.facets, mesh.facets);
  EXPECT_EQ(back->mesh.facet_face, mesh.facet_face);
  EXPECT_EQ(back->metric.at(7), metric[7]);
  EXPECT_EQ(back->thickness.at(7), thickness[7]);
  EXPECT_EQ(std::isnan(back->layers.at(3)), std::isnan(layers[3]));
  EXPECT_EQ(back->quality, quality);
  ASSERT_EQ(back->of_elements.size(), 1u);
  EXPECT_EQ(back->of_elements[0].name, "filling A");
  EXPECT_EQ(back->of_elements[0].values, std::vector<double>(mesh.elements.size(), 0.3));
  ASSERT_EQ(back->of_nodes.size(), 2u);
  EXPECT_EQ(back->of_nodes[0].name, "pressure");
  EXPECT_EQ(back->of_nodes[1].components, 3);
  ASSERT_EQ(back->of_nodes[1].values.size(), 3 * mesh.points.size());
  EXPECT_EQ(back->of_nodes[1].values[3 * 7 + 1], 2 * mesh.points[7][1]);
}

// The reader by hand gives what VTK gives, whichever of them is asked.
TEST_F(Vtu, BothReadersAgree) {
  ASSERT_TRUE(write().ok());
  const Result<MeshContent> vtk = read_vtu(folder / "m.vtu");
  const std::optional<MeshContent> own = read_appended_vtu(folder / "m.vtu");
  ASSERT_TRUE(vtk && own);
  EXPECT_EQ(own->mesh.points, vtk->mesh.points);
  EXPECT_EQ(own->mesh.elements, vtk->mesh.elements);
  EXPECT_EQ(own->mesh.element_body, vtk->mesh.element_body);
  EXPECT_EQ(own->mesh.facets, vtk->mesh.facets);
  EXPECT_EQ(own->mesh.facet_group, vtk->mesh.facet_group);
  EXPECT_EQ(own->mesh.facet_face, vtk->mesh.facet_face);
  EXPECT_EQ(own->mesh.bodies, vtk->mesh.bodies);
  EXPECT_EQ(own->mesh.groups, vtk->mesh.groups);
  EXPECT_EQ(own->metric, vtk->metric);
  EXPECT_EQ(own->thickness, vtk->thickness);
  EXPECT_EQ(own->quality, vtk->quality);
  EXPECT_EQ(own->unit, vtk->unit);
  ASSERT_EQ(own->of_elements.size(), 1u);
  EXPECT_EQ(own->of_elements[0].name, vtk->of_elements[0].name);
  EXPECT_EQ(own->of_elements[0].values, vtk->of_elements[0].values);
  ASSERT_EQ(own->of_nodes.size(), vtk->of_nodes.size());
  EXPECT_EQ(own->of_nodes[1].name, vtk->of_nodes[1].name);
  EXPECT_EQ(own->of_nodes[1].components, vtk->of_nodes[1].components);
  EXPECT_EQ(own->of_nodes[1].values, vtk->of_nodes[1].values);
}

// The order of the six components and the type of the ids are what other programs rely on.
TEST_F(Vtu, DeclaresTensorsAndInt32Bodies) {
  ASSERT_TRUE(write().ok());
  const std::string bytes = read_file(folder / "m.vtu").value();
  EXPECT_NE(bytes.find("Tensors=\"metric\""), std::string::npos);
  EXPECT_NE(bytes.find("type=\"Int32\" Name=\"body\""), std::string::npos);
  EXPECT_NE(bytes.find("type=\"String\" Name=\"group_names\""), std::string::npos);
}

TEST_F(Vtu, DamagedFilesAreRefused) {
  ASSERT_TRUE(write().ok());
  const std::string bytes = read_file(folder / "m.vtu").value();
  for (const std::string& bad : {std::string(), std::string("garbage"), bytes.substr(0, 600),
                                 bytes.substr(0, bytes.size() / 2)}) {
    ASSERT_TRUE(write_file(folder / "bad.vtu", bad).ok());
    const Result<MeshContent> result = read_vtu(folder / "bad.vtu");
    ASSERT_FALSE(result.ok());
    EXPECT_EQ(result.error().code, Code::bad_input);
  }
}

TEST_F(Vtu, CancelLeavesNothingBehind) {
  std::stop_source stop;
  stop.request_stop();
  const Result<void> result = write(Progress({}, stop.get_token()));
  ASSERT_FALSE(result.ok());
  EXPECT_EQ(result.error().code, Code::cancelled);
  EXPECT_TRUE(folder.names().empty());
}

}  // namespace
}  // namespace lamella
