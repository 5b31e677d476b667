#include <gtest/gtest.h>
#include <sys/wait.h>

#include <QProcess>
#include <QRegularExpression>
#include <QSignalSpy>
#include <QSpinBox>
#include <QTest>
#include <cmath>
#include <cstdlib>
#include <ctime>

#include "app/window_services.h"
#include "core/base/atomic_file.h"
#include "core/cad/sample_parts.h"
#include "core/io/msh.h"
#include "core/io_vtk/vtu.h"
#include "core/mesh/validate.h"
#include "tests/ui/window_fixture.h"
#include "ui/actions/actions.h"
#include "ui/commands/study_edits.h"
#include "ui/main_window.h"
#include "ui/session/session.h"
#include "ui/views/model_view.h"

namespace lamella::ui {
namespace {

/// What all threads have had of the processor, which other programs do not lengthen.
double processor_seconds() {
  timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

/// The window with the readers, meshers, loop and writers of the program itself.
class RealRunTest : public testing::Test {
 protected:
  RealRunTest() : window_(window_services(folder_.path())) {
    window_.resize(1200, 800);
    window_.show();
    EXPECT_TRUE(QTest::qWaitForWindowExposed(&window_, patience));
  }

  Session& session() { return window_.session(); }
  QAction* action(Act act) { return window_.actions()[act]; }

  bool wait_idle(int milliseconds = patience) {
    return QTest::qWaitFor([this] { return session().activity() == Activity::idle; }, milliseconds);
  }

  void open_sample(const std::string& name) {
    const auto file = folder_ / (name + ".step");
    ASSERT_TRUE(write_sample(name, file));
    window_.open_files({QString::fromStdString(file.string())});
    ASSERT_TRUE(wait_idle());
    ASSERT_FALSE(session().parts().empty());
  }

  test::TemporaryFolder folder_;
  MainWindow window_;
};

TEST_F(RealRunTest, OpensRunsCancelsRunsAgainCutsAndExports) {
  open_sample("plate");
  window_.findChild<QSpinBox*>("layers")->setValue(2);
  window_.findChild<QSpinBox*>("iterations")->setValue(2);
  ASSERT_EQ(session().body(0).layers, 2);
  ASSERT_EQ(session().study().options.iterations, 2);

  action(Act::run)->trigger();
  ASSERT_TRUE(QTest::qWaitFor([this] { return !session().iterations().empty(); }, patience));
  ASSERT_EQ(session().activity(), Activity::running);
  EXPECT_FALSE(action(Act::run)->isEnabled());
  const double used = processor_seconds();
  action(Act::cancel)->trigger();
  EXPECT_FALSE(action(Act::cancel)->isEnabled());
  ASSERT_TRUE(wait_idle());
  EXPECT_LT(processor_seconds() - used, 0.5);
  ASSERT_TRUE(session().outcome().has_value());
  EXPECT_TRUE(session().outcome()->cancelled);
  ASSERT_NE(session().shown_state(), nullptr);
  EXPECT_TRUE(validate<3>(session().shown_state()->mesh));
  EXPECT_TRUE(action(Act::export_mesh)->isEnabled());

  action(Act::run)->trigger();
  ASSERT_EQ(session().activity(), Activity::running);
  ASSERT_TRUE(wait_idle());
  ASSERT_TRUE(session().outcome().has_value());
  EXPECT_FALSE(session().outcome()->cancelled);
  EXPECT_GT(session().iterations().size(), 1u);
  const BodyOutcome& body = session().outcome()->bodies.at(0);
  EXPECT_EQ(body.layers_asked, 2);
  EXPECT_GE(body.layers.mean, 1.9);
  EXPECT_NEAR(body.mesh_volume, body.cad_volume, 0.005 * body.cad_volume);
  EXPECT_LE(body.boundary_distance.largest(), body.chord_tolerance);
  const auto state = session().shown_state();
  ASSERT_EQ(state, session().outcome()->state);
  const IterationRecord& record =
      session().iterations()[static_cast<std::size_t>(session().shown())].record;
  EXPECT_EQ(record.nodes, state->mesh.node_count());

  const std::size_t whole = window_.view().scene()->shown_elements();
  EXPECT_EQ(whole, state->mesh.element_count());
  action(Act::section)->setChecked(true);
  QTest::qWait(50);
  EXPECT_LT(window_.view().scene()->shown_elements(), whole);
  EXPECT_GT(window_.view().scene()->shown_elements(), 0u);

  QSignalSpy exported(&session(), &Session::exported);
  for (const char* name : {"plate.msh", "plate.vtu"}) {
    session().export_mesh(folder_ / name);
    ASSERT_TRUE(wait_idle());
    EXPECT_TRUE(std::filesystem::is_regular_file(folder_ / name));
  }
  EXPECT_EQ(exported.count(), 2);
  const auto msh = read_msh(folder_ / "plate.msh");
  ASSERT_TRUE(msh) << msh.error().message;
  const auto vtu = read_vtu(folder_ / "plate.vtu");
  ASSERT_TRUE(vtu) << vtu.error().message;
  for (const SimplexMesh<3>* back : {&msh->mesh, &vtu->mesh}) {
    EXPECT_EQ(back->node_count(), state->mesh.node_count());
    EXPECT_EQ(back->element_count(), state->mesh.element_count());
    EXPECT_EQ(back->bodies, state->mesh.bodies);
    EXPECT_TRUE(validate<3>(*back));
  }
}

TEST_F(RealRunTest, BatchMakesTheSameMeshBitForBit) {
  open_sample("plate");
  window_.findChild<QSpinBox*>("layers")->setValue(2);
  window_.findChild<QSpinBox*>("iterations")->setValue(1);
  add_group(session(), GroupKind::gate, session().body(0).name, {1});
  add_sizing(session(), session().body(0).name, "gate", SphereShape{{5, 5, 1}, 2});
  session().save(folder_ / "w.lamella");
  ASSERT_TRUE(wait_idle());
  action(Act::run)->trigger();
  ASSERT_TRUE(wait_idle());
  ASSERT_TRUE(session().outcome());
  session().export_mesh(folder_ / "window.msh");
  ASSERT_TRUE(wait_idle());
  const std::string line = "cd '" + folder_.path().string() +
                           "' && " LAMELLA_BIN_DIR
                           "/lamella-cli run w.lamella -o batch.msh --threads 1 > told 2>&1";
  const int status = std::system(line.c_str());
  ASSERT_TRUE(WIFEXITED(status) && (WEXITSTATUS(status) == 0 || WEXITSTATUS(status) == 4))
      << read_file(folder_ / "told").value();
  EXPECT_TRUE(read_file(folder_ / "batch.msh").value() ==
              read_file(folder_ / "window.msh").value());
}

/// What the window's program prints without a display.
QString printed(const QString& option) {
  QProcess program;
  QProcessEnvironment environment = QProcessEnvironment::systemEnvironment();
  for (const char* name : {"DISPLAY", "WAYLAND_DISPLAY", "QT_QPA_PLATFORM"})
    environment.remove(name);
  program.setProcessEnvironment(environment);
  program.start(LAMELLA_BIN_DIR "/lamella", {option});
  EXPECT_TRUE(program.waitForFinished(patience));
  EXPECT_EQ(program.exitCode(), 0) << program.readAllStandardError().toStdString();
  return QString::fromUtf8(program.readAllStandardOutput());
}

TEST(Program, ItsManualPageSaysWhatItsHelpSays) {
  const QString help = printed("--help");
  const QString page = printed("--manual").replace("\\-", "-");
  EXPECT_TRUE(page.startsWith(".TH LAMELLA 1"));
  int options = 0;
  static const QRegularExpression option("--[a-z-]+");
  for (auto it = option.globalMatch(help); it.hasNext();) {
    const QString name = it.next().captured();
    if (name == "--help-all") continue;  // of Qt, about Qt
    ++options;
    EXPECT_TRUE(page.contains(name)) << name.toStdString();
  }
  EXPECT_GE(options, 3);
  EXPECT_FALSE(page.contains("--screenshot")) << "it is for our own pictures";
}

}  // namespace
}  // namespace lamella::ui
