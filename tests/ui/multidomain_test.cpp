#include <QComboBox>
#include <QDoubleSpinBox>
#include <QLabel>
#include <QPushButton>
#include <QTabWidget>
#include <QTextBrowser>
#include <QTreeView>
#include <numbers>

#include "app/window_services.h"
#include "core/io/stl.h"
#include "core/project/project_file.h"
#include "core/study/study_file.h"
#include "core/study/zone_surface.h"
#include "tests/ui/window_fixture.h"
#include "ui/commands/study_edits.h"
#include "ui/models/study_model.h"
#include "ui/panels/banner.h"
#include "ui/panels/convergence_panel.h"
#include "ui/panels/form.h"
#include "ui/panels/report_panel.h"
#include "ui/session/command_line.h"
#include "ui/views/overlay.h"
#include "ui/views/plot.h"

namespace lamella::ui {
namespace {

void write_box(const std::filesystem::path& file, const Vec<3>& low, const Vec<3>& high) {
  const StudyZone box{"box", ZoneBox{low, high}};
  const auto surface = zone_surface(box, {box}, box, 0.1);
  ASSERT_TRUE(surface);
  ASSERT_TRUE(write_stl(*surface, file));
}

/// For a person to judge, where LAMELLA_PICTURES names a folder.
void keep_picture(MainWindow& window, const char* name) {
  const QString to = qEnvironmentVariable("LAMELLA_PICTURES");
  if (to.isEmpty()) return;
  QTest::qWait(200);
  EXPECT_TRUE(window.grab().save(to + "/" + name + ".png"));
}

/// One mesh of the box [0, 10]^3: what is left of x = 4 is all of the first body, what is right of
/// x = 6 all of the second, and each of the elements between is filled by both.
std::shared_ptr<const MeshState> split_state(const std::vector<BodySettings>& bodies) {
  auto state = std::make_shared<MeshState>();
  state->mesh = test::box_mesh(5, 5, 5);
  for (Vec<3>& p : state->mesh.points) p *= 2;
  state->mesh.bodies.clear();
  for (const BodySettings& body : bodies) state->mesh.bodies.push_back(body.name);
  auto filling = std::make_shared<Filling>();
  filling->regions = static_cast<int>(bodies.size());
  for (std::size_t e = 0; e < state->mesh.elements.size(); ++e) {
    Vec<3> middle = Vec<3>::Zero();
    for (const Vec<3>& p : state->mesh.corners(state->mesh.elements[e])) middle += p / 4;
    const bool between = middle[0] > 4 && middle[0] < 6;
    const int body = middle[0] < 4 || (between && middle[1] < 5) ? 0 : 1;
    state->mesh.element_body[e] = body;
    if (between) {
      filling->shares.push_back({0, body == 0 ? 0.7F : 0.3F});
      filling->shares.push_back({1, body == 0 ? 0.3F : 0.7F});
    } else {
      filling->shares.push_back({body, 1});
    }
    filling->first.push_back(static_cast<std::uint32_t>(filling->shares.size()));
  }
  state->filling = filling;
  return state;
}

/// A window with two boxes of 4 x 10 x 10 that leave 2 mm between them.
class MultidomainTest : public WindowFixture {
 protected:
  MultidomainTest() : WindowFixture(split) {
    write_box(folder_ / "left.stl", {0, 0, 0}, {4, 10, 10});
    write_box(folder_ / "right.stl", {6, 0, 0}, {10, 10, 10});
    open({"left.stl", "right.stl"});
  }

  /// The run of every study is one iteration with the state of `split_state`.
  static Services split(Services made) {
    made.run = [](const Study& study, const auto&, const auto&, const Progress&,
                  const IterationSink& sink, const auto&) -> Result<Outcome> {
      Outcome outcome;
      outcome.state = split_state(study.bodies);
      outcome.converged = true;
      IterationRecord record;
      record.nodes = outcome.state->mesh.node_count();
      record.elements = outcome.state->mesh.element_count();
      record.mixed = outcome.state->filling->mixed_count();
      record.interface_error = 0.25;
      outcome.records = {record};
      for (const BodySettings& body : study.bodies) {
        BodyOutcome own;
        own.name = body.name;
        own.interface_size = 0.125;
        outcome.bodies.push_back(own);
      }
      sink(record, outcome.state);
      return outcome;
    };
    return made;
  }

  StudyModel* model() { return qobject_cast<StudyModel*>(find<QTreeView>("study")->model()); }
  /// Whatever there is unsaved goes.
  void open(const std::vector<std::string>& names) {
    bool add = false;
    for (const std::string& name : names) {
      if (name.ends_with(".lamella"))
        session().open_study(folder_ / name);
      else
        session().open({folder_ / name}, add, 1);
      ASSERT_TRUE(wait_idle());
      add = true;
    }
  }
  void choose(const char* combo, const QString& text) {
    auto* box = find<QComboBox>(combo);
    const int index = box->findText(text);
    ASSERT_GE(index, 0) << combo;
    box->setCurrentIndex(index);
  }
  /// The color that a point of the model has in the picture.
  QColor color_at(const Vec<3>& point) {
    const QImage picture = window_.view().picture();
    const QPointF at = window_.view().vtk_view()->project(point) * picture.devicePixelRatio();
    return picture.pixelColor(at.toPoint());
  }
};

double apart(const QColor& a, const QColor& b) {
  return std::hypot(std::hypot(a.red() - b.red(), a.green() - b.green()), a.blue() - b.blue());
}

TEST_F(MultidomainTest, OneMeshOfAllBodiesIsChosenByNameAndUndone) {
  const std::string before = study_to_json(study());
  auto* tree = find<QTreeView>("study");
  EXPECT_TRUE(tree->isRowHidden(int(ItemKind::domain), {}));
  EXPECT_TRUE(find<QWidget>("error_plot")->isHidden());
  session().select(0);
  EXPECT_TRUE(find<QWidget>("interface_size")->isHidden());

  choose("meshes", "one of all bodies");
  EXPECT_EQ(session().undo_stack()->undoText(), "One mesh of all bodies");
  ASSERT_TRUE(study().domain);
  EXPECT_EQ(study().domain->shape, decltype(StudyDomain::shape){DomainMargin{}});
  // What is around the bodies has settings: a row of its own, out of sight.
  ASSERT_EQ(study().bodies.size(), 3u);
  EXPECT_EQ(study().bodies[2].name, "background");
  EXPECT_FALSE(study().bodies[2].visible);
  EXPECT_EQ(model()->rowCount(model()->section(ItemKind::body)), 3);
  EXPECT_FALSE(tree->isRowHidden(int(ItemKind::domain), {}));
  EXPECT_EQ(model()->index_of({ItemKind::domain, 0}).data().toString(), "Box, margin 10 %");
  EXPECT_FALSE(find<QWidget>("error_plot")->isHidden());
  EXPECT_FALSE(find<QWidget>("interface_size")->isHidden());
  EXPECT_FALSE(action(Act::forecast)->isEnabled()) << "nothing tells its nodes";
  session().select(2);
  EXPECT_FALSE(action(Act::remove)->isEnabled());
  session().select_item({ItemKind::domain, 0});
  // The bodies are 10 x 10 x 10, with a diagonal of 17.32.
  EXPECT_TRUE(find<QLabel>("domain_details")->text().contains("13.46 × 13.46 × 13.46 mm"));

  find<QDoubleSpinBox>("domain_share")->setValue(25);
  EXPECT_EQ(std::get<DomainMargin>(study().domain->shape).share, 0.25);
  choose("interfaces", "fuzzy");
  EXPECT_EQ(study().options.interfaces, Interfaces::fuzzy);
  choose("capture", "by gradient");
  EXPECT_EQ(study().options.capture, Capture::gradient);
  session().select({0, 1}, 1);
  find<LengthBox>("interface_size")->setValue(0.05);
  EXPECT_EQ(study().bodies[0].interface_size, 0.05);
  EXPECT_EQ(study().bodies[1].interface_size, 0.05);
  EXPECT_EQ(session().undo_stack()->index(), 5);
  // A body that is chosen when what it belongs to is undone is chosen no more.
  session().select(2);
  for (int k = 0; k < 5; ++k) action(Act::undo)->trigger();
  EXPECT_EQ(study_to_json(study()), before);
  EXPECT_EQ(session().selected(), -1);
  EXPECT_EQ(model()->rowCount(model()->section(ItemKind::body)), 2);
  EXPECT_TRUE(tree->isRowHidden(int(ItemKind::domain), {}));
}

TEST_F(MultidomainTest, EveryDomainHasItsNumbers) {
  choose("meshes", "one of all bodies");
  choose("domain", "box by corners");
  const ZoneBox box = std::get<ZoneBox>(study().domain->shape);
  for (int k = 0; k < 3; ++k) {
    EXPECT_LE(box.low[k], -1.732) << "no smaller than the margin's";
    EXPECT_GE(box.high[k], 11.732);
    EXPECT_NEAR(box.high[k] - box.low[k], 13.464, 0.1);
  }
  // Corners may be given in any order; a box without volume is none.
  auto* low = find<PointBox>("domain_low");
  low->set_point({20, -3, -3});
  Q_EMIT low->edited();
  const ZoneBox turned = std::get<ZoneBox>(study().domain->shape);
  EXPECT_EQ(turned.low, Vec<3>(box.high[0], -3, -3));
  EXPECT_EQ(turned.high, Vec<3>(20, box.high[1], box.high[2]));
  low->set_point({20, -3, -3});
  Q_EMIT low->edited();
  EXPECT_EQ(std::get<ZoneBox>(study().domain->shape), turned);

  choose("domain", "one of the bodies");
  ASSERT_TRUE(std::holds_alternative<DomainBody>(study().domain->shape));
  EXPECT_EQ(study().bodies.size(), 2u) << "nothing is around it";
  choose("domain_body", "right");
  EXPECT_EQ(std::get<DomainBody>(study().domain->shape).name, "right");
  choose("domain", "cylinder");
  const auto cylinder = std::get<ZoneCylinder>(study().domain->shape);
  EXPECT_GT(cylinder.radius, 5 * std::numbers::sqrt2) << "it holds the bodies";
  find<LengthBox>("domain_radius")->setValue(12);
  EXPECT_EQ(std::get<ZoneCylinder>(study().domain->shape).radius, 12);
  choose("domain", "the bodies alone");
  EXPECT_TRUE(std::holds_alternative<DomainBodies>(study().domain->shape));
  // A part that is the domain takes it along.
  choose("domain", "one of the bodies");
  choose("domain_body", "right");
  session().remove_item({ItemKind::body, 1});
  EXPECT_TRUE(std::holds_alternative<DomainBodies>(study().domain->shape));
  session().remove_item({ItemKind::domain, 0});
  EXPECT_FALSE(study().domain);
}

TEST_F(MultidomainTest, WhatIsAskedSurvivesSavingAndIsSaidAsACommand) {
  choose("meshes", "one of all bodies");
  find<QDoubleSpinBox>("domain_share")->setValue(20);
  choose("interfaces", "fuzzy");
  choose("capture", "by gradient");
  session().select({0, 1}, 1);
  find<LengthBox>("interface_size")->setValue(0.05);
  const Result<std::string> line = command_line(study());
  ASSERT_TRUE(line) << line.error().message;
  EXPECT_NE(line->find(" --interface-size 0.05 --domain margin=0.2 --interfaces fuzzy "
                       "--capture gradient "),
            std::string::npos)
      << *line;
  const std::string asked = study_to_json(study());
  session().save(folder_ / "two.lamella");
  ASSERT_TRUE(wait_idle());
  open({"left.stl"});
  EXPECT_FALSE(study().domain);
  open({"two.lamella"});
  EXPECT_EQ(study_to_json(study()), asked);
  EXPECT_FALSE(session().modified());
  EXPECT_EQ(find<QComboBox>("interfaces")->currentText(), "fuzzy");
  session().select(0);
  EXPECT_EQ(find<LengthBox>("interface_size")->length(), 0.05);
  // Settings of what is around the bodies are no option, and are not passed over.
  BodySettings around = session().body(2);
  around.layers = 3;
  session().edit_body(2, "layers", around);
  EXPECT_FALSE(command_line(study()));
}

TEST_F(MultidomainTest, FillingIsColoredOnSurfaceAndCuts) {
  choose("meshes", "one of all bodies");
  session().select(0);
  run();
  window_.actions()[Act::edges]->setChecked(false);
  auto* bodies = find<QComboBox>("filling_body");
  EXPECT_TRUE(bodies->isHidden());
  window_.view().set_color_by(ColorBy::filling);
  EXPECT_FALSE(bodies->isHidden());
  EXPECT_EQ(bodies->currentText(), "left");
  window_.view().look(-Vec<3>::UnitZ(), Vec<3>::UnitY());
  const auto& bands = filling_map().stops;
  // Of the first body: all, more than half, less than half, nothing.
  const auto expect = [&](double z, const std::array<int, 4>& band) {
    QTest::qWait(50);
    const std::array<Vec<3>, 4> places{Vec<3>{2, 3, z}, Vec<3>{5, 3, z}, Vec<3>{5, 7, z},
                                       Vec<3>{8, 7, z}};
    for (std::size_t k = 0; k < 4; ++k) {
      const QColor seen = color_at(places[k]);
      for (std::size_t other = 0; other < 4; ++other) {
        if (static_cast<int>(other) == band[k]) continue;
        EXPECT_LT(apart(seen, bands[static_cast<std::size_t>(band[k])]), apart(seen, bands[other]))
            << "place " << k << " at z = " << z;
      }
    }
  };
  expect(10, {3, 2, 1, 0});
  for (const bool whole : {false, true}) {
    action(Act::crinkle)->setChecked(whole);
    window_.view().set_section(Section{{5, 5, 6}, Vec<3>::UnitZ()});
    expect(6, {3, 2, 1, 0});
  }
  bodies->setCurrentIndex(1);
  EXPECT_EQ(session().selected(), 1) << "one selection everywhere";
  expect(6, {0, 1, 2, 3});
  // By body: each in its color, paler where it is cut.
  window_.view().set_color_by(ColorBy::body);
  QTest::qWait(50);
  const QColor left = color_at({2, 3, 6}), right = color_at({8, 7, 6});
  EXPECT_GT(apart(left, right), 20);
  // Nobody fills anything in a mesh without fuzzy interfaces.
  session().select(2);
  window_.view().set_color_by(ColorBy::filling);
  QTest::qWait(50);
  EXPECT_EQ(window_.view().scene()->legend().title, "Filled by background");
}

TEST_F(MultidomainTest, MixedElementsAndTheirErrorAreTold) {
  choose("meshes", "one of all bodies");
  run();
  EXPECT_TRUE(find<QLabel>("counts")->text().contains("150 mixed")) << "a slab of 5 x 5 cells";
  const auto* report = window_.findChild<ReportPanel*>();
  EXPECT_TRUE(report->toPlainText().contains("150 of 750 elements are mixed"));
  const QStringList lines =
      window_.findChild<ConvergencePanel*>()->csv().split('\n', Qt::SkipEmptyParts);
  const QStringList titles = lines[0].split(','), last = lines.back().split(',');
  ASSERT_EQ(titles.size(), last.size());
  EXPECT_EQ(last[titles.indexOf("mixed")].toInt(), 150);
  EXPECT_EQ(last[titles.indexOf("interface_error")].toDouble(), 0.25);
  // What the run took for automatic is told where another one can be asked for.
  session().select(0);
  EXPECT_EQ(find<LengthBox>("interface_size")->text(), "auto: 0.125 mm");
}

TEST_F(MultidomainTest, OverlapsAreMeasuredAndShown) {
  write_box(folder_ / "post.stl", {3, 4, 2}, {5, 6, 12});
  open({"left.stl", "right.stl", "post.stl"});
  auto* text = find<QTextBrowser>("overlaps");
  action(Act::overlaps)->trigger();
  ASSERT_EQ(session().activity(), Activity::checking);
  ASSERT_TRUE(wait_idle());
  ASSERT_TRUE(session().overlaps());
  const auto& found = session().overlaps()->found;
  ASSERT_EQ(found.report.overlaps.size(), 1u);
  // The post reaches 1 x 2 x 8 mm into the left box.
  EXPECT_NEAR(found.report.overlaps[0].volume, 16, 0.2);
  EXPECT_TRUE(text->toPlainText().contains("left and post"));
  QSignalSpy shown(&session(), &Session::place_shown);
  Q_EMIT text->anchorClicked(QUrl("place:overlap:0"));
  ASSERT_EQ(shown.count(), 1);
  const auto place = shown[0][0].value<Vec<3>>();
  EXPECT_TRUE((place.array() > Vec<3>(3, 4, 2).array()).all());
  EXPECT_TRUE((place.array() < Vec<3>(4, 6, 10).array()).all());
  EXPECT_EQ(session().selection(), (std::vector<int>{0, 2})) << "the two are outlined";
  Q_EMIT text->anchorClicked(QUrl("cut:overlap:0"));
  ASSERT_TRUE(window_.view().section());
  EXPECT_EQ(window_.view().section()->origin, place);
  keep_picture(window_, "overlaps");
  // What was found is of these bodies.
  session().remove_item({ItemKind::body, 2});
  EXPECT_FALSE(session().overlaps());
  EXPECT_FALSE(text->toPlainText().contains("post"));
  // So is its mark: nothing is left for Escape to take away.
  auto* drawn = window_.findChild<Overlay*>();
  const QImage after_removal = drawn->grab().toImage();
  QTest::keyClick(&window_.view(), Qt::Key_Escape);
  EXPECT_TRUE(after_removal == drawn->grab().toImage());

  find<LengthBox>("gap_width")->setValue(3);
  find<QPushButton>("look_for_overlaps")->click();
  ASSERT_TRUE(wait_idle());
  EXPECT_TRUE(text->toPlainText().contains("No bodies overlap."));
  ASSERT_EQ(session().overlaps()->found.report.gaps.size(), 1u);
  EXPECT_NEAR(session().overlaps()->found.report.gaps[0].least_width, 2, 0.02);
  EXPECT_TRUE(text->toPlainText().contains("1 gap narrower than 3 mm"));
  keep_picture(window_, "gaps");
  find<LengthBox>("gap_width")->setValue(1);
  find<QPushButton>("look_for_overlaps")->click();
  ASSERT_TRUE(wait_idle());
  EXPECT_TRUE(text->toPlainText().contains("No gaps are narrower than 1 mm."));
}

TEST_F(MultidomainTest, BodiesByFormulaAreListedDrawnAndRemoved) {
  Study balls;
  balls.name = "balls";
  balls.zones = {{"ball", ZoneBall{{0, 0, 0}, 3}}, {"below", ZoneHalfSpace{{0, 0, 1}, 0}}};
  balls.domain = StudyDomain{ZoneBox{{-5, -5, -5}, {5, 5, 5}}};
  ASSERT_TRUE(write_study(balls, folder_ / "balls.lamella"));
  open({"balls.lamella"});
  EXPECT_TRUE(session().parts().empty());
  ASSERT_EQ(study().bodies.size(), 3u);
  EXPECT_TRUE(session().is_zone(1));
  EXPECT_FALSE(session().is_zone(2));
  EXPECT_FALSE(session().modified());
  EXPECT_TRUE(action(Act::run)->isEnabled());
  EXPECT_TRUE(action(Act::save)->isEnabled());
  const auto volume = [&](std::size_t k) { return session().shapes()[k].cad_volume; };
  ASSERT_TRUE(QTest::qWaitFor([&] { return volume(0) > 0; }, patience));
  EXPECT_NEAR(volume(0), 36 * std::numbers::pi, 0.02 * 36 * std::numbers::pi);
  EXPECT_NEAR(volume(1), 500, 1e-6) << "what has no end is cut by the domain";
  EXPECT_NEAR(window_.view().scene()->bounds()[1], 5, 1e-9);

  session().remove_item({ItemKind::body, 0});
  EXPECT_EQ(study().zones.size(), 1u);
  EXPECT_EQ(model()->rowCount(model()->section(ItemKind::body)), 2);
  action(Act::undo)->trigger();
  EXPECT_EQ(study().zones, balls.zones);
  ASSERT_TRUE(QTest::qWaitFor([&] { return volume(0) > 0; }, patience));
  session().save(folder_ / "again.lamella");
  ASSERT_TRUE(wait_idle());
  EXPECT_FALSE(session().modified());
  EXPECT_EQ(open_project(folder_ / "again.lamella").value().study.zones, balls.zones);
  EXPECT_FALSE(command_line(study())) << "no option says a ball";
}

/// The program itself: two balls that overlap, in a box.
TEST(MultidomainRun, TwoBallsAreMeshedSavedAndSeenAgain) {
  const test::TemporaryFolder folder;
  Study balls;
  balls.zones = {{"a", ZoneBall{{-0.6, 0, 0}, 1}}, {"b", ZoneBall{{0.6, 0, 0}, 1}}};
  balls.domain = StudyDomain{ZoneBox{{-3, -2, -2}, {3, 2, 2}}};
  balls.options.interfaces = Interfaces::fuzzy;
  balls.options.iterations = 1;
  for (const char* name : {"a", "b"}) {
    balls.bodies.push_back({name, 2});
    balls.bodies.back().interface_size = 0.2;
  }
  ASSERT_TRUE(write_study(balls, folder / "balls.lamella"));
  MainWindow window(window_services(folder.path()));
  window.resize(1200, 800);
  window.show();
  Session& session = window.session();
  const auto wait_idle = [&] {
    return QTest::qWaitFor([&] { return session.activity() == Activity::idle; }, patience);
  };
  const auto file = QString::fromStdString((folder / "balls.lamella").string());
  window.open_files({file});
  ASSERT_TRUE(wait_idle());
  window.actions()[Act::run]->trigger();
  ASSERT_TRUE(wait_idle());
  ASSERT_TRUE(session.outcome()) << window.banner().message().toStdString();
  const auto state = session.shown_state();
  ASSERT_TRUE(state->filling);
  EXPECT_GT(session.iterations().back().record.mixed, 0u);
  EXPECT_LT(session.iterations().back().record.interface_error,
            session.iterations().front().record.interface_error);
  // With what is around them out of sight the balls are seen.
  std::size_t around = 0;
  for (const std::int32_t body : state->mesh.element_body) around += body == 2;
  EXPECT_EQ(window.view().scene()->shown_elements(), state->mesh.element_count() - around);
  session.select_item({ItemKind::domain, 0});
  keep_picture(window, "domain");
  window.findChild<QTabWidget*>()->setCurrentIndex(2);
  window.actions()[Act::section]->setChecked(true);
  keep_picture(window, "bodies-cut");
  session.save(folder / "balls.lamella");
  ASSERT_TRUE(wait_idle());

  window.open_files({file});
  ASSERT_TRUE(wait_idle());
  ASSERT_TRUE(session.shown_state());
  const auto again = session.shown_state()->filling;
  ASSERT_TRUE(again);
  EXPECT_EQ(again->first, state->filling->first);
  for (std::size_t s = 0; s < again->shares.size(); ++s) {
    EXPECT_EQ(again->shares[s].region, state->filling->shares[s].region);
    EXPECT_EQ(again->shares[s].ratio, state->filling->shares[s].ratio);
  }
}

}  // namespace
}  // namespace lamella::ui
