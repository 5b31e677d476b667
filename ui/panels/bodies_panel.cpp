#include "ui/panels/bodies_panel.h"

#include <QDoubleSpinBox>
#include <QFormLayout>
#include <QHeaderView>
#include <QLabel>
#include <QToolButton>
#include <QTreeView>
#include <QVBoxLayout>

#include "ui/actions/actions.h"
#include "ui/models/body_model.h"
#include "ui/session/session.h"

namespace lamella::ui {
namespace {

QLabel* label(const QString& text, const char* kind) {
  auto* l = new QLabel(text);
  l->setObjectName(kind);
  return l;
}

QDoubleSpinBox* real_box(double low, double high, double step, int decimals) {
  auto* box = new QDoubleSpinBox;
  box->setRange(low, high);
  box->setSingleStep(step);
  box->setDecimals(decimals);
  box->setKeyboardTracking(false);
  return box;
}

QSpinBox* integer_box(int low, int high) {
  auto* box = new QSpinBox;
  box->setRange(low, high);
  box->setKeyboardTracking(false);
  return box;
}

}  // namespace

BodiesPanel::BodiesPanel(Session& session, Actions& actions, QWidget* parent)
    : QFrame(parent), session_(session) {
  setObjectName("panel");
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(1, 8, 1, 12);
  layout->setSpacing(6);

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

  model_ = new BodyModel(session, this);
  tree_ = new QTreeView;
  tree_->setObjectName("bodies");
  tree_->setModel(model_);
  tree_->setItemDelegate(new BodyDelegate(tree_));
  tree_->setRootIsDecorated(false);
  tree_->setIndentation(0);
  tree_->setUniformRowHeights(true);
  tree_->setEditTriggers(QAbstractItemView::DoubleClicked | QAbstractItemView::EditKeyPressed |
                         QAbstractItemView::SelectedClicked);
  tree_->setMinimumHeight(110);
  tree_->header()->setStretchLastSection(false);
  tree_->header()->setMinimumSectionSize(40);
  tree_->header()->setSectionResizeMode(BodyModel::name, QHeaderView::Stretch);
  const std::pair<int, int> widths[] = {
      {BodyModel::layers, 44}, {BodyModel::alpha, 50}, {BodyModel::h_min, 66}};
  for (const auto& [column, width] : widths) {
    tree_->header()->setSectionResizeMode(column, QHeaderView::Fixed);
    tree_->setColumnWidth(column, width);
  }
  layout->addWidget(tree_, 1);

  settings_ = new QWidget;
  auto* form = new QVBoxLayout(settings_);
  form->setContentsMargins(14, 4, 14, 0);
  form->setSpacing(8);
  details_ = label({}, "soft");
  details_->setWordWrap(true);
  details_->setTextFormat(Qt::RichText);
  form->addWidget(details_);
  form->addSpacing(4);
  form->addWidget(label(tr("Mesh of the selected body"), "section_title"));
  auto* body = new QFormLayout;
  body->setHorizontalSpacing(12);
  body->setVerticalSpacing(7);
  body->setFieldGrowthPolicy(QFormLayout::AllNonFixedFieldsGrow);
  layers_ = integer_box(1, 64);
  layers_->setObjectName("layers");
  layers_->setToolTip(tr("n: elements through the wall, everywhere"));
  body->addRow(tr("Layers n"), layers_);
  alpha_ = real_box(0.1, 20, 0.25, 2);
  alpha_->setToolTip(
      tr("Directions up to (1 + α) times the wall thickness are divided into n\n"
         "elements too; longer ones are left coarse"));
  body->addRow(tr("Stretch limit α"), alpha_);
  h_min_ = real_box(0, 1000, 0.01, 4);
  h_min_->setSuffix(tr(" mm"));
  h_min_->setSpecialValueText(tr("automatic"));
  h_min_->setToolTip(tr("No element is asked to be thinner; needed where walls end in a blade"));
  body->addRow(tr("Smallest size"), h_min_);
  form->addLayout(body);
  form->addSpacing(4);
  form->addWidget(label(tr("Run"), "section_title"));
  auto* run = new QFormLayout;
  run->setHorizontalSpacing(12);
  run->setVerticalSpacing(7);
  run->setFieldGrowthPolicy(QFormLayout::AllNonFixedFieldsGrow);
  iterations_ = integer_box(1, 50);
  iterations_->setToolTip(tr("Stops earlier once layers and nodes have settled"));
  run->addRow(tr("Iterations at most"), iterations_);
  threads_ = integer_box(0, 256);
  threads_->setSpecialValueText(tr("all cores"));
  threads_->setToolTip(tr("The mesh does not depend on it"));
  run->addRow(tr("Threads"), threads_);
  form->addLayout(run);
  layout->addWidget(settings_);

  connect(&session, &Session::parts_changed, this, &BodiesPanel::follow_parts);
  connect(&session, &Session::selection_changed, this, &BodiesPanel::follow_selection);
  connect(&session, &Session::study_changed, this, &BodiesPanel::follow_study);
  connect(tree_->selectionModel(), &QItemSelectionModel::currentRowChanged, this,
          [this](const QModelIndex& now) {
            if (now.isValid()) session_.select(now.row());
          });
  const auto edit = [this](int column, const QVariant& value) {
    if (session_.selected() >= 0)
      model_->setData(model_->index(session_.selected(), column), value, Qt::EditRole);
  };
  connect(layers_, &QSpinBox::valueChanged, this, [edit](int n) { edit(BodyModel::layers, n); });
  connect(alpha_, &QDoubleSpinBox::valueChanged, this,
          [edit](double a) { edit(BodyModel::alpha, a); });
  connect(h_min_, &QDoubleSpinBox::valueChanged, this,
          [edit](double h) { edit(BodyModel::h_min, h); });
  connect(iterations_, &QSpinBox::valueChanged, this, [this](int value) {
    Study study = session_.study();
    study.options.iterations = value;
    session_.edit(tr("Iterations"), std::move(study));
  });
  connect(threads_, &QSpinBox::valueChanged, this, [this](int value) {
    Study study = session_.study();
    study.options.threads = value;
    session_.edit(tr("Threads"), std::move(study));
  });
  follow_parts();
}

void BodiesPanel::follow_parts() {
  settings_->setVisible(!session_.parts().empty());
  follow_selection();
}

void BodiesPanel::follow_selection() {
  const int row = session_.selected();
  if (row >= 0 && row < model_->rowCount()) {
    tree_->setCurrentIndex(model_->index(row, BodyModel::name));
    const Part& part = session_.parts()[row];
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
      text += "<br><span style='color:#8a97a5'>" + QString::fromStdString(note).toHtmlEscaped() +
              "</span>";
    details_->setText(text);
  } else {
    details_->clear();
  }
  follow_study();
}

void BodiesPanel::follow_study() {
  const QSignalBlocker block[] = {QSignalBlocker(layers_), QSignalBlocker(alpha_),
                                  QSignalBlocker(h_min_), QSignalBlocker(iterations_),
                                  QSignalBlocker(threads_)};
  iterations_->setValue(session_.study().options.iterations);
  threads_->setValue(session_.study().options.threads);
  const int row = session_.selected();
  const bool any = row >= 0 && row < model_->rowCount();
  for (QWidget* w : std::initializer_list<QWidget*>{layers_, alpha_, h_min_}) w->setEnabled(any);
  if (!any) return;
  const BodySettings& body = session_.body(row);
  layers_->setValue(body.layers);
  alpha_->setValue(body.alpha);
  h_min_->setValue(body.h_min.value_or(0));
}

}  // namespace lamella::ui
