#pragma once

#include <QImage>
#include <algorithm>
#include <cstdlib>

namespace lamella::ui {

/// Pictures of the window that are apart by less than this look the same.
constexpr double looks_alike = 0.01;

/// Share of two pictures that looks different, in [0, 1]; 1 where their shapes differ. Both are
/// made small and smooth first: how letters are hinted and lines smoothed is gone then, a panel
/// that is missing or another color is not.
inline double looks_apart(const QImage& a, const QImage& b) {
  constexpr int width = 160;  // spots
  constexpr int apart = 20;   // of 255, in one of the three colors
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
  for (int y = 1; y + 1 < height; ++y)
    for (int x = 1; x + 1 < width; ++x) {
      int red = 0, green = 0, blue = 0;  // of the nine spots around
      for (int v = y - 1; v <= y + 1; ++v)
        for (int u = x - 1; u <= x + 1; ++u) {
          const QRgb c = p.pixel(u, v), d = q.pixel(u, v);
          red += qRed(c) - qRed(d);
          green += qGreen(c) - qGreen(d);
          blue += qBlue(c) - qBlue(d);
        }
      different += std::max({std::abs(red), std::abs(green), std::abs(blue)}) > 9 * apart;
    }
  return double(different) / (double(width - 2) * (height - 2));
}

}  // namespace lamella::ui
