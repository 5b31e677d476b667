#include "core/study/svg_plot.h"

#include <gtest/gtest.h>

#include <limits>
#include <regex>

namespace lamella {
namespace {

/// Heights of the points of the first path.
std::vector<double> heights(const std::string& svg) {
  const std::size_t at = svg.find("<path d=\"");
  const std::string path = svg.substr(at + 9, svg.find('"', at + 9) - at - 9);
  std::vector<double> y;
  const std::regex point("[ML][0-9.]+ ([0-9.]+)");
  for (std::sregex_iterator i(path.begin(), path.end(), point), end; i != end; ++i)
    y.push_back(std::stod((*i)[1]));
  return y;
}

TEST(LogConvergence, EqualRatiosAreEqualHeights) {
  const auto y = heights(svg_log_convergence({{"a", {800, 80, 8, 0.8}}}, "non conformity"));
  ASSERT_EQ(y.size(), 4u);
  EXPECT_LT(y[0], y[1]);
  EXPECT_NEAR(y[1] - y[0], y[2] - y[1], 0.2);  // coordinates have one decimal
  EXPECT_NEAR(y[2] - y[1], y[3] - y[2], 0.2);
}

TEST(LogConvergence, TheCurveStaysInsideTheAxis) {
  for (const double scale : {1e-9, 1.0, 7.3e8})
    for (const double ratio : {1.0, 1.0001, 1.3, 3.9, 4.1, 1e6}) {
      const auto y = heights(svg_log_convergence({{"a", {scale, scale * ratio}}}, "x"));
      ASSERT_EQ(y.size(), 2u) << scale << " " << ratio;
      EXPECT_GE(y[1], 49.9) << scale << " " << ratio;  // below the legend
      EXPECT_LE(y[0], 190.1) << scale << " " << ratio;
    }
}

TEST(LogConvergence, StartsAtTheIterationAsked) {
  const std::vector<Series> series = {{"a", {1000, 100, 3, 2}}};
  EXPECT_EQ(heights(svg_log_convergence(series, "x", 2)).size(), 2u);
  EXPECT_EQ(heights(svg_log_convergence(series, "x", 0)).size(), 4u);
}

TEST(LogConvergence, WhatHasNoLogarithmIsAGap) {
  const double inf = std::numeric_limits<double>::infinity();
  const std::string svg = svg_log_convergence({{"a", {10, 0, inf, 5, 4}}}, "x");
  EXPECT_EQ(heights(svg).size(), 3u);
  EXPECT_EQ(svg.find("inf"), std::string::npos);
  const std::string path = svg.substr(svg.find("<path d=\""), 60);
  EXPECT_EQ(std::count(path.begin(), path.begin() + 50, 'M'), 2);
}

TEST(SvgDocument, HoldsEveryPlotInItsOwnPlace) {
  const std::string plot = svg_log_convergence({{"M < h", {2, 1}}}, "x");
  const std::string svg = svg_document({plot, plot}, "a & b");
  EXPECT_EQ(svg.rfind("<svg xmlns=", 0), 0u);
  EXPECT_NE(svg.find("<svg x=\"0.0\""), std::string::npos);
  EXPECT_NE(svg.find("<svg x=\"480.0\""), std::string::npos);
  EXPECT_NE(svg.find("a &amp; b"), std::string::npos);
  EXPECT_NE(svg.find("M &lt; h"), std::string::npos);
}

}  // namespace
}  // namespace lamella
