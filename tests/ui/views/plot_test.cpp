#include "ui/views/plot.h"

#include <gtest/gtest.h>

#include <QImage>

namespace lamella::ui {
namespace {

/// Whether some pixel of the place is nearer to the color than to white and to black.
bool shows(const QImage& image, const QRectF& place, const QColor& color) {
  const QRect pixels = place.toAlignedRect() & image.rect();
  for (int y = pixels.top(); y <= pixels.bottom(); ++y)
    for (int x = pixels.left(); x <= pixels.right(); ++x) {
      const QColor seen = image.pixelColor(x, y);
      if (std::abs(seen.red() - color.red()) + std::abs(seen.green() - color.green()) +
              std::abs(seen.blue() - color.blue()) <
          60)
        return true;
    }
  return false;
}

TEST(Plot, NameOfTheTargetLiesOnNoCurve) {
  const QColor blue(0x1d, 0x6f, 0xc4), amber(0xd0, 0x87, 0x1e);
  const std::vector<std::vector<double>> runs[] = {
      {{2.2, 2.9, 3.1, 3.05, 3.1}, {1.2, 2.1, 2.6, 2.7, 2.8}},  // from below up to it
      {{3.4, 3.3, 3.2, 3.1, 3.1}, {2.9, 2.9, 2.9, 2.9, 2.9}},   // on both sides of it
      {{0.9, 3.6, 3.2, 3.1, 3.0}, {0.5, 2.9, 2.6, 2.7, 2.6}},   // steeply through it
      {{3.0}, {2.4}},                                           // the first mesh alone
  };
  for (const int width : {160, 260, 420})
    for (const auto& run : runs) {
      Plot plot("Layers");
      plot.resize(width, 170);
      plot.set_series({{"mean", blue, run[0]}, {"5 %", amber, run[1]}});
      plot.set_target(3, "asked");
      const QImage image = plot.grab().toImage();
      const QRectF label = plot.target_label();
      ASSERT_FALSE(label.isEmpty());
      EXPECT_TRUE(QRectF(plot.rect()).contains(label));
      for (const QColor& color : {blue, amber})
        EXPECT_FALSE(shows(image, label, color)) << width << " " << run[0].size();
    }
}

}  // namespace
}  // namespace lamella::ui
