#include "ui/panels/domain_form.h"

#include <QComboBox>
#include <algorithm>
#include <cmath>

#include "core/geometry/triangles.h"
#include "core/study/domain.h"
#include "ui/commands/study_edits.h"
#include "ui/panels/form.h"
#include "ui/session/session.h"

namespace lamella::ui {
namespace {

/// Kinds of domain, as StudyDomain's variant has them.
enum Kind { bodies, box, cylinder, margin, body };

QComboBox* choice(const char* name, const QString& tip) {
  auto* combo = new QComboBox;
  combo->setObjectName(name);
  combo->setToolTip(tip);
  return combo;
}

/// Four digits are enough to begin with, and leave the bodies inside.
ZoneBox rounded(const ZoneBox& b) {
  const double unit = std::pow(10, std::floor(std::log10((b.high - b.low).norm())) - 3);
  return {(b.low / unit).array().floor() * unit, (b.high / unit).array().ceil() * unit};
}

/// The box in which the study would be meshed.
ZoneBox box_of(const Session& session) {
  Study study = session.study();
  if (!study.domain || std::holds_alternative<DomainBody>(study.domain->shape))
    study.domain = StudyDomain{DomainMargin{}};
  const Result<StudyZone> hull = domain_hull(study, session.parts());
  if (!hull) return {Vec<3>::Zero(), Vec<3>::Constant(10)};
  const Box<3> around = make_zone(*hull, {*hull})->box();
  return rounded({around.lo, around.hi});
}

/// A cylinder along the longest side of the box, around all of it.
ZoneCylinder cylinder_around(const ZoneBox& b) {
  int axis = 0;
  const Vec<3> side = b.high - b.low, middle = 0.5 * (b.low + b.high);
  side.maxCoeff(&axis);
  const Vec<3> half = 0.5 * side[axis] * Vec<3>::Unit(axis);
  const double reach = 0.5 * std::sqrt(std::max(0.0, side.squaredNorm() - side[axis] * side[axis]));
  const double unit = std::pow(10, std::floor(std::log10(reach)) - 2);
  return {middle - half, middle + half, std::ceil(reach / unit) * unit};
}

/// The largest body: what holds the others most likely.
std::string largest_body(const Session& session) {
  const auto& shapes = session.shapes();
  const auto it = std::max_element(shapes.begin(), shapes.end(), [](const Part& a, const Part& b) {
    return diagonal_of(a.surface.points) < diagonal_of(b.surface.points);
  });
  return it == shapes.end() ? std::string() : it->name;
}

}  // namespace

DomainForm::DomainForm(Session& session, QWidget* parent)
    : QWidget(parent), session_(session), rows_(new Form) {
  setLayout(rows_);
  rows_->setContentsMargins(0, 0, 0, 0);
  meshes_ = choice("meshes", tr("One for each body: every body alone, as if the others were not\n"
                                "there. One of all bodies: their meshes fit together."));
  meshes_->addItems({tr("one per body"), tr("one of all bodies")});
  rows_->add(tr("Meshes"), meshes_);
  domain_ = choice("domain", tr("What the mesh of all bodies fills"));
  domain_->addItem(tr("the bodies alone"), bodies);
  domain_->addItem(tr("box with a margin"), margin);
  domain_->addItem(tr("one of the bodies"), body);
  domain_->addItem(tr("box by corners"), box);
  domain_->addItem(tr("cylinder"), cylinder);
  rows_->add(tr("Domain"), domain_);
  share_ = number_box(0.1, 1000, 5, "domain_share",
                      tr("Around the box of all bodies on every side, as a share of its diagonal"));
  share_->setDecimals(1);
  share_->setSuffix(tr(" %"));
  rows_->add(tr("Margin"), share_);
  body_ = choice("domain_body", tr("The body that the others are in"));
  rows_->add(tr("Inside of"), body_);
  low_ = new PointBox("domain_low", tr("Lower corner"));
  rows_->add(tr("From corner"), low_);
  high_ = new PointBox("domain_high", tr("Upper corner"));
  rows_->add(tr("To corner"), high_);
  from_ = new PointBox("domain_from", tr("Middle of one end"));
  rows_->add(tr("From"), from_);
  to_ = new PointBox("domain_to", tr("Middle of the other end"));
  rows_->add(tr("To"), to_);
  radius_ = length_box("domain_radius", tr("Radius of the cylinder"));
  radius_->setMinimum(1e-6);
  rows_->add(tr("Radius"), radius_);
  interfaces_ = choice("interfaces", tr("Exact: borders between bodies lie on faces of the mesh.\n"
                                        "Fuzzy: they run through thin elements, each filled in\n"
                                        "part by several bodies."));
  interfaces_->addItem(tr("exact"), int(Interfaces::exact));
  interfaces_->addItem(tr("fuzzy"), int(Interfaces::fuzzy));
  rows_->add(tr("Interfaces"), interfaces_);
  capture_ = choice("capture", tr("What draws the mesh together at the borders: the distance to\n"
                                  "them, or the gradient of the filling ratio as in the thesis"));
  capture_->addItem(tr("by distance"), int(Capture::distance));
  capture_->addItem(tr("by gradient"), int(Capture::gradient));
  rows_->add(tr("Drawn to them"), capture_);
  connect_fields();
}

void DomainForm::connect_fields() {
  connect(meshes_, &QComboBox::currentIndexChanged, this, [this](int one) {
    if (one == 0)
      edit_domain(session_, tr("One mesh for each body"), {});
    else
      edit_domain(session_, tr("One mesh of all bodies"), StudyDomain{DomainMargin{}});
  });
  connect(domain_, &QComboBox::currentIndexChanged, this,
          [this] { choose_domain(domain_->currentData().toInt()); });
  connect(share_, &QDoubleSpinBox::valueChanged, this, [this](double percent) {
    edit_domain(session_, tr("Margin of the domain"), StudyDomain{DomainMargin{percent / 100}});
  });
  connect(body_, &QComboBox::currentIndexChanged, this, [this] {
    edit_domain(session_, tr("Body that is the domain"),
                StudyDomain{DomainBody{body_->currentText().toStdString()}});
  });
  for (PointBox* point : {low_, high_, from_, to_})
    connect(point, &PointBox::edited, this, &DomainForm::edit_shape);
  connect(radius_, &QDoubleSpinBox::valueChanged, this, &DomainForm::edit_shape);
  const auto edit = [this](const QString& what, auto&& change) {
    Study study = session_.study();
    change(study.options);
    session_.edit(what, std::move(study));
  };
  connect(interfaces_, &QComboBox::currentIndexChanged, this, [this, edit] {
    const auto chosen = Interfaces(interfaces_->currentData().toInt());
    edit(chosen == Interfaces::fuzzy ? tr("Fuzzy interfaces") : tr("Exact interfaces"),
         [chosen](StudyOptions& o) { o.interfaces = chosen; });
  });
  connect(capture_, &QComboBox::currentIndexChanged, this, [this, edit] {
    const auto chosen = Capture(capture_->currentData().toInt());
    edit(tr("Capture of interfaces"), [chosen](StudyOptions& o) { o.capture = chosen; });
  });
}

void DomainForm::choose_domain(int kind) {
  StudyDomain domain;
  switch (Kind(kind)) {
    case bodies:
      break;
    case margin:
      domain.shape = DomainMargin{};
      break;
    case body:
      domain.shape = DomainBody{largest_body(session_)};
      break;
    case box:
      domain.shape = box_of(session_);
      break;
    case cylinder:
      domain.shape = cylinder_around(box_of(session_));
      break;
  }
  edit_domain(session_, tr("Domain"), domain);
}

void DomainForm::edit_shape() {
  const auto& domain = session_.study().domain;
  if (!domain) return;
  if (std::holds_alternative<ZoneBox>(domain->shape)) {
    const Vec<3> a = low_->point(), b = high_->point();
    const ZoneBox made{a.cwiseMin(b), a.cwiseMax(b)};
    if (!((made.high - made.low).minCoeff() > 0)) return refresh();
    edit_domain(session_, tr("Corners of the domain"), StudyDomain{made});
  } else if (std::holds_alternative<ZoneCylinder>(domain->shape)) {
    const ZoneCylinder made{from_->point(), to_->point(), radius_->value()};
    if (made.from == made.to || !(made.radius > 0)) return refresh();
    edit_domain(session_, tr("Cylinder of the domain"), StudyDomain{made});
  }
}

void DomainForm::refresh() {
  const Study& study = session_.study();
  const QSignalBlocker block[] = {QSignalBlocker(meshes_), QSignalBlocker(domain_),
                                  QSignalBlocker(share_),  QSignalBlocker(body_),
                                  QSignalBlocker(radius_), QSignalBlocker(interfaces_),
                                  QSignalBlocker(capture_)};
  const bool one = study.domain.has_value();
  const int kind = one ? static_cast<int>(study.domain->shape.index()) : -1;
  meshes_->setCurrentIndex(one ? 1 : 0);
  domain_->setCurrentIndex(domain_->findData(kind));
  const auto show = [&](QWidget* field, bool on) { rows_->setRowVisible(field, on); };
  for (QWidget* field : std::initializer_list<QWidget*>{domain_, interfaces_, capture_})
    show(field, one);
  show(share_, kind == margin);
  show(body_, kind == body);
  for (QWidget* field : {low_, high_}) show(field, kind == box);
  for (QWidget* field : std::initializer_list<QWidget*>{from_, to_, radius_})
    show(field, kind == cylinder);
  if (!one) return;
  if (const auto* m = std::get_if<DomainMargin>(&study.domain->shape))
    share_->setValue(100 * m->share);
  body_->clear();
  for (std::size_t k = 0; k < session_.parts().size() + study.zones.size(); ++k)
    body_->addItem(QString::fromStdString(study.bodies[k].name));
  if (const auto* b = std::get_if<DomainBody>(&study.domain->shape))
    body_->setCurrentText(QString::fromStdString(b->name));
  if (const auto* b = std::get_if<ZoneBox>(&study.domain->shape)) {
    low_->set_point(b->low);
    high_->set_point(b->high);
  }
  if (const auto* c = std::get_if<ZoneCylinder>(&study.domain->shape)) {
    from_->set_point(c->from);
    to_->set_point(c->to);
    radius_->set_length(c->radius);
  }
  interfaces_->setCurrentIndex(interfaces_->findData(int(study.options.interfaces)));
  capture_->setCurrentIndex(capture_->findData(int(study.options.capture)));
  rows_->labelForField(capture_)->setEnabled(study.options.interfaces == Interfaces::fuzzy);
  capture_->setEnabled(study.options.interfaces == Interfaces::fuzzy);
}

}  // namespace lamella::ui
