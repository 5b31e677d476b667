#include "core/netgen/netgen_mesher.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <thread>

#include "core/optimize/certificate.h"
#include "tests/support/test_surfaces.h"

namespace lamella {
namespace {

void expect_meshed(const ReferenceSurface<3>& surface) {
  const auto mesh = netgen_mesher()->generate(surface, {});
  ASSERT_TRUE(mesh.ok()) << mesh.error().message;
  const auto valid = certify<3>(*mesh, surface);
  EXPECT_TRUE(valid.ok()) << valid.error().message;
  EXPECT_EQ(mesh->facets.size(), surface.facets.size());
  EXPECT_EQ(mesh->facet_face, surface.facet_face);
  for (std::size_t i = 0; i < surface.points.size(); ++i)
    EXPECT_EQ(mesh->points[i + 1], surface.points[i]);
  testing::Test::RecordProperty("nodes", static_cast<int>(mesh->node_count()));
  testing::Test::RecordProperty("elements", static_cast<int>(mesh->element_count()));
}

TEST(NetgenMesher, FillsConvexAndConcaveBodies) {
  expect_meshed(test::box(2, 3, 1));
  expect_meshed(test::ell(2));
  expect_meshed(test::tee(2));
}

TEST(NetgenMesher, KeepsACavityEmpty) {
  expect_meshed(test::joined(test::sphere(6, 2.0), test::sphere(4, 1.0, true)));
}

TEST(NetgenMesher, KeepsNodeNumbersWhenAPointHasNoFacet) {
  auto surface = test::box(1, 1, 1);
  surface.points.insert(surface.points.begin() + 3, Vec<3>(9, 9, 9));
  for (auto& f : surface.facets)
    for (auto& v : f)
      if (v >= 3) ++v;
  expect_meshed(surface);
}

TEST(NetgenMesher, MeshesARealPart) {
  const std::string path = std::string(LAMELLA_REAL_PARTS) + "/netgen_hinge_ascii.stl";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "missing " << path;
  expect_meshed(test::ascii_stl(path));
}

TEST(NetgenMesher, RefusesWhatIsNotClosed) {
  auto surface = test::box(2, 2, 2);
  surface.facets.pop_back();
  surface.facet_face.pop_back();
  const auto mesh = netgen_mesher()->generate(surface, {});
  ASSERT_FALSE(mesh.ok());
  EXPECT_EQ(mesh.error().code, Code::failed);
  EXPECT_NE(mesh.error().message.find("not consistent"), std::string::npos) << mesh.error().message;
}

TEST(NetgenMesher, SaysNothingAndLeavesNoFile) {
  auto open = test::box(2, 2, 2);
  open.facets.pop_back();
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  EXPECT_FALSE(netgen_mesher()->generate(open, {}).ok());
  EXPECT_TRUE(netgen_mesher()->generate(test::box(2, 2, 2), {}).ok());
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  EXPECT_FALSE(std::filesystem::exists("test.out"));
}

TEST(NetgenMesher, StopsWhenCancelled) {
  std::stop_source stop;
  stop.request_stop();
  const auto mesh = netgen_mesher()->generate(test::box(2, 2, 2), Progress({}, stop.get_token()));
  ASSERT_FALSE(mesh.ok());
  EXPECT_EQ(mesh.error().code, Code::cancelled);
}

TEST(NetgenMesher, SurvivesACrashOfTheLibrary) {
  const auto crash = [](const ReferenceSurface<3>& surface) -> std::string {
    if (!surface.facets.empty()) ::raise(SIGSEGV);
    return "";
  };
  const auto mesh = netgen_mesher({}, crash)->generate(test::box(1, 1, 1), {});
  ASSERT_FALSE(mesh.ok());
  EXPECT_EQ(mesh.error().code, Code::failed);
  EXPECT_EQ(mesh.error().message,
            "Netgen could not mesh the volume: it crashed (Segmentation fault).");
  EXPECT_FALSE(mesh.error().hint.empty());
}

TEST(NetgenMesher, RefusesAnAnswerThatMakesNoSense) {
  const auto good = run_netgen(test::box(1, 1, 1));
  const auto error_of = [&](const std::string& bytes) {
    const auto mesh =
        netgen_mesher({}, [&](const auto&) { return bytes; })->generate(test::box(1, 1, 1), {});
    return mesh.ok() ? std::string() : mesh.error().message;
  };
  EXPECT_EQ(error_of(good), "");
  EXPECT_NE(error_of(good.substr(0, good.size() - 4)).find("cut off"), std::string::npos);
  EXPECT_NE(error_of("").find("cut off"), std::string::npos);
  std::string far = good;
  far.back() = 0x7f;  // the highest byte of the last node number
  EXPECT_NE(error_of(far).find("unknown nodes"), std::string::npos);
}

std::string never_ends(const ReferenceSurface<3>&) {
  for (;;) ::pause();
}

TEST(NetgenMesher, GivesUpAtItsTimeLimit) {
  const auto mesh = netgen_mesher({0.1}, never_ends)->generate(test::box(1, 1, 1), {});
  ASSERT_FALSE(mesh.ok());
  EXPECT_EQ(mesh.error().code, Code::failed);
  EXPECT_NE(mesh.error().message.find("0.1 s"), std::string::npos) << mesh.error().message;
}

TEST(NetgenMesher, StopsInTheMiddleWhenCancelled) {
  std::stop_source stop;
  const std::jthread user([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    stop.request_stop();
  });
  const auto start = std::chrono::steady_clock::now();
  const auto mesh =
      netgen_mesher({}, never_ends)->generate(test::box(1, 1, 1), Progress({}, stop.get_token()));
  ASSERT_FALSE(mesh.ok());
  EXPECT_EQ(mesh.error().code, Code::cancelled);
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(10));
}

}  // namespace
}  // namespace lamella
