#include <QComboBox>
#include <QDialogButtonBox>
#include <QLineEdit>
#include <QPushButton>
#include <QSettings>
#include <QSlider>
#include <QTextBrowser>

#include "tests/ui/window_fixture.h"
#include "ui/panels/banner.h"
#include "ui/panels/convergence_panel.h"
#include "ui/panels/export_dialog.h"
#include "ui/panels/report_panel.h"
#include "ui/report_pdf.h"

namespace lamella::ui {
namespace {

/// Files that leave the window, and what it shows of one that comes back.
class WindowFiles : public WindowFixture {
 protected:
  explicit WindowFiles(Services (*change)(Services) = [](Services made) { return made; })
      : WindowFixture(change) {
    QSettings().remove("export");
    QSettings().remove("report");
  }
  std::string bytes(const char* name) {
    const Result<std::string> text = read_file(folder_ / name);
    return text ? *text : "";
  }
  QString report_text() { return window_.findChild<ReportPanel*>()->toPlainText(); }
};

TEST_F(WindowFiles, ExportOffersEveryFormatAndTellsWhatItHolds) {
  const MeshFormats& formats = session().services().formats;
  ExportDialog dialog(formats, "/some/folder", "part", &window_);
  auto* format = dialog.findChild<QComboBox*>("export_format");
  auto* unit = dialog.findChild<QComboBox*>("export_unit");
  auto* file = dialog.findChild<QLineEdit*>("export_file");
  ASSERT_EQ(format->count(), static_cast<int>(formats.all().size()));
  EXPECT_EQ(dialog.file(), "/some/folder/part.msh");
  format->setCurrentIndex(format->findData("abaqus"));
  EXPECT_EQ(dialog.file(), "/some/folder/part.inp") << "the ending follows the format";
  if (const QString folder = qEnvironmentVariable("LAMELLA_PICTURES"); !folder.isEmpty()) {
    dialog.show();
    QTest::qWait(150);
    dialog.grab().save(folder + "/guide-export.png");
  }
  EXPECT_TRUE(unit->isEnabled());
  unit->setCurrentIndex(1);
  EXPECT_EQ(dialog.options().unit, LengthUnit::m);
  format->setCurrentIndex(format->findData("openfoam"));
  EXPECT_FALSE(unit->isEnabled());
  EXPECT_EQ(dialog.options().unit, LengthUnit::m) << "it knows no other";
  file->setText("/some/folder/other.unv");
  QTest::keyClick(file, Qt::Key_Return);
  EXPECT_EQ(dialog.options().format, "unv") << "the format follows an ending that was typed";
  EXPECT_EQ(dialog.options().unit, LengthUnit::mm);
}

TEST_F(WindowFiles, ExportRemembersFormatAndItsUnit) {
  const MeshFormats& formats = session().services().formats;
  {
    ExportDialog dialog(formats, QString::fromStdString(folder_.path().string()), "part");
    auto* format = dialog.findChild<QComboBox*>("export_format");
    format->setCurrentIndex(format->findData("nastran"));
    dialog.findChild<QComboBox*>("export_unit")->setCurrentIndex(1);
    dialog.accept();
    EXPECT_EQ(dialog.result(), QDialog::Accepted);
  }
  ExportDialog again(formats, {}, "part");
  EXPECT_EQ(again.options().format, "nastran");
  EXPECT_EQ(again.options().unit, LengthUnit::m);
  EXPECT_EQ(again.file(), "part.bdf");
  auto* format = again.findChild<QComboBox*>("export_format");
  format->setCurrentIndex(format->findData("msh"));
  EXPECT_EQ(again.options().unit, LengthUnit::mm) << "each format has its own";
}

TEST_F(WindowFiles, ReportNamesInputsExportsAndTheCommand) {
  open_part("plate");
  EXPECT_FALSE(action(Act::save_report)->isEnabled());
  run();
  ASSERT_TRUE(action(Act::save_report)->isEnabled());
  session().export_mesh(folder_ / "plate.inp", {"abaqus", LengthUnit::m});
  ASSERT_TRUE(wait_idle());
  EXPECT_EQ(fake_.export_options.format, "abaqus");
  EXPECT_EQ(fake_.export_options.unit, LengthUnit::m);
  session().save_report(folder_ / "r.html");
  ASSERT_TRUE(wait_idle());
  const std::string html = bytes("r.html");
  for (const std::string text : {"plate.step", "SHA-256", "plate.inp", "lamella-cli mesh",
                                 "Layers measured back", "Section ", "What this mesh is fit for"})
    EXPECT_NE(html.find(text), std::string::npos) << text;
  EXPECT_TRUE(window_.banner().message().contains("Report written"));
}

QtMessageHandler handler_before = nullptr;
QStringList complaints_of_timers;

TEST_F(WindowFiles, ReportBecomesAPdfOfSomePages) {
  open_part("plate");
  run();
  complaints_of_timers.clear();
  handler_before = qInstallMessageHandler(
      [](QtMsgType type, const QMessageLogContext& context, const QString& text) {
        if (text.contains("Timer")) complaints_of_timers << text;
        handler_before(type, context, text);
      });
  session().save_report(folder_ / "r.pdf");
  const bool done = wait_idle();
  qInstallMessageHandler(handler_before);
  ASSERT_TRUE(done);
  EXPECT_EQ(complaints_of_timers, QStringList()) << "the worker is no thread of Qt";
  const std::string pdf = bytes("r.pdf");
  EXPECT_TRUE(pdf.starts_with("%PDF-"));
  EXPECT_GT(pdf.size(), 20000u);
  int pages = 0;
  for (auto at = pdf.find("/Type /Page\n"); at != pdf.npos; at = pdf.find("/Type /Page\n", at + 1))
    ++pages;
  EXPECT_GE(pages, 2);
  EXPECT_LE(pages, 12);
  const auto file = [&](const char* name) {
    return QString::fromStdString((folder_ / name).string());
  };
  EXPECT_EQ(write_report_pdf("no report", file("x.pdf")).error().code, Code::bad_input);
  EXPECT_EQ(write_report_pdf("<main>Lamella</main>", file("no/x.pdf")).error().code, Code::io);
}

TEST_F(WindowFiles, AnOpenedProjectShowsItsReportWithoutARun) {
  open_part("plate");
  run();
  const QString before = report_text();
  session().save(folder_ / "p.lamella");
  ASSERT_TRUE(wait_idle());
  open_part("t_junction");
  EXPECT_FALSE(session().outcome());
  window_.open_files({QString::fromStdString((folder_ / "p.lamella").string())});
  ASSERT_TRUE(wait_idle());
  ASSERT_TRUE(session().outcome());
  EXPECT_EQ(report_text(), before);
  EXPECT_EQ(session().iterations().size(), 1u);
  // The figures of all iterations are there, but for their meshes.
  const QString csv = window_.findChild<ConvergencePanel*>()->csv();
  EXPECT_EQ(csv.count('\n'), 1 + static_cast<int>(session().outcome()->records.size()));
  ASSERT_TRUE(action(Act::save_report)->isEnabled());
  session().save_report(folder_ / "again.html");
  ASSERT_TRUE(wait_idle());
  EXPECT_NE(bytes("again.html").find("plate.step"), std::string::npos);
}

/// Files keep the mesh that was shown last.
class KeptMesh : public WindowFiles {
 protected:
  static inline std::shared_ptr<const MeshState> kept;
  KeptMesh()
      : WindowFiles([](Services made) {
          made.read_mesh = [](const std::filesystem::path&) -> Result<MeshState> { return *kept; };
          return made;
        }) {}
};

TEST_F(KeptMesh, TheSliderOfAnOpenedProjectStandsAtTheMeshThatIsShown) {
  open_part("plate");
  run();
  kept = session().shown_state();
  auto* slider = find<QSlider>("iteration_slider");
  const int last = static_cast<int>(session().outcome()->records.size()) - 1;
  ASSERT_GT(last, 0);
  ASSERT_EQ(slider->value(), last);
  session().save(folder_ / "p.lamella");
  ASSERT_TRUE(wait_idle());
  open_part("t_junction");
  EXPECT_EQ(slider->value(), 0);
  window_.open_files({QString::fromStdString((folder_ / "p.lamella").string())});
  ASSERT_TRUE(wait_idle());
  ASSERT_EQ(session().iterations().size(), 1u);
  EXPECT_EQ(slider->maximum(), last);
  EXPECT_EQ(slider->value(), last);
  EXPECT_FALSE(slider->isEnabled()) << "there is no other mesh";
}

}  // namespace
}  // namespace lamella::ui
