#include "core/study/report_pictures.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/box_mesh.h"

namespace lamella {
namespace {

TEST(Canvas, FillsATriangleByItsAreaAndLetsTheNearerHide) {
  Canvas canvas(40, 30);
  const std::array<Vec<3>, 3> far{Vec<3>(0, 0, 0), Vec<3>(40, 0, 0), Vec<3>(0, 30, 0)};
  canvas.triangle(far, [](double, double, double) { return Rgb{1, 0, 0}; });
  const std::array<Vec<3>, 3> near{Vec<3>(0, 0, 1), Vec<3>(10, 0, 1), Vec<3>(0, 10, 1)};
  canvas.triangle(near, [](double, double, double) { return Rgb{0, 0, 1}; });
  canvas.triangle(far, [](double, double, double) { return Rgb{0, 1, 0}; });
  const Image image = canvas.image();
  double red = 0, green = 0, blue = 0;
  for (std::size_t k = 0; k < image.rgb.size(); k += 3) {
    const bool white = image.rgb[k] == 255 && image.rgb[k + 1] == 255 && image.rgb[k + 2] == 255;
    if (white) continue;
    red += image.rgb[k] == 255 && image.rgb[k + 1] == 0;
    green += image.rgb[k + 1] > 250 && image.rgb[k + 2] < 5;
    blue += image.rgb[k + 2] > 250 && image.rgb[k + 1] < 5;
  }
  EXPECT_EQ(red, 0) << "drawn once more, the same triangle covers itself";
  EXPECT_NEAR(green, 600 - 50, 40) << "but for the pixels on its edge";
  EXPECT_NEAR(blue, 50, 12);
}

TEST(Canvas, TakesPointsFromAnywhere) {
  Canvas canvas(20, 20);
  const Vec<3> a(-1e12, -3e11, 0), b(1e12, 4e11, 0), c(5, 1e12, 0);
  canvas.triangle({a, b, c}, [](double, double, double) { return Rgb{0, 0, 0}; });
  canvas.line(a, b, {1, 0, 0}, 1, 1);
  canvas.line(Vec<3>::Constant(std::nan("")), b, {1, 0, 0}, 1);
  EXPECT_EQ(canvas.image().rgb.size(), 20u * 20u * 3u);
}

MeshState slab(int layers) {
  MeshState state;
  state.mesh = test::box_mesh(12, 8, layers);
  for (Vec<3>& x : state.mesh.points) x[2] /= layers;
  state.thickness.assign(state.mesh.points.size(), 1);
  state.layers.assign(state.mesh.points.size(), layers);
  return state;
}

TEST(ReportPictures, ShowLayersAndTwoSectionsAcrossTheLongSides) {
  const MeshState state = slab(4);
  const Result<std::optional<ReportPicture>> map = layers_map({}, state);
  ASSERT_TRUE(map.ok() && map->has_value());
  EXPECT_EQ((*map)->width, 1400);
  const Result<std::vector<ReportPicture>> cut = sections({}, state);
  ASSERT_TRUE(cut.ok());
  ASSERT_EQ(cut->size(), 2u);
  EXPECT_TRUE((*cut)[0].caption.starts_with("Section x = ")) << (*cut)[0].caption;
  EXPECT_TRUE((*cut)[1].caption.starts_with("Section y = ")) << (*cut)[1].caption;
  EXPECT_NE((*cut)[0].caption.find("a wall of 1 mm"), std::string::npos);
}

TEST(ReportPictures, AreThoseOfTheStudyWhereItHasCuts) {
  Study study;
  study.cuts = {{"near the gate", Vec<3>(1, 1, 0.5), Vec<3>::UnitZ()}};
  const Result<std::vector<ReportPicture>> cut = sections(study, slab(2));
  ASSERT_TRUE(cut.ok());
  ASSERT_EQ(cut->size(), 1u);
  EXPECT_TRUE((*cut)[0].caption.starts_with("Section near the gate"));
}

TEST(ReportPictures, AreLeftOutWhereNothingWasMeasured) {
  MeshState state = slab(2);
  state.layers.assign(state.layers.size(), std::nan(""));
  state.thickness.clear();
  EXPECT_FALSE(layers_map({}, state)->has_value());
  EXPECT_EQ(sections({}, state)->size(), 2u);
}

TEST(ReportPictures, CanBeCancelled) {
  std::stop_source stop;
  stop.request_stop();
  const Progress progress({}, stop.get_token());
  EXPECT_EQ(sections({}, slab(2), progress).error().code, Code::cancelled);
}

}  // namespace
}  // namespace lamella
