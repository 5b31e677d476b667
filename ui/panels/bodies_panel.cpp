#include "ui/panels/bodies_panel.h"

#include <QDoubleSpinBox>
#include <QFormLayout>
#include <QHeaderView>
#include <QLabel>
#include <QToolButton>
#include <QTreeView>
#include <QVBoxLayout>
#include <algorithm>
#include <limits>

#include "ui/actions/actions.h"
#include "ui/models/body_model.h"
#include "ui/panels/length_box.h"
#include "ui/session/session.h"

namespace lamella::ui {
namespace {

QLabel* label(const QString& text, const char* kind) {
  auto* l = new QLabel(text);
  l->setObjectName(kind);
  return l;
}

QSpinBox* integer_box(int low, int high, const char* name) {
  auto* box = new QSpinBox;
  box->setObjectName(name);
  box->setRange(low, high);
  box->setKeyboardTracking(false);
  return box;
}

LengthBox* length_box(const char* name, const QString& tip) {
  auto* box = new LengthBox;
  box->setObjectName(name);
  box->setToolTip(tip);
  return box;
}

QString short_length(double mm) { return QString::number(mm, 'g', 3); }

/// Rows whose labels have the same width in every group, so that the boxes line up.
class Form : public QFormLayout {
 public:
  Form() {
    setHorizontalSpacing(12);
    setVerticalSpacing(7);
    setFieldGrowthPolicy(QFormLayout::AllNonFixedFieldsGrow);
  }
  void add(const QString& text, QWidget* field) {
    auto* l = new QLabel(text);
    l->setMinimumWidth(112);
    l->setToolTip(field->toolTip());
    addRow(l, field);
  }
};

}  // namespace

BodiesPanel::BodiesPanel(Session& session, Actions& actions, QWidget* parent)
    : QFrame(parent), session_(session) {
  setObjectName("panel");
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(1, 8, 1, 12);
  layout->setSpacing(6);
  make_list(actions, layout);
  settings_ = new QWidget;
  auto* form = new QVBoxLayout(settings_);
  form->setContentsMargins(14, 4, 14, 0);
  form->setSpacing(8);
  details_ = label({}, "soft");
  details_->setWordWrap(true);
  details_->setTextFormat(Qt::RichText);
  form->addWidget(details_);
  form->addSpacing(6);
  make_body_settings(form);
  form->addSpacing(6);
  make_mesh_settings(form);
  layout->addWidget(settings_);

  connect(&session, &Session::parts_changed, this, &BodiesPanel::follow_parts);
  connect(&session, &Session::surfaces_changed, this, &BodiesPanel::show_details);
  connect(&session, &Session::selection_changed, this, &BodiesPanel::follow_selection);
  connect(&session, &Session::study_changed, this, &BodiesPanel::follow_study);
  connect(tree_->selectionModel(), &QItemSelectionModel::selectionChanged, this,
          &BodiesPanel::select_in_session);
  connect(tree_->selectionModel(), &QItemSelectionModel::currentRowChanged, this,
          &BodiesPanel::select_in_session);
  follow_parts();
}

void BodiesPanel::make_list(Actions& actions, QVBoxLayout* layout) {
  auto* header = new QHBoxLayout;
  header->setContentsMargins(14, 0, 8, 0);
  header->addWidget(label(tr("Bodies"), "panel_title"), 1);
  for (const Act act : {Act::add, Act::remove}) {
    auto* button = new QToolButton;
    button->setDefaultAction(actions[act]);
    button->setIconSize(QSize(18, 18));
    button->setAutoRaise(true);
    header->addWidget(button);
  }
  layout->addLayout(header);

  model_ = new BodyModel(session_, this);
  tree_ = new QTreeView;
  tree_->setObjectName("bodies");
  tree_->setModel(model_);
  tree_->setItemDelegate(new BodyDelegate(tree_));
  tree_->setRootIsDecorated(false);
  tree_->setIndentation(0);
  tree_->setUniformRowHeights(true);
  tree_->setSelectionMode(QAbstractItemView::ExtendedSelection);
  tree_->setAllColumnsShowFocus(true);
  tree_->setTextElideMode(Qt::ElideMiddle);
  tree_->setEditTriggers(QAbstractItemView::DoubleClicked | QAbstractItemView::EditKeyPressed);
  tree_->setMinimumHeight(100);
  tree_->header()->setStretchLastSection(false);
  tree_->header()->setMinimumSectionSize(40);
  tree_->header()->setSectionResizeMode(BodyModel::name, QHeaderView::Stretch);
  const std::pair<int, int> widths[] = {{BodyModel::layers, 48}, {BodyModel::measured, 84}};
  for (const auto& [column, width] : widths) {
    tree_->header()->setSectionResizeMode(column, QHeaderView::Fixed);
    tree_->setColumnWidth(column, width);
  }
  // Names need the room; both are set below the list.
  for (const int column : {BodyModel::alpha, BodyModel::h_min})
    tree_->setColumnHidden(column, true);
  layout->addWidget(tree_, 1);
}

void BodiesPanel::make_body_settings(QVBoxLayout* layout) {
  body_title_ = label({}, "section_title");
  layout->addWidget(body_title_);
  auto* form = new Form;
  layers_ = integer_box(1, 64, "layers");
  layers_->setToolTip(tr("n: elements through the wall, everywhere"));
  form->add(tr("Layers n"), layers_);
  alpha_ = new QDoubleSpinBox;
  alpha_->setObjectName("alpha");
  alpha_->setRange(0.1, 20);
  alpha_->setSingleStep(0.25);
  alpha_->setKeyboardTracking(false);
  alpha_->setToolTip(
      tr("Directions up to (1 + α) times the wall thickness are divided into n\n"
         "elements too; longer ones are left coarse"));
  form->add(tr("Stretch limit α"), alpha_);
  h_min_ = length_box("h_min", tr("No element is asked to be thinner; needed where walls end in a\n"
                                  "blade. Empty: automatic"));
  form->add(tr("Smallest size"), h_min_);
  h_max_ = length_box("h_max", tr("No element is asked to be longer. Empty: no bound"));
  form->add(tr("Largest size"), h_max_);
  layout->addLayout(form);

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
}

void BodiesPanel::make_mesh_settings(QVBoxLayout* layout) {
  layout->addWidget(label(tr("Mesh"), "section_title"));
  auto* form = new Form;
  chord_ =
      length_box("chord_tolerance", tr("The boundary of the mesh stays this close to the part.\n"
                                       "Empty: automatic, 1/1000 of the diagonal of each body"));
  form->add(tr("Chord tolerance"), chord_);
  iterations_ = integer_box(1, 50, "iterations");
  iterations_->setToolTip(tr("Stops earlier once layers and nodes have settled"));
  form->add(tr("Iterations at most"), iterations_);
  seed_ = integer_box(0, std::numeric_limits<int>::max(), "seed");
  seed_->setToolTip(tr("Another seed gives another, equally good mesh; the same one the same"));
  form->add(tr("Seed"), seed_);
  threads_ = integer_box(0, 256, "threads");
  threads_->setSpecialValueText(tr("all cores"));
  threads_->setToolTip(tr("The mesh does not depend on it"));
  form->add(tr("Threads"), threads_);
  layout->addLayout(form);

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
  connect(seed_, &QSpinBox::valueChanged, this, [edit](int value) {
    edit(tr("Seed"), [value](StudyOptions& o) { o.seed = static_cast<std::uint64_t>(value); });
  });
  connect(threads_, &QSpinBox::valueChanged, this, [edit](int value) {
    edit(tr("Threads"), [value](StudyOptions& o) { o.threads = value; });
  });
}

void BodiesPanel::select_in_session() {
  if (following_) return;
  std::vector<int> rows;
  for (const QModelIndex& index : tree_->selectionModel()->selectedRows())
    rows.push_back(index.row());
  if (!rows.empty()) session_.select(std::move(rows), tree_->currentIndex().row());
}

void BodiesPanel::follow_parts() {
  settings_->setVisible(!session_.parts().empty());
  follow_selection();
}

void BodiesPanel::follow_selection() {
  following_ = true;
  QItemSelection rows;
  for (const int row : session_.selection())
    if (row < model_->rowCount())
      rows.select(model_->index(row, 0), model_->index(row, BodyModel::column_count - 1));
  tree_->selectionModel()->select(rows, QItemSelectionModel::ClearAndSelect);
  if (session_.selected() >= 0)
    tree_->selectionModel()->setCurrentIndex(model_->index(session_.selected(), BodyModel::name),
                                             QItemSelectionModel::NoUpdate);
  following_ = false;
  show_details();
  follow_study();
}

void BodiesPanel::show_details() {
  const auto& chosen = session_.selection();
  if (chosen.empty()) {
    details_->clear();
    body_title_->setText(tr("No body selected"));
    return;
  }
  if (chosen.size() > 1) {
    double volume = 0;
    for (const int k : chosen) volume += session_.parts()[static_cast<std::size_t>(k)].cad_volume;
    details_->setText(
        tr("%1 bodies selected<br>Volume %L2 mm³").arg(chosen.size()).arg(volume, 0, 'f', 1));
    body_title_->setText(tr("Walls of the %1 selected bodies").arg(chosen.size()));
    return;
  }
  body_title_->setText(tr("Walls of the selected body"));
  const Part& part = session_.parts()[static_cast<std::size_t>(chosen.front())];
  Vec<3> low = Vec<3>::Zero();
  Vec<3> high = Vec<3>::Zero();
  if (!part.surface.points.empty()) low = high = part.surface.points.front();
  for (const Vec<3>& p : part.surface.points) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  const Vec<3> size = high - low;
  QString text = tr("%1 × %2 × %3 mm<br>Volume %L4 mm³<br>%L5 faces, %L6 triangles")
                     .arg(size[0], 0, 'g', 4)
                     .arg(size[1], 0, 'g', 4)
                     .arg(size[2], 0, 'g', 4)
                     .arg(part.cad_volume, 0, 'f', 1)
                     .arg(part.surface.faces.size())
                     .arg(part.surface.facets.size());
  for (const std::string& note : part.notes)
    text += "<br><span style='color:#52606d'>" + QString::fromStdString(note).toHtmlEscaped() +
            "</span>";
  details_->setText(text);
}

void BodiesPanel::show_automatic() {
  const auto range = [this](const std::vector<int>& of, double& low, double& high) {
    low = std::numeric_limits<double>::max();
    high = 0;
    for (const int k : of) {
      low = std::min(low, session_.automatic_size(k));
      high = std::max(high, session_.automatic_size(k));
    }
  };
  const auto text = [](double low, double high) {
    if (short_length(low) == short_length(high))
      return tr("automatic: %1 mm").arg(short_length(low));
    return tr("automatic: %1 to %2 mm").arg(short_length(low), short_length(high));
  };
  double low = 1;
  double high = 1;
  if (!session_.selection().empty()) {
    range(session_.selection(), low, high);
    h_min_->set_automatic(text(low, high), low);
    h_max_->set_automatic(tr("no bound"), 200 * low);
  }
  std::vector<int> all;
  for (int k = 0; k < model_->rowCount(); ++k) all.push_back(k);
  if (all.empty()) return;
  range(all, low, high);
  chord_->set_automatic(text(low, high), low);
}

void BodiesPanel::follow_study() {
  const QSignalBlocker block[] = {QSignalBlocker(layers_), QSignalBlocker(alpha_),
                                  QSignalBlocker(h_min_),  QSignalBlocker(h_max_),
                                  QSignalBlocker(chord_),  QSignalBlocker(iterations_),
                                  QSignalBlocker(seed_),   QSignalBlocker(threads_)};
  // Between a new study and its parts the two lists may differ for a moment.
  if (session_.study().bodies.size() != session_.parts().size()) return;
  const StudyOptions& options = session_.study().options;
  show_automatic();
  chord_->set_length(options.chord_tolerance);
  iterations_->setValue(options.iterations);
  seed_->setValue(
      static_cast<int>(std::min<std::uint64_t>(options.seed, std::numeric_limits<int>::max())));
  threads_->setValue(options.threads);
  const bool any = !session_.selection().empty();
  for (QWidget* w : std::initializer_list<QWidget*>{layers_, alpha_, h_min_, h_max_})
    w->setEnabled(any);
  if (!any) return;
  // A value that differs among the selected bodies is left out, and kept until it is changed.
  const BodySettings& first = session_.body(session_.selection().front());
  const auto differs = [this](auto&& value) {
    const auto& chosen = session_.selection();
    return std::any_of(chosen.begin(), chosen.end(), [&](int k) {
      return value(session_.body(k)) != value(session_.body(chosen.front()));
    });
  };
  const bool mixed_layers = differs([](const BodySettings& b) { return b.layers; });
  layers_->setMinimum(mixed_layers ? 0 : 1);
  layers_->setSpecialValueText(mixed_layers ? tr("different") : QString());
  layers_->setValue(mixed_layers ? 0 : first.layers);
  const bool mixed_alpha = differs([](const BodySettings& b) { return b.alpha; });
  alpha_->setMinimum(mixed_alpha ? 0 : 0.1);
  alpha_->setSpecialValueText(mixed_alpha ? tr("different") : QString());
  alpha_->setValue(mixed_alpha ? 0 : first.alpha);
  const bool mixed_min = differs([](const BodySettings& b) { return b.h_min; });
  if (mixed_min) h_min_->setSpecialValueText(tr("different"));
  h_min_->set_length(mixed_min ? std::nullopt : first.h_min);
  const bool mixed_max = differs([](const BodySettings& b) { return b.h_max; });
  if (mixed_max) h_max_->setSpecialValueText(tr("different"));
  h_max_->set_length(mixed_max ? std::nullopt : first.h_max);
}

}  // namespace lamella::ui
