#pragma once

#include <QImage>
#include <algorithm>
#include <cstdlib>

namespace lamella::ui {

/// Pictures of the window that are apart by less than this look the same.
constexpr double looks_alike = 0.03;

/// Share of two pictures that looks different, in [0, 1]; 1 where their shapes differ. Both are
/// made so small that letters are no more than gray: how they are hinted and smoothed is gone then,
/// a panel that is missing or another color is not.
inline double looks_apart(const QImage& a, const QImage& b) {
  constexpr int width = 32;  // spots
  constexpr int apart = 5;   // of 255, in one of the three colors
  if (a.isNull() || b.isNull() ||
      std::abs(double(a.width()) * b.height() / (double(a.height()) * b.width()) - 1) > 0.02)
    return 1;
  const int height = width * a.height() / a.width();
  const auto small = [&](const QImage& image) {
    return image.convertToFormat(QImage::Format_RGB32)
        .scaled(width, height, Qt::IgnoreAspectRatio, Qt::SmoothTransformation);
  };
  const QImage p = small(a), q = small(b);
  int different = 0;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const QRgb c = p.pixel(x, y), d = q.pixel(x, y);
      different += std::max({std::abs(qRed(c) - qRed(d)), std::abs(qGreen(c) - qGreen(d)),
                             std::abs(qBlue(c) - qBlue(d))}) > apart;
    }
  return double(different) / (double(width) * height);
}

}  // namespace lamella::ui
