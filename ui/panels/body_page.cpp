#include "ui/panels/body_page.h"

#include <QColorDialog>
#include <QComboBox>
#include <QPushButton>
#include <QVBoxLayout>
#include <algorithm>
#include <limits>

#include "ui/box_of.h"
#include "ui/commands/study_edits.h"
#include "ui/panels/form.h"
#include "ui/panels/zone_form.h"
#include "ui/session/session.h"
#include "ui/theme.h"
#include "ui/units.h"

namespace lamella::ui {
namespace {

/// Width over which n2 reaches when it is asked for first.
constexpr double first_alpha2 = 4;

QString short_length(double mm) { return units::number(mm, 3); }

QString size_text(const Part& part) {
  if (part.surface.points.empty()) return {};
  const Box<3> box = box_of(part.surface.points);
  const std::size_t faces = part.surface.faces.size();
  return BodyPage::tr("%1<br>Volume %2<br>%3, %L4 triangles")
      .arg(units::size(box.hi - box.lo), units::volume(part.cad_volume),
           faces == 1 ? BodyPage::tr("1 face") : BodyPage::tr("%L1 faces").arg(faces))
      .arg(part.surface.facets.size());
}

}  // namespace

BodyPage::BodyPage(Session& session, QWidget* parent) : QWidget(parent), session_(session) {
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->setSpacing(8);
  title_ = styled_label({}, "panel_title");
  title_->setWordWrap(true);
  layout->addWidget(title_);
  details_ = styled_label({}, "soft");
  details_->setWordWrap(true);
  details_->setTextFormat(Qt::RichText);
  layout->addWidget(details_);

  zone_ = new ZoneForm(session);
  layout->addWidget(zone_);
  auto* is = new Form;
  role_ = new QComboBox;
  role_->setObjectName("role");
  role_->setToolTip(
      tr("What the body is in the tool. It gives the body its color and its layers,\n"
         "and tells who keeps what bodies share in one mesh of all: inserts before\n"
         "cavities and channels, and these before the mold"));
  for (const BodyRole role :
       {BodyRole::none, BodyRole::cavity, BodyRole::channel, BodyRole::insert, BodyRole::mold})
    role_->addItem(role_title(role), int(role));
  is->add(tr("Role"), role_);
  layout->addLayout(is);

  layout->addWidget(styled_label(tr("Walls"), "section_title"));
  auto* form = new Form;
  layers_ = integer_box(
      1, 64, "layers", pictured_tip("help-layers", tr("n: elements through the wall, everywhere")));
  form->add(tr("Layers n"), layers_);
  alpha_ = number_box(
      0.1, 20, 0.25, "alpha",
      pictured_tip("help-alpha", tr("Directions up to (1 + α) times the wall thickness are "
                                    "divided into n elements too; longer ones are left coarse")));
  form->add(tr("Stretch limit α"), alpha_);
  h_min_ = length_box(
      "h_min",
      pictured_tip("help-h_min", tr("No element is asked to be thinner; needed where walls "
                                    "end in a blade. Empty: automatic")));
  form->add(tr("Smallest size"), h_min_);
  h_max_ = length_box("h_max", tr("No element is asked to be longer. Empty: no bound"));
  form->add(tr("Largest size"), h_max_);
  interface_ = length_box("interface_size",
                          tr("Across the borders of the body in one mesh of all bodies; of two\n"
                             "bodies the smaller counts. Empty: automatic"));
  form->add(tr("Interface size"), interface_);
  flow_ = new QCheckBox(tr("corrects the mesh"));
  flow_->setObjectName("body_flow");
  flow_->setToolTip(tr("The flow through its gates may refine this body"));
  form->add(tr("Flow"), flow_);
  rows_ = form;
  layout->addLayout(form);

  more_ = new Folded(tr("Width and length"));
  layers2_ = integer_box(0, 64, "layers2",
                         tr("n2: elements through the width of a wall, for channels and ribs.\n"
                            "It needs to be told up to which width: see α2"));
  more_->form()->add(tr("Through width n2"), layers2_);
  alpha2_ = number_box(0, 100, 1, "alpha2",
                       tr("Sizes up to (1 + α + α2) times the thickness count as width"));
  more_->form()->add(tr("Width limit α2"), alpha2_);
  layers3_ = integer_box(0, 64, "layers3", tr("n3: elements along all longer directions"));
  more_->form()->add(tr("Along length n3"), layers3_);
  layout->addWidget(more_);
  color_ = new QPushButton(tr("Color…"));
  color_->setToolTip(tr("Color of the selected bodies in the view"));
  layout->addWidget(color_, 0, Qt::AlignLeft);
  layout->addStretch(1);
  connect_boxes();
}

void BodyPage::connect_boxes() {
  connect(role_, &QComboBox::activated, this, [this] {
    if (role_->currentIndex() < 0) return;
    const auto role = BodyRole(role_->currentData().toInt());
    session_.edit_selection(tr("Role"), [role](BodySettings& b) {
      // Layers that were chosen by hand stay.
      if (b.layers == role_layers(b.role)) b.layers = role_layers(role);
      b.role = role;
    });
  });
  connect(layers_, &QSpinBox::valueChanged, this, [this](int n) {
    if (n > 0) session_.edit_selection(tr("Layers"), [n](BodySettings& b) { b.layers = n; });
  });
  connect(alpha_, &QDoubleSpinBox::valueChanged, this, [this](double a) {
    if (a > 0) session_.edit_selection(tr("α"), [a](BodySettings& b) { b.alpha = a; });
  });
  connect(h_min_, &QDoubleSpinBox::valueChanged, this, [this] {
    const auto h = h_min_->length();
    session_.edit_selection(tr("Smallest size"), [h](BodySettings& b) {
      b.h_min = h;
      if (b.h_max && h) b.h_max = std::max(*b.h_max, *h);
    });
  });
  connect(h_max_, &QDoubleSpinBox::valueChanged, this, [this] {
    const auto h = h_max_->length();
    session_.edit_selection(tr("Largest size"), [h](BodySettings& b) {
      b.h_max = h;
      if (b.h_min && h) b.h_min = std::min(*b.h_min, *h);
    });
  });
  connect(interface_, &QDoubleSpinBox::valueChanged, this, [this] {
    const auto h = interface_->length();
    session_.edit_selection(tr("Interface size"), [h](BodySettings& b) { b.interface_size = h; });
  });
  connect(layers2_, &QSpinBox::valueChanged, this, [this](int n) {
    if (n < 0) return;
    session_.edit_selection(tr("n2"), [n](BodySettings& b) {
      b.layers2 = n > 0 ? std::optional(n) : std::nullopt;
      // The two go together.
      b.alpha2 = n == 0 ? 0 : b.alpha2 > 0 ? b.alpha2 : first_alpha2;
    });
  });
  connect(alpha2_, &QDoubleSpinBox::valueChanged, this, [this](double a) {
    if (a <= 0) return;
    session_.edit_selection(tr("α2"), [a](BodySettings& b) {
      if (b.layers2) b.alpha2 = a;
    });
  });
  connect(layers3_, &QSpinBox::valueChanged, this, [this](int n) {
    if (n < 0) return;
    session_.edit_selection(
        tr("n3"), [n](BodySettings& b) { b.layers3 = n > 0 ? std::optional(n) : std::nullopt; });
  });
  connect(flow_, &QCheckBox::clicked, this, [this](bool on) {
    session_.edit_selection(tr("Flow through a body"), [on](BodySettings& b) { b.flow = on; });
  });
  connect(color_, &QPushButton::clicked, this, [this] {
    if (session_.selection().empty()) return;
    const QColor color =
        QColorDialog::getColor(session_.color_of(session_.selection().front()), this);
    if (!color.isValid()) return;
    session_.edit_selection(tr("Color"), [color](BodySettings& b) {
      b.color = std::array<double, 3>{color.redF(), color.greenF(), color.blueF()};
    });
  });
}

void BodyPage::show_details() {
  const auto& chosen = session_.selection();
  if (chosen.empty()) {
    details_->clear();
    title_->setText(tr("No body selected"));
    return;
  }
  if (chosen.size() > 1) {
    double volume = 0;
    for (const int k : chosen) volume += session_.shapes()[static_cast<std::size_t>(k)].cad_volume;
    title_->setText(tr("%1 bodies").arg(chosen.size()));
    details_->setText(tr("Volume %1").arg(units::volume(volume)));
    return;
  }
  const Part& part = session_.shapes()[static_cast<std::size_t>(chosen.front())];
  title_->setText(QString::fromStdString(part.name));
  QString text = session_.is_part(chosen.front())   ? size_text(part)
                 : session_.is_zone(chosen.front()) ? tr("A body by formula<br>") + size_text(part)
                                                    : tr("What is around the bodies in the domain");
  for (const std::string& note : part.notes)
    text += "<br>" + QString::fromStdString(note).toHtmlEscaped();
  details_->setText(text);
}

void BodyPage::show_automatic() {
  double low = std::numeric_limits<double>::max();
  double high = 0;
  for (const int k : session_.selection()) {
    low = std::min(low, session_.automatic_size(k));
    high = std::max(high, session_.automatic_size(k));
  }
  h_min_->set_automatic(short_length(low) == short_length(high)
                            ? tr("auto: %1").arg(units::length(low, 3))
                            : tr("auto: %1–%2").arg(units::number(low, 2), units::length(high, 2)),
                        low);
  h_max_->set_automatic(tr("no bound"), 200 * low);
  // A run has found out what automatic means.
  QString automatic = session_.study().options.interfaces == Interfaces::fuzzy
                          ? tr("auto: 1/4 of a layer")
                          : tr("auto: as the layers");
  double start = low;
  const auto& outcome = session_.outcome();
  if (outcome && session_.selection().size() == 1)
    for (const BodyOutcome& made : outcome->bodies)
      if (made.name == session_.body(session_.selection().front()).name &&
          made.interface_size > 0 && !session_.body(session_.selection().front()).interface_size) {
        start = made.interface_size;
        automatic = tr("auto: %1").arg(units::length(start, 3));
      }
  interface_->set_automatic(automatic, start);
}

void BodyPage::refresh() {
  show_details();
  const auto& chosen = session_.selection();
  setEnabled(!chosen.empty());
  const int first_zone = static_cast<int>(session_.parts().size());
  zone_->show_zone(
      chosen.size() == 1 && session_.is_zone(chosen.front()) ? chosen.front() - first_zone : -1);
  if (chosen.empty()) return;
  const QSignalBlocker block[] = {QSignalBlocker(layers_),  QSignalBlocker(alpha_),
                                  QSignalBlocker(h_min_),   QSignalBlocker(h_max_),
                                  QSignalBlocker(layers2_), QSignalBlocker(alpha2_),
                                  QSignalBlocker(layers3_), QSignalBlocker(interface_)};
  show_automatic();
  const BodySettings& first = session_.body(chosen.front());
  const auto differs = [&](auto&& value) {
    return std::any_of(chosen.begin(), chosen.end(),
                       [&](int k) { return value(session_.body(k)) != value(first); });
  };
  // What differs is shown as the special value of the box, one step below what can be chosen.
  const auto show = [&](auto* box, auto value, auto least, const QString& at_least, auto of) {
    const bool mixed = differs(of);
    box->setMinimum(mixed ? least - 1 : least);
    box->setSpecialValueText(mixed ? tr("different") : at_least);
    box->setValue(mixed ? least - 1 : value);
  };
  const bool mixed_role = differs([](const BodySettings& b) { return b.role; });
  role_->setCurrentIndex(mixed_role ? -1 : role_->findData(int(first.role)));
  show(layers_, first.layers, 1, QString(), [](const BodySettings& b) { return b.layers; });
  const bool mixed_alpha = differs([](const BodySettings& b) { return b.alpha; });
  alpha_->setMinimum(mixed_alpha ? 0 : 0.1);
  alpha_->setSpecialValueText(mixed_alpha ? tr("different") : QString());
  alpha_->setValue(mixed_alpha ? 0 : first.alpha);
  show(layers2_, first.layers2.value_or(0), 0, tr("as the length"),
       [](const BodySettings& b) { return b.layers2; });
  show(alpha2_, first.alpha2, 0.0, tr("none"), [](const BodySettings& b) { return b.alpha2; });
  alpha2_->setEnabled(std::any_of(chosen.begin(), chosen.end(),
                                  [&](int k) { return session_.body(k).layers2.has_value(); }));
  show(layers3_, first.layers3.value_or(0), 0, tr("not divided"),
       [](const BodySettings& b) { return b.layers3; });
  if (first.layers2 || first.layers3) more_->set_open(true);
  const bool mixed_min = differs([](const BodySettings& b) { return b.h_min; });
  if (mixed_min) h_min_->setSpecialValueText(tr("different"));
  h_min_->set_length(mixed_min ? std::nullopt : first.h_min);
  const bool mixed_max = differs([](const BodySettings& b) { return b.h_max; });
  if (mixed_max) h_max_->setSpecialValueText(tr("different"));
  h_max_->set_length(mixed_max ? std::nullopt : first.h_max);
  rows_->setRowVisible(flow_, session_.study().flow.has_value());
  flow_->setCheckState(differs([](const BodySettings& b) { return b.flow; }) ? Qt::PartiallyChecked
                       : first.flow                                          ? Qt::Checked
                                                                             : Qt::Unchecked);
  rows_->setRowVisible(interface_, session_.study().domain.has_value());
  const bool mixed_size = differs([](const BodySettings& b) { return b.interface_size; });
  if (mixed_size) interface_->setSpecialValueText(tr("different"));
  interface_->set_length(mixed_size ? std::nullopt : first.interface_size);
}

}  // namespace lamella::ui
