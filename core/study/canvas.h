#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/png.h"
#include "core/geometry/simplex.h"

namespace lamella {

struct Rgb {
  float r = 1, g = 1, b = 1;
};
inline Rgb operator*(float f, const Rgb& c) { return {f * c.r, f * c.g, f * c.b}; }

/// Pixels of a picture from left and top.
struct PixelBox {
  double left = 0, top = 0, right = 0, bottom = 0;
};

/// Draws triangles and lines without any display; what is nearer to the eye hides the rest.
/// Coordinates are pixels from left and top, and z towards the eye; each pixel is the mean of four.
class Canvas {
 public:
  Canvas(int width, int height);

  /// Nothing is drawn outside of it.
  void clip(const PixelBox& box);

  /// `shade(a, b, c)` tells the color where the corners have these shares.
  template <class Shade>
  void triangle(const std::array<Vec<3>, 3>& corners, Shade&& shade);

  /// One pixel wide, `share` of it covers what is below; `lift` brings it nearer to the eye.
  void line(const Vec<3>& a, const Vec<3>& b, const Rgb& color, double share, double lift = 0);
  void circle(const Vec<3>& center, double radius, const Rgb& color);

  Image image() const;

 private:
  static constexpr int kFine = 2;
  std::size_t at(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
           static_cast<std::size_t>(x);
  }

  int width_, height_;  // of the fine pixels
  int left_, top_, right_, bottom_;
  std::vector<Rgb> color_;
  std::vector<float> depth_;
};

template <class Shade>
void Canvas::triangle(const std::array<Vec<3>, 3>& corners, Shade&& shade) {
  std::array<Vec<3>, 3> p;
  for (int k = 0; k < 3; ++k)
    p[k] = Vec<3>(kFine * corners[k][0] - 0.5, kFine * corners[k][1] - 0.5, corners[k][2]);
  const auto cross = [](const Vec<3>& a, const Vec<3>& b, double x, double y) {
    return (b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0]);
  };
  const double area = cross(p[0], p[1], p[2][0], p[2][1]);
  if (area == 0 || !std::isfinite(area)) return;
  const auto [x0, x1] = std::minmax({p[0][0], p[1][0], p[2][0]});
  const auto [y0, y1] = std::minmax({p[0][1], p[1][1], p[2][1]});
  // Rounded after they are clipped: a point may be anywhere.
  const auto inside = [](double v, int low, int high) {
    return std::clamp(v, static_cast<double>(low), static_cast<double>(high));
  };
  const int xa = static_cast<int>(std::ceil(inside(x0, left_, right_)));
  const int xb = static_cast<int>(std::floor(inside(x1, left_ - 1, right_ - 1)));
  const int ya = static_cast<int>(std::ceil(inside(y0, top_, bottom_)));
  const int yb = static_cast<int>(std::floor(inside(y1, top_ - 1, bottom_ - 1)));
  for (int y = ya; y <= yb; ++y)
    for (int x = xa; x <= xb; ++x) {
      const double a = cross(p[1], p[2], x, y) / area, b = cross(p[2], p[0], x, y) / area;
      const double c = 1 - a - b;
      if (a < 0 || b < 0 || c < 0) continue;
      const auto z = static_cast<float>(a * p[0][2] + b * p[1][2] + c * p[2][2]);
      if (z < depth_[at(x, y)]) continue;
      depth_[at(x, y)] = z;
      color_[at(x, y)] = shade(a, b, c);
    }
}

}  // namespace lamella
