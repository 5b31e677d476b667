#include "ui/panels/flow_panel.h"

#include <QCheckBox>
#include <QComboBox>
#include <QHBoxLayout>
#include <QPushButton>
#include <QScrollArea>
#include <QSlider>
#include <QToolButton>
#include <QVBoxLayout>
#include <cmath>

#include "ui/actions/actions.h"
#include "ui/panels/form.h"
#include "ui/session/session.h"
#include "ui/theme.h"
#include "ui/units.h"
#include "ui/views/plot.h"

namespace lamella::ui {
namespace {

constexpr int kSteps = 40;      // of the slider on each side of 1
constexpr double kDecades = 1;  // on each side

double weight_at(int position) { return std::pow(10, kDecades * position / kSteps); }
int position_of(double weight) {
  return static_cast<int>(std::lround(kSteps * std::log10(weight) / kDecades));
}

QString method_title(FlowMethod method) {
  switch (method) {
    case FlowMethod::acceleration:
      return FlowPanel::tr("Acceleration");
    case FlowMethod::velocity:
      return FlowPanel::tr("Velocity");
    case FlowMethod::strain:
      return FlowPanel::tr("Strain rate");
    case FlowMethod::combined:
      return FlowPanel::tr("Velocity and curvature");
    case FlowMethod::field:
      return FlowPanel::tr("Gradient of the field");
    case FlowMethod::direction:
      return FlowPanel::tr("Change of direction");
    case FlowMethod::residual:
      return FlowPanel::tr("Residual");
    case FlowMethod::directional:
      return FlowPanel::tr("Directional residual");
    case FlowMethod::indicator:
      return FlowPanel::tr("Field as an indicator");
  }
  return {};
}

/// The widget where there may be too little height for it.
QScrollArea* scrolled_down(QWidget* widget, const QString& name) {
  auto* area = new QScrollArea;
  area->setWidget(widget);
  widget->setAutoFillBackground(false);  // as setWidget made it
  area->setWidgetResizable(true);
  area->setFrameShape(QFrame::NoFrame);
  area->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  area->setAccessibleName(name);
  return area;
}

QString cell(const QString& text, bool number) {
  return QString("<td align='%1' style='padding: 2px 14px 2px 0'>%2</td>")
      .arg(number ? "right" : "left", text);
}

}  // namespace

FlowPanel::FlowPanel(Session& session, Actions& actions, QWidget* parent)
    : QWidget(parent), session_(session) {
  auto* layout = new QHBoxLayout(this);
  layout->setContentsMargins(12, 8, 8, 8);
  layout->setSpacing(14);
  // Each part scrolls by itself: the others stay in sight.
  QScrollArea* settings = scrolled_down(make_settings(), tr("Correct the mesh by the flow"));
  settings->setMaximumWidth(324);
  layout->addWidget(settings, 1);
  auto* right = new QVBoxLayout;
  right->setSpacing(6);
  auto* tools = new QHBoxLayout;
  tools->setSpacing(4);
  actions[Act::flow_arrows]->setIconText(tr("Arrows"));
  actions[Act::flow_lines]->setIconText(tr("Lines"));
  actions[Act::flow_levels]->setIconText(tr("Levels"));
  for (const Act act : {Act::solve_flow, Act::flow_arrows, Act::flow_lines, Act::flow_levels}) {
    auto* button = new QToolButton;
    button->setDefaultAction(actions[act]);
    button->setToolButtonStyle(act == Act::solve_flow ? Qt::ToolButtonTextBesideIcon
                                                      : Qt::ToolButtonTextOnly);
    tools->addWidget(button);
  }
  tools->addStretch(1);
  right->addLayout(tools);
  source_ = make_source();
  right->addWidget(source_);
  found_ = styled_label({}, "soft");
  found_->setObjectName("flow_found");
  found_->setTextFormat(Qt::RichText);
  found_->setWordWrap(true);
  found_->setAlignment(Qt::AlignTop | Qt::AlignLeft);
  auto* results = new QHBoxLayout;
  results->setSpacing(12);
  results->addWidget(scrolled_down(found_, tr("Flow")), 1);
  residuals_ = new Plot(tr("Residual"));
  residuals_->setObjectName("residual_plot");
  residuals_->set_logarithmic(true);
  residuals_->set_decimals(10);
  results->addWidget(residuals_, 1);
  right->addLayout(results, 1);
  layout->addLayout(right, 1);

  wait_.setSingleShot(true);
  wait_.setInterval(250);
  connect(&wait_, &QTimer::timeout, this, &FlowPanel::count);
  connect(&worker_, &Worker::finished, this, &FlowPanel::refresh);
  for (const auto signal :
       {&Session::study_changed, &Session::shown_changed, &Session::activity_changed,
        &Session::parts_changed, &Session::result_read})
    connect(&session, signal, this, &FlowPanel::refresh);
  connect_boxes();
  refresh();
}

QWidget* FlowPanel::make_settings() {
  auto* box = new QWidget;
  auto* layout = new QVBoxLayout(box);
  layout->setContentsMargins(0, 0, 6, 0);
  layout->setSpacing(4);
  correct_ = new QCheckBox(tr("Correct the mesh by the flow"));
  correct_->setObjectName("flow_correct");
  correct_->setToolTip(
      tr("A run solves the flow once the mesh has settled, refines where the flow "
         "asks for it, and meshes again"));
  layout->addWidget(correct_);
  auto* form = new Form;
  form->setVerticalSpacing(4);
  from_ = new QComboBox;
  from_->setObjectName("flow_from");
  from_->addItems({tr("Flow, solved here"), tr("Result of another solver")});
  from_->setToolTip(
      tr("A Stokes flow between gates and vents, or what Moldflow, OpenFOAM\n"
         "or any other solver has found, on whatever mesh"));
  form->add(tr("From"), from_);
  method_ = new QComboBox;
  method_->setObjectName("flow_method");
  method_->setToolTip(
      tr("What the mesh is to follow: the gradient of a field, or an indicator\n"
         "that is made even over the elements"));
  form->add(tr("By"), method_);
  auto* weight = new QWidget;
  auto* row = new QHBoxLayout(weight);
  row->setContentsMargins(0, 0, 0, 0);
  weight_ = new QSlider(Qt::Horizontal);
  weight_->setObjectName("flow_weight");
  weight_->setAccessibleName(tr("Strength"));
  weight_->setRange(-kSteps, kSteps);
  row->addWidget(weight_, 1);
  weight_text_ = styled_label({}, "soft");
  weight_text_->setFixedWidth(40);
  weight_text_->setAlignment(Qt::AlignRight | Qt::AlignVCenter);
  row->addWidget(weight_text_);
  form->add(tr("Strength"), weight);
  weight_title_ = qobject_cast<QLabel*>(form->labelForField(weight));
  expected_ = styled_label({}, "soft");
  expected_->setObjectName("flow_expected");
  expected_->setWordWrap(true);
  form->addRow(expected_);
  growth_ = number_box(1.05, 20, 0.1, "flow_growth",
                       tr("Elements that the correction may ask for, over those without it"));
  growth_->setPrefix("× ");
  form->add(tr("Elements at most"), growth_);
  rounds_ = integer_box(0, 20, "flow_rounds",
                        tr("Rounds of flow and correction; 0: the flow is solved alone"));
  form->add(tr("Rounds"), rounds_);
  h_min_ = length_box("flow_h_min", tr("The correction asks for no less"));
  h_min_->set_automatic(tr("of the body"), 0.1);
  form->add(tr("Smallest size"), h_min_);
  layout->addLayout(form);
  layout->addStretch(1);
  return box;
}

QWidget* FlowPanel::make_source() {
  auto* source = new QWidget;
  auto* form = new Form;
  form->setContentsMargins(0, 0, 0, 0);
  form->setVerticalSpacing(4);
  source->setLayout(form);
  file_ = new QPushButton;
  file_->setObjectName("flow_file");
  form->add(tr("File"), file_);
  auto* row = new QWidget;
  auto* boxes = new QHBoxLayout(row);
  boxes->setContentsMargins(0, 0, 0, 0);
  field_ = new QComboBox;
  field_->setObjectName("flow_field");
  field_->setToolTip(tr("Numbers and vectors that the file has, at its points or cells"));
  boxes->addWidget(field_, 1);
  unit_ = new QComboBox;
  unit_->setObjectName("flow_unit");
  unit_->setAccessibleName(tr("Unit of length of the file"));
  unit_->setToolTip(tr("Unit of length of the file, which names none"));
  for (const FileUnit& unit : kFileUnits)
    unit_->addItem(QString::fromUtf8(unit.name.data(), static_cast<int>(unit.name.size())),
                   unit.mm);
  boxes->addWidget(unit_);
  form->add(tr("Field, unit"), row);
  return source;
}

void FlowPanel::connect_source() {
  connect(from_, &QComboBox::activated, this, [this](int index) {
    const bool of_solver = session_.study().flow && session_.study().flow->field;
    if (index == 1 && !of_solver) Q_EMIT result_asked();
    if (index == 0 && of_solver)
      edit(tr("Correct by the flow"), [](StudyFlow& flow) {
        flow.field.reset();
        flow.method = StudyFlow{}.method;
      });
    refresh();  // where no file was chosen
  });
  connect(file_, &QPushButton::clicked, this, &FlowPanel::result_asked);
  // What is shown on the mesh follows.
  connect(field_, &QComboBox::activated, this, [this] {
    const std::string name = field_->currentText().toStdString();
    const int components = field_->currentData().toInt();
    edit(tr("Field %1").arg(field_->currentText()), [&](StudyFlow& flow) {
      flow.field->name = name;
      if (!suits_field(flow.method, components)) flow.method = FlowMethod::field;
    });
    session_.solve_flow();
  });
  connect(unit_, &QComboBox::activated, this, [this] {
    const double unit = unit_->currentData().toDouble();
    edit(tr("Unit of the result"), [unit](StudyFlow& flow) { flow.field->source.unit = unit; });
    session_.solve_flow();
  });
  connect(h_min_, &QDoubleSpinBox::valueChanged, this, [this] {
    edit(tr("Smallest size for the flow"),
         [this](StudyFlow& flow) { flow.h_min = h_min_->length(); });
  });
}

void FlowPanel::show_source(const StudyFlow& flow) {
  const bool of_solver = flow.field.has_value();
  from_->setCurrentIndex(of_solver ? 1 : 0);
  source_->setVisible(of_solver);
  const auto result = session_.result();
  int components = 0;  // not known
  if (of_solver) {
    const QString path = QString::fromStdString(flow.field->source.file);
    file_->setText(file_->fontMetrics().elidedText(path.section('/', -1), Qt::ElideMiddle, 150));
    file_->setToolTip(path);
    field_->clear();
    if (result)
      for (const NodeField& field : result->content.of_nodes)
        field_->addItem(QString::fromStdString(field.name), field.components);
    const QString name = QString::fromStdString(flow.field->name);
    if (field_->findText(name) < 0) field_->addItem(name, 0);
    field_->setCurrentText(name);
    components = field_->currentData().toInt();
    unit_->setCurrentIndex(unit_->findData(flow.field->source.unit));
  }
  method_->clear();
  const auto offer = [&](FlowMethod method) {
    method_->addItem(method_title(method), static_cast<int>(method));
  };
  if (of_solver)
    for (const FlowMethod method : kFieldMethods) {
      const bool suits = components == 0 ? suits_field(method, 1) || suits_field(method, 3)
                                         : suits_field(method, components);
      if (suits) offer(method);
    }
  else
    for (const FlowMethod method : kFlowMethods) offer(method);
}

void FlowPanel::connect_boxes() {
  connect_source();
  connect(correct_, &QCheckBox::clicked, this, [this](bool on) {
    Study study = session_.study();
    study.flow = on ? std::optional(StudyFlow{}) : std::nullopt;
    session_.edit(on ? tr("Correct by the flow") : tr("No correction by the flow"),
                  std::move(study));
  });
  connect(method_, &QComboBox::activated, this, [this] {
    const auto method = static_cast<FlowMethod>(method_->currentData().toInt());
    edit(tr("Correct by %1").arg(method_title(method)),
         [method](StudyFlow& flow) { flow.method = method; });
    // The indicator on the mesh is that of the method; a flow is not solved again for it.
    if (session_.study().flow && session_.study().flow->field) session_.solve_flow();
  });
  connect(weight_, &QSlider::sliderPressed, this, [this] { merge_ = session_.new_merge(); });
  connect(weight_, &QSlider::valueChanged, this, [this](int position) {
    const double weight = weight_at(position);
    edit(
        tr("Strength of the flow"),
        [weight](StudyFlow& flow) {
          // To the right is more of it.
          if (adds_gradient(flow.method))
            flow.strength = weight;
          else
            flow.beta = 1 / weight;
        },
        merge_);
  });
  connect(growth_, &QDoubleSpinBox::valueChanged, this, [this](double growth) {
    edit(tr("Elements for the flow"), [growth](StudyFlow& flow) { flow.growth = growth; });
  });
  connect(rounds_, &QSpinBox::valueChanged, this, [this](int rounds) {
    edit(tr("Rounds of the flow"), [rounds](StudyFlow& flow) { flow.rounds = rounds; });
  });
}

void FlowPanel::edit(const QString& what, const std::function<void(StudyFlow&)>& change,
                     int merge) {
  Study study = session_.study();
  if (!study.flow) return;
  change(*study.flow);
  session_.edit(what, std::move(study), merge);
}

void FlowPanel::refresh() {
  const std::optional<StudyFlow>& asked = session_.study().flow;
  const StudyFlow flow = asked.value_or(StudyFlow{});
  const bool gradient = adds_gradient(flow.method);
  const double weight = gradient ? flow.strength : 1 / flow.beta;
  {
    const QSignalBlocker blocks[] = {QSignalBlocker(weight_), QSignalBlocker(growth_),
                                     QSignalBlocker(rounds_), QSignalBlocker(h_min_)};
    correct_->setChecked(asked.has_value());
    show_source(flow);
    h_min_->set_length(flow.h_min);
    method_->setCurrentIndex(method_->findData(static_cast<int>(flow.method)));
    weight_->setValue(position_of(weight));
    growth_->setValue(flow.growth);
    rounds_->setValue(flow.rounds);
  }
  correct_->setEnabled(session_.has_bodies());
  for (QWidget* box : std::initializer_list<QWidget*>{from_, file_, field_, unit_, method_, weight_,
                                                      growth_, rounds_, h_min_})
    box->setEnabled(asked.has_value());
  weight_title_->setText(gradient ? tr("Strength") : tr("Mean error"));
  weight_->setToolTip(gradient ? tr("To the right the flow asks for smaller sizes")
                               : tr("To the right the mean error is to be smaller"));
  weight_text_->setText(gradient ? written(weight, 'g', 2) : "× " + written(flow.beta, 'g', 2));
  const auto state = session_.shown_state();
  // A run needs the processors.
  if (session_.activity() == Activity::running) worker_.cancel();
  if (asked && state && state->flow && is_of(*state->flow, *asked) && !is_previewed() &&
      session_.activity() == Activity::idle)
    wait_.start();
  expected_->setText(preview_text());
  show_flow();
}

bool FlowPanel::is_previewed() const {
  return previewed_ && previewed_ == session_.shown_state() &&
         previewed_with_ == session_.study().flow.value_or(StudyFlow{});
}

std::optional<FlowPreview> FlowPanel::preview() const {
  return is_previewed() ? preview_ : std::nullopt;
}

QString FlowPanel::preview_text() const {
  const auto state = session_.shown_state();
  if (!session_.study().flow) return {};
  const bool of_solver = session_.study().flow->field.has_value();
  if (!state || !state->flow || !is_of(*state->flow, *session_.study().flow))
    return of_solver ? tr("What the correction comes to is known once the field is on the mesh.")
                     : tr("Solve the flow to see what the correction comes to.");
  if (!is_previewed()) return tr("Counting…");
  if (!preview_) return no_preview_;
  return tr("About %L1 nodes instead of %L2, × %3.")
      .arg(preview_->nodes_after, 0, 'f', 0)
      .arg(preview_->nodes_before, 0, 'f', 0)
      .arg(written(preview_->nodes_after / preview_->nodes_before, 'f', 2));
}

void FlowPanel::count() {
  const auto state = session_.shown_state();
  const auto study = session_.study_value();
  if (!state || !state->flow || !study->flow || session_.activity() != Activity::idle) return;
  if (worker_.busy()) {  // with what was asked before
    worker_.cancel();
    wait_.start();
    return;
  }
  worker_.start([this, state, study](const Progress& progress) -> Worker::Done {
    const Result<FlowPreview> found = preview_flow(*state, *study, progress);
    return [this, state, study, found] {
      preview_ = found ? std::optional(*found) : std::nullopt;
      no_preview_ = found ? QString() : QString::fromStdString(found.error().message);
      if (!found && found.error().code == Code::cancelled) return;
      previewed_ = state;
      previewed_with_ = *study->flow;
    };
  });
}

QString FlowPanel::result_text() const {
  if (session_.activity() == Activity::flowing) return tr("Laying the field on the mesh…");
  const StudyField& asked = *session_.study().flow->field;
  const auto result = session_.result();
  QString html;
  const auto line = [&](const QString& what, const QString& value) {
    html += "<tr>" + cell(what, false) + cell(value, true) + "</tr>";
  };
  if (result) {
    const double extent = session_.extent();
    line(tr("nodes of the result"), QString("%L1").arg(result->content.mesh.node_count()));
    line(tr("extent of the result"), units::length(result->across * asked.source.unit));
    line(tr("extent of the bodies"), units::length(extent));
  }
  const auto state = session_.shown_state();
  const FlowFields* flow = state ? state->flow.get() : nullptr;
  const bool laid = flow && is_of(*flow, *session_.study().flow);
  if (laid) {
    const bool step = adds_gradient(session_.study().flow->method);
    line(step ? tr("change along an edge, mean") : tr("indicator, mean"),
         written(flow->mean_indicator(), 'g', 3));
    if (flow->outside > 0)
      line(tr("nodes beside the result"),
           tr("%L1, up to %2").arg(flow->outside).arg(units::length(flow->farthest, 3)));
    const int before = session_.shown() - 1;
    if (before >= 0)
      if (const auto& old = session_.iterations()[std::size_t(before)].state;
          old && old->flow && is_of(*old->flow, *session_.study().flow))
        line(tr("one iteration before"), written(old->flow->mean_indicator(), 'g', 3));
  }
  html = QString("<table cellspacing='0'>%1</table>").arg(html);
  if (!result)
    html += "<p>" + tr("The file is read when the mesh is run or the field is shown.") + "</p>";
  else if (!laid && !state)
    html += "<p>" + tr("Run: the mesh that has settled is then corrected by the field.") + "</p>";
  else if (!laid)
    html += "<p>" + tr("The field is not on this mesh.") + "</p>";
  return html;
}

void FlowPanel::show_flow() {
  const auto state = session_.shown_state();
  const FlowFields* flow = state ? state->flow.get() : nullptr;
  if (plotted_ != state) {
    plotted_ = state;
    Series series{tr("residual"), QColor(0x1d, 0x6f, 0xc4), {}};
    if (flow) series.values = flow->residuals;
    residuals_->set_series({series});
  }
  const bool of_solver = session_.study().flow && session_.study().flow->field;
  residuals_->setVisible(!of_solver);
  if (of_solver) return found_->setText(result_text());
  if (!flow || flow->components > 0) {
    found_->setText(
        session_.activity() == Activity::flowing ? tr("Solving… Shift+F5 cancels.")
        : !state ? tr("Make a gate and a vent of groups of faces, and run: the flow between them "
                      "is solved through the mesh.")
                 : tr("No flow is known through this mesh. It needs a group that is a gate and "
                      "one that is a vent."));
    return;
  }
  QString html =
      QString("<table cellspacing='0'><tr style='color:%1'>").arg(theme::soft_text.name());
  html += cell({}, false) + cell(tr("mm³/s"), true) + cell(tr("MPa"), true) + "</tr>";
  for (const OpeningFlow& o : flow->openings)
    html += "<tr>" +
            cell((o.rate < 0 ? tr("in by %1") : tr("out by %1"))
                     .arg(QString::fromStdString(o.group).toHtmlEscaped()),
                 false) +
            cell(written(std::abs(o.rate), 'g', 6), true) +
            cell(written(o.pressure, 'g', 4), true) + "</tr>";
  html += "</table>";
  if (!flow->residuals.empty())
    html += "<p>" +
            tr("%1 iterations; %2 of what enters is lost.")
                .arg(flow->residuals.size() - 1)
                .arg(written(flow->imbalance, 'g', 2)) +
            "</p>";
  found_->setText(html);
}

}  // namespace lamella::ui
