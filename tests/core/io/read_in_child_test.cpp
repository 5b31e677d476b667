#include "core/io/read_in_child.h"

#include <gtest/gtest.h>

#include <csignal>

#include "core/base/atomic_file.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/three_bodies.h"

namespace lamella {
namespace {

class ReadInChild : public testing::Test {
 protected:
  const test::TemporaryFolder folder;
  const std::filesystem::path file = folder / "m.x";

  void SetUp() override { ASSERT_TRUE(write_file(file, "anything").ok()); }
  Error refusal(Result<MeshContent> (*read)(const std::filesystem::path&, const Progress&)) const {
    const Result<MeshContent> content = read_in_child(file, read, {});
    return content ? Error{Code::usage, "it was read", ""} : content.error();
  }
};

TEST_F(ReadInChild, AllThatWasReadComesBack) {
  const test::ThreeBodies made;
  MeshContent sent;
  sent.mesh = made.mesh;
  sent.metric = made.metric;
  sent.thickness = {0, 1, 2};
  sent.layers = {3};
  sent.quality = {4, 5};
  sent.of_elements = made.fields.of_elements;
  sent.of_nodes = {{"velocity", 3, {1, 2, 3}}};
  const Metric<3> stress = Vec<3>(1, 2, 3).asDiagonal();
  sent.tensors = {{"stress", false, {stress}}};
  sent.unit = LengthUnit::m;
  sent.provenance = "{}";
  const Result<MeshContent> back = read_in_child(
      file,
      [&](const std::filesystem::path& asked, const Progress&) -> Result<MeshContent> {
        if (asked != file) return Error{};
        return sent;
      },
      {});
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_EQ(back->mesh.points, sent.mesh.points);
  EXPECT_EQ(back->mesh.elements, sent.mesh.elements);
  EXPECT_EQ(back->mesh.element_body, sent.mesh.element_body);
  EXPECT_EQ(back->mesh.facets, sent.mesh.facets);
  EXPECT_EQ(back->mesh.facet_group, sent.mesh.facet_group);
  EXPECT_EQ(back->mesh.facet_face, sent.mesh.facet_face);
  EXPECT_EQ(back->mesh.bodies, sent.mesh.bodies);
  EXPECT_EQ(back->mesh.groups, sent.mesh.groups);
  EXPECT_EQ(back->metric, sent.metric);
  EXPECT_EQ(back->thickness, sent.thickness);
  EXPECT_EQ(back->layers, sent.layers);
  EXPECT_EQ(back->quality, sent.quality);
  ASSERT_EQ(back->tensors.size(), 1u);
  EXPECT_EQ(back->tensors[0].name, "stress");
  EXPECT_FALSE(back->tensors[0].of_nodes);
  EXPECT_EQ(back->tensors[0].values, sent.tensors[0].values);
  ASSERT_EQ(back->of_elements.size(), sent.of_elements.size());
  EXPECT_EQ(back->of_elements[2].name, sent.of_elements[2].name);
  EXPECT_EQ(back->of_elements[2].values, sent.of_elements[2].values);
  ASSERT_EQ(back->of_nodes.size(), 1u);
  EXPECT_EQ(back->of_nodes[0].components, 3);
  EXPECT_EQ(back->of_nodes[0].values, sent.of_nodes[0].values);
  EXPECT_EQ(back->unit, LengthUnit::m);
  EXPECT_EQ(back->provenance, "{}");
}

TEST_F(ReadInChild, AnErrorComesBackAsItIs) {
  const Error error =
      refusal([](const std::filesystem::path&, const Progress&) -> Result<MeshContent> {
        return Error{Code::io, "gone", "look"};
      });
  EXPECT_EQ(error.code, Code::io);
  EXPECT_EQ(error.message, "gone");
  EXPECT_EQ(error.hint, "look");
}

TEST_F(ReadInChild, ACrashIsABadFile) {
  const Error error =
      refusal([](const std::filesystem::path&, const Progress&) -> Result<MeshContent> {
        std::raise(SIGSEGV);
        return MeshContent{};
      });
  EXPECT_EQ(error.code, Code::bad_input);
  EXPECT_NE(error.message.find("m.x\": it could not be read, it crashed"), std::string::npos)
      << error.message;
}

TEST_F(ReadInChild, WhatAsksForFarMoreThanTheFileHoldsIsABadFile) {
  const Error error =
      refusal([](const std::filesystem::path&, const Progress&) -> Result<MeshContent> {
        MeshContent content;
        content.quality.resize(1ull << 29);  // 4 GB, for a file of eight bytes
        return content;
      });
  EXPECT_EQ(error.code, Code::bad_input);
  EXPECT_NE(error.message.find("memory"), std::string::npos) << error.message;
}

}  // namespace
}  // namespace lamella
