#include "ui/theme.h"

#include <QApplication>
#include <QDir>
#include <QFile>
#include <QFontDatabase>
#include <QIconEngine>
#include <QPainter>
#include <QPalette>
#include <QRegularExpression>
#include <QStandardPaths>
#include <QStyleFactory>
#include <QSvgRenderer>
#include <algorithm>
#include <map>
#include <tuple>
#include <utility>
#include <vector>

// Resources of a static library are only linked when asked for, outside of any namespace.
static void load_resources() { Q_INIT_RESOURCE(lamella); }

namespace lamella::ui {
namespace {

/// Lightness turned over: paper becomes night, ink becomes paper, hues stay.
QColor turned(const QColor& color) {
  float h = 0, s = 0, l = 0;
  color.getHslF(&h, &s, &l);
  return QColor::fromHslF(std::max(h, 0.0F), s * 0.85F, 0.12F + 0.78F * (1 - l));
}

/// Every "#rrggbb" of the text in the colors of the dark theme; pure white of an icon stays.
QString turned(QString text, bool white_too) {
  static const QRegularExpression hex("#[0-9a-fA-F]{6}\\b");
  QString out;
  qsizetype from = 0;
  for (auto it = hex.globalMatch(text); it.hasNext();) {
    const QRegularExpressionMatch match = it.next();
    out += text.mid(from, match.capturedStart() - from);
    const QColor color(match.captured());
    out += !white_too && color == QColor(Qt::white) ? match.captured() : turned(color).name();
    from = match.capturedEnd();
  }
  return out + text.mid(from);
}

QByteArray svg_of(const QString& path) {
  QFile file(path);
  if (!file.open(QIODevice::ReadOnly)) return {};
  const QByteArray svg = file.readAll();
  return theme::dark ? turned(QString::fromUtf8(svg), false).toUtf8() : svg;
}

QPixmap render(const QString& path, int size, double opacity) {
  QPixmap pixmap(size, size);
  pixmap.fill(Qt::transparent);
  QPainter painter(&pixmap);
  painter.setOpacity(opacity);
  QSvgRenderer(svg_of(path)).render(&painter);
  return pixmap;
}

void choose_colors(bool dark) {
  static const std::vector<std::pair<QColor*, QColor>> light = [] {
    std::vector<std::pair<QColor*, QColor>> all;
    for (QColor* c : {&theme::text, &theme::soft_text, &theme::faint_text, &theme::window,
                      &theme::panel, &theme::border, &theme::accent, &theme::good, &theme::warning,
                      &theme::danger, &theme::missing})
      all.emplace_back(c, *c);
    return all;
  }();
  theme::dark = dark;
  for (const auto& [color, value] : light) *color = dark ? turned(value) : value;
}

/// An icon that is drawn in the sizes in which it is seen, when it is.
class DrawnIcon : public QIconEngine {
 public:
  explicit DrawnIcon(QString path) : path_(std::move(path)) {}
  QPixmap pixmap(const QSize& size, QIcon::Mode mode, QIcon::State) override {
    const int side = std::min(size.width(), size.height());
    const bool faint = mode == QIcon::Disabled;
    QPixmap& made = drawn_[{side, faint, theme::dark}];
    if (made.isNull()) made = render(path_, side, faint ? 0.35 : 1);
    return made;
  }
  void paint(QPainter* painter, const QRect& rect, QIcon::Mode mode, QIcon::State state) override {
    const double ratio = painter->device()->devicePixelRatio();
    painter->drawPixmap(rect, pixmap((QSizeF(rect.size()) * ratio).toSize(), mode, state));
  }
  QIconEngine* clone() const override { return new DrawnIcon(*this); }

 private:
  QString path_;
  std::map<std::tuple<int, bool, bool>, QPixmap> drawn_;  // side, faint, of the dark theme
};

/// The icons that the style sheet names, in the colors of the theme, in a folder of their own.
QString icons_of_sheet(const QString& sheet) {
  const QString folder =
      QStandardPaths::writableLocation(QStandardPaths::CacheLocation) + "/dark-icons/";
  QDir().mkpath(folder);
  static const QRegularExpression url(":/icons/([a-z-]+)\\.svg");
  for (auto it = url.globalMatch(sheet); it.hasNext();) {
    const QString name = it.next().captured(1) + ".svg";
    QFile file(folder + name);
    if (file.open(QIODevice::WriteOnly)) file.write(svg_of(":/icons/" + name));
  }
  return folder;
}

}  // namespace

void apply_theme(QApplication& application, bool dark) {
  load_resources();
  choose_colors(dark);
  application.setStyle(QStyleFactory::create("Fusion"));

  QFont font = application.font();
  const QStringList families = QFontDatabase::families();
  for (const char* family : {"Inter", "Noto Sans", "Open Sans", "Cantarell"}) {
    if (!families.contains(QLatin1String(family))) continue;
    font.setFamily(QLatin1String(family));
    break;
  }
  font.setPointSizeF(std::max(font.pointSizeF(), 9.5));
  font.setHintingPreference(QFont::PreferNoHinting);
  application.setFont(font);

  QPalette palette;
  palette.setColor(QPalette::Window, theme::window);
  palette.setColor(QPalette::Base, theme::panel);
  palette.setColor(QPalette::AlternateBase, theme::window);
  palette.setColor(QPalette::Button, theme::panel);
  palette.setColor(QPalette::WindowText, theme::text);
  palette.setColor(QPalette::Text, theme::text);
  palette.setColor(QPalette::ButtonText, theme::text);
  palette.setColor(QPalette::PlaceholderText, theme::faint_text);
  palette.setColor(QPalette::Highlight, theme::accent);
  palette.setColor(QPalette::HighlightedText, Qt::white);
  palette.setColor(QPalette::ToolTipBase, QColor(0x1f, 0x29, 0x33));
  palette.setColor(QPalette::ToolTipText, Qt::white);
  palette.setColor(QPalette::Link, theme::accent);
  for (const auto role : {QPalette::WindowText, QPalette::Text, QPalette::ButtonText})
    palette.setColor(QPalette::Disabled, role,
                     dark ? turned(QColor(0xb4, 0xbd, 0xc7)) : QColor(0xb4, 0xbd, 0xc7));
  application.setPalette(palette);

  QFile sheet(":/lamella.qss");
  if (sheet.open(QIODevice::ReadOnly)) {
    QString text = QString::fromUtf8(sheet.readAll());
    if (dark) {
      const QString folder = icons_of_sheet(text);
      text = turned(text, true).replace(":/icons/", folder);
    }
    application.setStyleSheet(text);
  }
  application.setWindowIcon(QIcon(":/icons/lamella.svg"));
}

QIcon icon(const QString& name) { return QIcon(new DrawnIcon(":/icons/" + name + ".svg")); }

QColor body_color(int index, const std::array<double, 3>& rgb) {
  if (rgb[0] >= 0) {
    const auto [low, high] = std::minmax_element(rgb.begin(), rgb.end());
    // The gray CAD programs give by default tells nothing, and bodies side by side must differ.
    const bool default_gray = *high - *low < 0.06 && *low > 0.3 && *high < 0.9;
    // Darker than this, mesh edges could not be told from faces.
    const auto lift = [](double c) { return static_cast<float>(std::max(c, 0.28)); };
    if (!default_gray) return QColor::fromRgbF(lift(rgb[0]), lift(rgb[1]), lift(rgb[2]));
  }
  static const std::array<QColor, 8> palette{QColor(0x7f, 0xa8, 0xd1), QColor(0xe0, 0xa9, 0x6d),
                                             QColor(0x8f, 0xbf, 0x9f), QColor(0xc9, 0x8b, 0xa6),
                                             QColor(0x9d, 0x94, 0xc9), QColor(0xd4, 0xc3, 0x6a),
                                             QColor(0x7d, 0xbd, 0xc0), QColor(0xb5, 0xa4, 0x94)};
  return palette[static_cast<std::size_t>(index) % palette.size()];
}

QColor group_color(int index) {
  static const std::array<QColor, 6> palette{QColor(0xe4, 0x57, 0x2e), QColor(0x2e, 0x86, 0xab),
                                             QColor(0x9a, 0x4c, 0xb0), QColor(0x3c, 0x96, 0x3c),
                                             QColor(0xd6, 0x9a, 0x00), QColor(0xc2, 0x2d, 0x6b)};
  return palette[static_cast<std::size_t>(index) % palette.size()];
}

}  // namespace lamella::ui
