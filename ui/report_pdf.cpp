#include "ui/report_pdf.h"

#include <QAbstractEventDispatcher>
#include <QAbstractTextDocumentLayout>
#include <QFile>
#include <QImage>
#include <QPainter>
#include <QPdfWriter>
#include <QRegularExpression>
#include <QSvgRenderer>
#include <QTextBlock>
#include <QTextCursor>
#include <QTextDocument>
#include <QTextFrame>
#include <QTextTable>
#include <QThread>
#include <cmath>
#include <exception>
#include <memory>

namespace lamella::ui {
namespace {

/// What a text document knows of the page's own style: no grids, no variables, sizes in points.
const char* const kStyle =
    "body{font-family:'Inter','Noto Sans','DejaVu Sans',sans-serif;font-size:8pt;color:#1d2733}"
    "h1{font-size:17pt;margin-bottom:2px}"
    "h2{font-size:10pt;color:#0f6b8f;margin-top:16px;margin-bottom:4px;text-align:left}"
    "h4{font-size:8pt;font-weight:600;margin-top:8px;margin-bottom:3px;text-align:left}"
    "p{margin-top:3px;margin-bottom:3px}"
    "td,th{padding:2px 5px 2px 0;text-align:right;vertical-align:top}"
    "th{color:#5b6875;font-weight:600}"
    "td{white-space:nowrap}"
    ".left{text-align:left;white-space:normal}"
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

/// A document does not find the height that belongs to a width, and leaves room around a picture
/// that has no cell of its own.
QString placed(const QString& url, const QImage& image, int width) {
  const int height = image.isNull() ? 0 : width * image.height() / image.width();
  return QString("<table><tr><td><img src=\"%1\" width=\"%2\" height=\"%3\"></td></tr></table>")
      .arg(url)
      .arg(width)
      .arg(height);
}

/// Puts the report into a document: its plots become pictures, its tables as wide as the page.
void lay_out(QString html, QTextDocument& document) {
  static const QRegularExpression style("<style>.*</style>",
                                        QRegularExpression::DotMatchesEverythingOption),
      plot("<svg .*?</svg>", QRegularExpression::DotMatchesEverythingOption),
      picture("<img [^>]*src=\"data:image/png;base64,([^\"]*)\">"), first("<tr><(td|th)>"),
      caption("<p class=\"caption\">(.*?)</p>"), name("(<td class=\"left\">)([^<]*)");
  html.remove(style);
  html.replace(caption, "<h4>\\1</h4>");  // stays with what it is about
  int plots = 0;
  for (auto found = plot.match(html); found.hasMatch(); found = plot.match(html)) {
    const QString url = QString("plot:%1").arg(plots++);
    const QImage image = drawn(found.captured());
    document.addResource(QTextDocument::ImageResource, QUrl(url), image);
    html.replace(found.capturedStart(), found.capturedLength(), placed(url, image, kPage / 2 - 16));
  }
  int pictures = 0;
  for (auto found = picture.match(html); found.hasMatch(); found = picture.match(html)) {
    const QString url = QString("picture:%1").arg(pictures++);
    const QImage image =
        QImage::fromData(QByteArray::fromBase64(found.captured(1).toLatin1()), "PNG");
    document.addResource(QTextDocument::ImageResource, QUrl(url), image);
    html.replace(found.capturedStart(), found.capturedLength(), placed(url, image, kPage));
  }
  // Pages end between tables, not between their rows.
  html.replace("</td></tr><tr><td><h4>", "</td></tr></table><table class=\"plots\"><tr><td><h4>");
  html.replace("</span><span class=\"badge", "</span> \u00b7 <span class=\"badge");
  html.replace(first, "<tr><\\1 class=\"left\">");
  // Lines end between words. Names have but one: theirs may end behind an underscore.
  for (qsizetype from = 0;;) {
    const auto found = name.match(html, from);
    if (!found.hasMatch()) break;
    QString text = found.captured(2);
    text.replace("_", QString("_") + QChar(0x200b));
    html.replace(found.capturedStart(2), found.capturedLength(2), text);
    from = found.capturedStart(2) + text.size();
  }
  html.replace("<table class=\"tiles\"",
               "<table class=\"tiles\" border=\"1\" style=\"border-color:#dfe4e9\"");
  html.replace("<table", "<table width=\"100%\" cellspacing=\"0\" cellpadding=\"2\"");
  QTextOption option;
  option.setWrapMode(QTextOption::WordWrap);
  document.setDefaultTextOption(option);
  document.setDefaultStyleSheet(kStyle);
  document.setHtml(html);
}

/// Heads that would stand alone at the end of a page go to the next one.
void keep_heads(QTextDocument& document) {
  const double height = document.pageSize().height();
  const auto page_of = [&](const QTextBlock& block) {
    const QRectF at = document.documentLayout()->blockBoundingRect(block);
    const double line = block.layout()->lineCount() > 0 ? block.layout()->lineAt(0).height() : 0;
    return static_cast<int>(std::floor((at.top() + line) / height));
  };
  for (QTextBlock head = document.begin(); head.isValid(); head = head.next()) {
    if (head.blockFormat().headingLevel() == 0) continue;
    const QTextBlock about = head.next();
    if (!about.isValid() || page_of(head) == page_of(about)) continue;
    QTextCursor cursor(head);
    QTextTable* table = cursor.currentTable();
    if (!table) {
      QTextBlockFormat format;
      format.setPageBreakPolicy(QTextFormat::PageBreak_AlwaysBefore);
      cursor.mergeBlockFormat(format);
      continue;
    }
    // Pages end between the blocks of the text only: the table goes along, with the head over it.
    QTextBlock over = table->firstCursorPosition().block().previous();
    if (over.isValid() && over.blockFormat().headingLevel() > 0) {
      QTextBlockFormat format;
      format.setPageBreakPolicy(QTextFormat::PageBreak_AlwaysBefore);
      QTextCursor(over).mergeBlockFormat(format);
    } else {
      QTextTableFormat format = table->format();
      format.setPageBreakPolicy(QTextFormat::PageBreak_AlwaysBefore);
      table->setFormat(format);
    }
  }
}

/// A4 with 2 cm around the text, pages numbered.
void print(QTextDocument& document, QPdfWriter& writer) {
  writer.setPageSize(QPageSize(QPageSize::A4));
  writer.setPageMargins(QMarginsF());
  writer.setResolution(300);
  QPainter painter(&writer);
  QAbstractTextDocumentLayout* layout = document.documentLayout();
  layout->setPaintDevice(&writer);
  QTextFrameFormat frame = document.rootFrame()->frameFormat();
  constexpr double margin = 96 / 2.54 * 2;
  frame.setMargin(margin);
  document.rootFrame()->setFrameFormat(frame);
  const QSizeF page(writer.width(), writer.height());
  document.setPageSize(page);
  keep_heads(document);
  document.markContentsDirty(0, document.characterCount());
  const double around = margin * writer.resolution() / 96;
  for (int k = 0; k < document.pageCount(); ++k) {
    if (k > 0) writer.newPage();
    const QRectF seen(QPointF(0, k * page.height()), page);
    painter.save();
    painter.translate(-seen.topLeft());
    QAbstractTextDocumentLayout::PaintContext context;
    context.clip = seen;
    context.palette.setColor(QPalette::Text, Qt::black);
    painter.setClipRect(seen);
    layout->draw(&painter, context);
    painter.restore();
    painter.setFont(document.defaultFont());
    painter.drawText(QRectF(around, page.height() - around, page.width() - 2 * around, around / 2),
                     Qt::AlignRight | Qt::AlignVCenter, QString::number(k + 1));
  }
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
  print(document, writer);
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
