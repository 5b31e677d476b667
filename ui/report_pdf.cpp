#include "ui/report_pdf.h"

#include <QAbstractEventDispatcher>
#include <QFile>
#include <QImage>
#include <QPainter>
#include <QPdfWriter>
#include <QRegularExpression>
#include <QSvgRenderer>
#include <QTextDocument>
#include <QThread>
#include <exception>
#include <memory>

namespace lamella::ui {
namespace {

/// What a text document knows of the page's own style: no grids, no variables, sizes in points.
const char* const kStyle =
    "body{font-family:'Inter','Noto Sans','DejaVu Sans',sans-serif;font-size:8pt;color:#1d2733}"
    "h1{font-size:17pt;margin-bottom:2px}"
    "h2{font-size:10pt;color:#0f6b8f;margin-top:16px;margin-bottom:4px}"
    "p{margin-top:3px;margin-bottom:3px}"
    "td,th{padding:2px 5px 2px 0;text-align:right;vertical-align:top}"
    "th{color:#5b6875;font-weight:600}"
    ".left{text-align:left}"
    ".caption{font-weight:600;margin-top:8px}"
    ".legend span{color:#5b6875}"
    ".good{color:#2c7a4b}.warn{color:#b45f06}.bad{color:#b3261e}"
    ".hash,.soft{color:#5b6875}"
    "code,pre{font-family:'JetBrains Mono','DejaVu Sans Mono',monospace;font-size:7pt}"
    "pre{background-color:#f4f6f8}";

const char* const kPlotStyle =
    "<style>text{font:11px sans-serif;fill:#5b6875}.grid{stroke:#e6eaee}.axis{stroke:#1d2733}"
    ".bar{fill:#0f6b8f}.mark{stroke:#b3261e;stroke-dasharray:5 4}.note{fill:#b3261e}"
    ".label{fill:#1d2733}</style>";

constexpr int kPage = 640;  // width of the text in the pixels of a document, 96 an inch
constexpr int kFiner = 4;   // of a plot's pixels

QImage drawn(QString svg) {
  svg.insert(svg.indexOf('>') + 1, kPlotStyle);
  svg.insert(4, " xmlns=\"http://www.w3.org/2000/svg\"");
  QSvgRenderer plot(svg.toUtf8());
  QImage image(plot.defaultSize() * kFiner, QImage::Format_RGB32);
  image.fill(Qt::white);
  QPainter painter(&image);
  plot.render(&painter);
  return image;
}

/// Puts the report into a document: its plots become pictures, its tables as wide as the page.
void lay_out(QString html, QTextDocument& document) {
  static const QRegularExpression style("<style>.*</style>",
                                        QRegularExpression::DotMatchesEverythingOption),
      plot("<svg .*?</svg>", QRegularExpression::DotMatchesEverythingOption),
      picture("<img [^>]*src=\"data:image/png;base64,([^\"]*)\">"), first("<tr><(td|th)>");
  html.remove(style);
  int plots = 0;
  for (auto found = plot.match(html); found.hasMatch(); found = plot.match(html)) {
    const QString name = QString("plot:%1").arg(plots++);
    document.addResource(QTextDocument::ImageResource, QUrl(name), drawn(found.captured()));
    html.replace(found.capturedStart(), found.capturedLength(),
                 QString("<img src=\"%1\" width=\"%2\">").arg(name).arg(kPage / 2 - 16));
  }
  // A document does not find the height that belongs to a width, and leaves room around a picture
  // that stands in no cell.
  int pictures = 0;
  for (auto found = picture.match(html); found.hasMatch(); found = picture.match(html)) {
    const QString name = QString("picture:%1").arg(pictures++);
    const QImage image =
        QImage::fromData(QByteArray::fromBase64(found.captured(1).toLatin1()), "PNG");
    document.addResource(QTextDocument::ImageResource, QUrl(name), image);
    const int height = image.isNull() ? 0 : kPage * image.height() / image.width();
    html.replace(
        found.capturedStart(), found.capturedLength(),
        QString("<table><tr><td><img src=\"%1\" width=\"%2\" height=\"%3\"></td></tr></table>")
            .arg(name)
            .arg(kPage)
            .arg(height));
  }
  html.replace("</span><span class=\"badge", "</span> \u00b7 <span class=\"badge");
  html.replace(first, "<tr><\\1 class=\"left\">");
  html.replace("<table class=\"tiles\"",
               "<table class=\"tiles\" border=\"1\" style=\"border-color:#dfe4e9\"");
  html.replace("<table", "<table width=\"100%\" cellspacing=\"0\" cellpadding=\"2\"");
  document.setDefaultStyleSheet(kStyle);
  document.setHtml(html);
}

Result<void> write_in_this_thread(const QString& html, const QString& file) {
  if (!html.contains("<main>") || !html.contains("Lamella"))
    return Error{Code::bad_input, "There is no report of Lamella in it.",
                 "Give the .report.html beside a mesh, or a .lamella project with one."};
  QFile target(file);
  if (!target.open(QIODevice::WriteOnly))
    return Error{Code::io, "\"" + file.toStdString() + "\" cannot be written.",
                 "Is the folder there, and writable?"};
  QTextDocument document;
  document.setDocumentMargin(0);
  lay_out(html, document);
  QPdfWriter writer(&target);
  writer.setCreator("Lamella");
  writer.setTitle(document.metaInformation(QTextDocument::DocumentTitle));
  writer.setPageSize(QPageSize(QPageSize::A4));
  writer.setResolution(300);
  document.print(&writer);
  target.close();
  if (target.error() != QFile::NoError)
    return Error{Code::io, "\"" + file.toStdString() + "\" could not be written in full.",
                 "Is there space left?"};
  return {};
}

}  // namespace

Result<void> write_report_pdf(const QString& html, const QString& file) {
  // A text document starts timers, for which a thread needs Qt's dispatcher; the worker has none.
  if (QAbstractEventDispatcher::instance()) return write_in_this_thread(html, file);
  Result<void> done;
  std::exception_ptr thrown;
  const std::unique_ptr<QThread> thread(QThread::create([&] {
    try {
      done = write_in_this_thread(html, file);
    } catch (...) {
      thrown = std::current_exception();
    }
  }));
  thread->start();
  thread->wait();
  if (thrown) std::rethrow_exception(thrown);
  return done;
}

}  // namespace lamella::ui
