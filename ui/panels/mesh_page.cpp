#include "ui/panels/mesh_page.h"

#include <QComboBox>
#include <QVBoxLayout>
#include <algorithm>
#include <limits>

#include "core/geometry/triangles.h"
#include "ui/panels/domain_form.h"
#include "ui/panels/form.h"
#include "ui/session/session.h"
#include "ui/units.h"

namespace lamella::ui {

MeshPage::MeshPage(Session& session, QWidget* parent) : QWidget(parent), session_(session) {
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->setSpacing(8);
  layout->addWidget(styled_label(tr("Mesh"), "section_title"));
  domain_ = new DomainForm(session);
  layout->addWidget(domain_);
  auto* form = new Form;
  chord_ =
      length_box("chord_tolerance", tr("The boundary of the mesh stays this close to the part.\n"
                                       "Empty: automatic, 1/1000 of the diagonal of each body"));
  form->add(tr("Chord tolerance"), chord_);
  iterations_ =
      integer_box(1, 50, "iterations", tr("Stops earlier once layers and nodes have settled"));
  form->add(tr("Iterations at most"), iterations_);
  layout->addLayout(form);
  more_ = new Folded(tr("Advanced"));
  settled_ = new QCheckBox(tr("when settled"));
  settled_->setObjectName("until_settled");
  settled_->setToolTip(
      tr("Ends once layers and nodes have settled; otherwise all iterations are made"));
  more_->form()->add(tr("End"), settled_);
  progressive_ = new QCheckBox(tr("2, 3, .. n layers"));
  progressive_->setObjectName("progressive");
  progressive_->setToolTip(
      tr("The first iterations ask for fewer layers: less memory at the peak,\n"
         "which is in the first iteration"));
  more_->form()->add(tr("Progressive"), progressive_);
  detector_ = new QComboBox;
  detector_->setObjectName("detector");
  detector_->addItem(tr("rays and balls"), int(Detector::geometric));
  detector_->addItem(tr("neighborhoods"), int(Detector::neighborhood));
  detector_->setToolTip(
      tr("Who finds the thickness of the walls: rays and balls inside the part,\n"
         "or neighborhoods grown in the mesh, as in the thesis"));
  more_->form()->add(tr("Thickness by"), detector_);
  anisotropy_ =
      integer_box(0, 1000, "max_anisotropy",
                  tr("Longest over shortest size of an element. Solvers by finite volumes\n"
                     "and Moldflow like 10 to 20; each halving costs about four times the\n"
                     "nodes along the walls"));
  anisotropy_->setSpecialValueText(tr("no bound"));
  more_->form()->add(tr("Anisotropy at most"), anisotropy_);
  seed_ = integer_box(0, std::numeric_limits<int>::max(), "seed",
                      tr("Another seed gives another, equally good mesh; the same one the same"));
  more_->form()->add(tr("Seed"), seed_);
  threads_ = integer_box(0, 256, "threads", tr("The mesh does not depend on it"));
  threads_->setSpecialValueText(tr("all cores"));
  more_->form()->add(tr("Threads"), threads_);
  memory_ =
      integer_box(0, 10000000, "memory", tr("A run that is expected to take more does not start"));
  memory_->setSpecialValueText(tr("no bound"));
  memory_->setSuffix(tr(" MB"));
  memory_->setSingleStep(1000);
  more_->form()->add(tr("Memory budget"), memory_);
  layout->addWidget(more_);

  const auto edit = [this](const QString& what, auto&& change) {
    Study study = session_.study();
    change(study.options);
    session_.edit(what, std::move(study));
  };
  connect(chord_, &QDoubleSpinBox::valueChanged, this, [this, edit] {
    edit(tr("Chord tolerance"), [this](StudyOptions& o) { o.chord_tolerance = chord_->length(); });
  });
  connect(iterations_, &QSpinBox::valueChanged, this, [edit](int value) {
    edit(tr("Iterations"), [value](StudyOptions& o) { o.iterations = value; });
  });
  connect(settled_, &QCheckBox::toggled, this, [edit](bool on) {
    edit(tr("End when settled"), [on](StudyOptions& o) { o.until_settled = on; });
  });
  connect(progressive_, &QCheckBox::toggled, this, [edit](bool on) {
    edit(tr("Progressive layers"), [on](StudyOptions& o) { o.progressive = on; });
  });
  connect(detector_, &QComboBox::currentIndexChanged, this, [this, edit] {
    const auto chosen = Detector(detector_->currentData().toInt());
    edit(tr("Thickness detector"), [chosen](StudyOptions& o) { o.detector = chosen; });
  });
  connect(anisotropy_, &QSpinBox::valueChanged, this, [edit](int value) {
    edit(tr("Anisotropy at most"), [value](StudyOptions& o) {
      o.max_anisotropy = value > 0 ? std::optional<double>(value) : std::nullopt;
    });
  });
  connect(seed_, &QSpinBox::valueChanged, this, [edit](int value) {
    edit(tr("Seed"), [value](StudyOptions& o) { o.seed = static_cast<std::uint64_t>(value); });
  });
  connect(threads_, &QSpinBox::valueChanged, this, [edit](int value) {
    edit(tr("Threads"), [value](StudyOptions& o) { o.threads = value; });
  });
  connect(memory_, &QSpinBox::valueChanged, this, [edit](int mb) {
    edit(tr("Memory budget"),
         [mb](StudyOptions& o) { o.memory = mb > 0 ? std::optional<double>(mb) : std::nullopt; });
  });
}

void MeshPage::refresh() {
  const QSignalBlocker block[] = {
      QSignalBlocker(chord_),       QSignalBlocker(iterations_), QSignalBlocker(settled_),
      QSignalBlocker(progressive_), QSignalBlocker(detector_),   QSignalBlocker(seed_),
      QSignalBlocker(threads_),     QSignalBlocker(memory_),     QSignalBlocker(anisotropy_)};
  domain_->refresh();
  const bool one = session_.study().domain.has_value();
  double low = std::numeric_limits<double>::max();
  double high = 0;
  for (int k = 0; k < static_cast<int>(session_.shapes().size()); ++k) {
    // One mesh of all bodies has the tolerance of its domain.
    if (one && !session_.hull().points.empty())
      low = high = 1e-3 * diagonal_of(session_.hull().points);
    if (session_.shapes()[std::size_t(k)].surface.points.empty() || low == high) continue;
    low = std::min(low, session_.automatic_size(k));
    high = std::max(high, session_.automatic_size(k));
  }
  const QString least = units::length(low, 3);
  const QString most = units::length(high, 3);
  if (high > 0)
    chord_->set_automatic(
        least == most ? tr("auto: %1").arg(least) : tr("auto: %1 to %2").arg(least, most), low);
  const StudyOptions& o = session_.study().options;
  chord_->set_length(o.chord_tolerance);
  iterations_->setValue(o.iterations);
  settled_->setChecked(o.until_settled);
  progressive_->setChecked(o.progressive);
  // Of no use to one mesh of all bodies.
  progressive_->setEnabled(!one);
  detector_->setEnabled(!one);
  detector_->setCurrentIndex(detector_->findData(int(o.detector)));
  anisotropy_->setValue(static_cast<int>(std::lround(o.max_anisotropy.value_or(0))));
  seed_->setValue(
      static_cast<int>(std::min<std::uint64_t>(o.seed, std::numeric_limits<int>::max())));
  threads_->setValue(o.threads);
  memory_->setValue(static_cast<int>(o.memory.value_or(0)));
}

}  // namespace lamella::ui
