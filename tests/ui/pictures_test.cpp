#include <QDir>
#include <QPainter>

#include "tests/ui/looks_apart.h"
#include "tests/ui/window_fixture.h"

namespace lamella::ui {
namespace {

QString reference(const QString& name) {
  return QString(LAMELLA_SOURCE_DIR "/tests/ui/references/%1.png").arg(name);
}

/// Lines of text as they look with one way of drawing letters.
QImage page(QFont::HintingPreference hinting, QFont::StyleStrategy smoothing) {
  QImage image(640, 400, QImage::Format_RGB32);
  image.fill(Qt::white);
  QPainter painter(&image);
  QFont font = qApp->font();
  font.setPointSizeF(7);
  font.setHintingPreference(hinting);
  font.setStyleStrategy(smoothing);
  painter.setFont(font);
  for (int line = 0; line < 16; ++line)
    painter.drawText(20, 25 * (line + 1), "Layers through the walls, 4 asked, 3.8 on average");
  return image;
}

TEST(LooksApart, ForgivesHowLettersAreDrawn) {
  const QImage plain = page(QFont::PreferNoHinting, QFont::PreferAntialias);
  const QImage hinted = page(QFont::PreferFullHinting, QFont::NoSubpixelAntialias);
  QImage empty = plain.copy();
  empty.fill(Qt::white);
  EXPECT_NE(plain, hinted);
  EXPECT_LT(looks_apart(plain, hinted), looks_alike);
  EXPECT_GT(looks_apart(plain, empty), looks_alike) << "no letters at all";
  const QImage window(reference("finished"));
  ASSERT_FALSE(window.isNull());
  EXPECT_EQ(looks_apart(window, window), 0);
  QImage shifted(window.size(), QImage::Format_RGB32);
  shifted.fill(window.pixelColor(0, 0));
  QPainter(&shifted).drawImage(0, 1, window);
  EXPECT_LT(looks_apart(window, shifted), looks_alike) << "by a pixel";
  EXPECT_LT(looks_apart(window, window.scaled(window.size() * 2)), looks_alike);
}

TEST(LooksApart, SeesWhatIsMissingAndOtherColors) {
  const QImage window(reference("finished"));
  ASSERT_FALSE(window.isNull());
  const auto without = [&](const QRect& place) {
    QImage image = window.convertToFormat(QImage::Format_RGB32);
    QPainter(&image).fillRect(place, image.pixelColor(2, 200));
    return image;
  };
  const auto share = [](double x, double y, double w, double h) {
    return QRectF(640 * x, 400 * y, 640 * w, 400 * h).toRect();
  };
  EXPECT_GT(looks_apart(window, without(share(0, 0.1, 0.2, 0.85))), looks_alike) << "the study";
  EXPECT_GT(looks_apart(window, without(share(0.77, 0.1, 0.23, 0.85))), looks_alike)
      << "the properties";
  EXPECT_GT(looks_apart(window, without(share(0.2, 0.7, 0.56, 0.25))), looks_alike) << "the plots";
  EXPECT_GT(looks_apart(window, without(share(0, 0, 1, 0.1))), looks_alike) << "the tool bar";
  EXPECT_GT(looks_apart(window, window.rgbSwapped()), looks_alike) << "red for blue";
  EXPECT_GT(looks_apart(window, QImage(reference("dark"))), looks_alike) << "the other theme";
  EXPECT_GT(looks_apart(window, QImage(reference("study"))), looks_alike) << "another state";
  EXPECT_EQ(looks_apart(window, window.copy(0, 0, 300, 400)), 1);
}

/// The window beside the picture that is kept of it. LAMELLA_REFERENCES=1 keeps new ones.
class PicturesTest : public WindowFixture {
 protected:
  PicturesTest() { window_.resize(1280, 800); }
  ~PicturesTest() override { apply_theme(*qApp); }

  void expect_reference(const QString& name) {
    QTest::qWait(250);
    view()->settle();
    const QImage seen =
        window_.grab().toImage().scaled(640, 400, Qt::IgnoreAspectRatio, Qt::SmoothTransformation);
    if (qEnvironmentVariableIsSet("LAMELLA_REFERENCES")) seen.save(reference(name));
    const double apart = looks_apart(seen, QImage(reference(name)));
    const QString kept = QDir::tempPath() + "/lamella-seen-" + name + ".png";
    if (apart >= looks_alike) seen.save(kept);
    EXPECT_LT(apart, looks_alike) << "look at " << kept.toStdString();
  }
};

TEST_F(PicturesTest, MainStatesLookAsTheyShould) {
  expect_reference("start");
  open_part("plate");
  expect_reference("study");
  run();
  window_.view().set_color_by(ColorBy::layers);
  expect_reference("finished");
  set_dark(true);
  action(Act::section)->setChecked(true);
  expect_reference("dark");
}

}  // namespace
}  // namespace lamella::ui
