#include "core/study/canvas.h"

#include <limits>
#include <numbers>

namespace lamella {

Canvas::Canvas(int width, int height)
    : width_(kFine * width),
      height_(kFine * height),
      left_(0),
      top_(0),
      right_(width_),
      bottom_(height_),
      color_(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_)),
      depth_(color_.size(), -std::numeric_limits<float>::infinity()) {}

void Canvas::clip(const PixelBox& box) {
  left_ = std::clamp(static_cast<int>(kFine * box.left), 0, width_);
  top_ = std::clamp(static_cast<int>(kFine * box.top), 0, height_);
  right_ = std::clamp(static_cast<int>(kFine * box.right), left_, width_);
  bottom_ = std::clamp(static_cast<int>(kFine * box.bottom), top_, height_);
}

void Canvas::line(const Vec<3>& from, const Vec<3>& to, const Rgb& color, double share,
                  double lift) {
  const Vec<3> a(kFine * from[0] - 0.5, kFine * from[1] - 0.5, from[2] + lift);
  const Vec<3> b(kFine * to[0] - 0.5, kFine * to[1] - 0.5, to[2] + lift);
  const double steps = std::max(std::abs(b[0] - a[0]), std::abs(b[1] - a[1]));
  if (!std::isfinite(steps)) return;
  // Only the stretch within the clip box is walked: the line may be far longer than the picture.
  double begin = 0, end = 1;
  for (int k = 0; k < 2; ++k) {
    const double low = k == 0 ? left_ : top_, high = k == 0 ? right_ : bottom_;
    const double d = b[k] - a[k];
    if (d == 0) {
      if (a[k] < low - kFine || a[k] > high) return;
      continue;
    }
    const double t0 = (low - kFine - a[k]) / d, t1 = (high - a[k]) / d;
    begin = std::max(begin, std::min(t0, t1));
    end = std::min(end, std::max(t0, t1));
  }
  if (begin > end) return;
  const auto count = static_cast<int>(std::ceil(steps * (end - begin)));
  const auto w = static_cast<float>(share);
  // Wide across its direction by as many fine pixels as a pixel has.
  const bool flat = std::abs(b[0] - a[0]) > std::abs(b[1] - a[1]);
  for (int i = 0; i <= count; ++i) {
    const double t = begin + (end - begin) * i / std::max(1, count);
    const Vec<3> p = a + t * (b - a);
    for (int k = 0; k < kFine; ++k) {
      const int x = static_cast<int>(std::lround(p[0])) + (flat ? 0 : k);
      const int y = static_cast<int>(std::lround(p[1])) + (flat ? k : 0);
      if (x < left_ || x >= right_ || y < top_ || y >= bottom_) continue;
      if (static_cast<float>(p[2]) < depth_[at(x, y)]) continue;
      Rgb& c = color_[at(x, y)];
      c = {c.r + w * (color.r - c.r), c.g + w * (color.g - c.g), c.b + w * (color.b - c.b)};
    }
  }
}

void Canvas::circle(const Vec<3>& center, double radius, const Rgb& color) {
  constexpr int parts = 90;
  const auto at = [&](int k) {
    const double angle = 2 * std::numbers::pi * k / parts;
    return Vec<3>(center + radius * Vec<3>(std::cos(angle), std::sin(angle), 0));
  };
  for (int k = 0; k < parts; ++k) line(at(k), at(k + 1), color, 1, 1e30);
}

Image Canvas::image() const {
  Image image{width_ / kFine, height_ / kFine, {}};
  image.rgb.reserve(color_.size() / (kFine * kFine) * 3);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      Rgb sum{0, 0, 0};
      for (int j = 0; j < kFine; ++j)
        for (int i = 0; i < kFine; ++i) {
          const Rgb& c = color_[at(kFine * x + i, kFine * y + j)];
          sum = {sum.r + c.r, sum.g + c.g, sum.b + c.b};
        }
      for (const float v : {sum.r, sum.g, sum.b})
        image.rgb.push_back(static_cast<std::uint8_t>(
            std::lround(255 * std::clamp(v / (kFine * kFine), 0.0f, 1.0f))));
    }
  return image;
}

}  // namespace lamella
