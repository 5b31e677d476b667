#include "ui/panels/convergence_panel.h"

#include <QCheckBox>
#include <QHBoxLayout>
#include <QLabel>
#include <QSlider>
#include <QToolButton>
#include <QVBoxLayout>
#include <algorithm>
#include <cmath>

#include "ui/panels/save_figures.h"
#include "ui/session/session.h"
#include "ui/theme.h"

namespace lamella::ui {
namespace {

const QColor blue(0x1d, 0x6f, 0xc4);

const QColor amber(0xd0, 0x87, 0x1e);

}  // namespace

ConvergencePanel::ConvergencePanel(Session& session, QWidget* parent)
    : QWidget(parent), session_(session) {
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(6, 6, 6, 8);
  layout->setSpacing(2);
  plots_ = new QWidget;
  auto* plots = new QHBoxLayout(plots_);
  plots->setContentsMargins(0, 0, 0, 0);
  plots->setSpacing(8);
  nodes_ = new Plot(tr("Nodes"));
  nodes_->setObjectName("nodes_plot");
  layers_ = new Plot(tr("Layers"));
  layers_->setToolTip(
      tr("Measured through the walls: the mean, and what 5 % of the wall area fall below"));
  layers_->set_decimals(2);
  conformity_ = new Plot(tr("Conformity"));
  conformity_->setToolTip(tr("How far elements are from what the metric asks, 0 is perfect"));
  conformity_->set_decimals(3);
  // The first mesh knows nothing of the metric: orders of magnitude lie between it and the rest.
  conformity_->set_logarithmic(true);
  quality_ = new Plot(tr("Worst quality"));
  quality_->setObjectName("quality_plot");
  quality_->setToolTip(tr("Of all elements by c(T), 1 is best"));
  quality_->set_decimals(3);
  error_ = new Plot(tr("Interface L2"));
  error_->setObjectName("error_plot");
  error_->setToolTip(
      tr("L2 error of the filling ratio, relative to the body: the largest of all bodies"));
  error_->set_decimals(4);
  error_->set_logarithmic(true);
  for (Plot* plot : all_plots()) {
    plots->addWidget(plot, 1);
    connect(plot, &Plot::clicked, &session, &Session::show_iteration);
    for (Plot* other : all_plots())
      if (other != plot) connect(plot, &Plot::hovered, other, &Plot::set_hovered);
  }
  layout->addWidget(plots_, 1);

  auto* row = new QHBoxLayout;
  row->setContentsMargins(12, 0, 14, 0);
  row->setSpacing(8);
  auto* text = new QLabel(tr("Iteration"));
  text->setObjectName("soft");
  row->addWidget(text);
  back_ = new QToolButton;
  back_->setIcon(icon("chevron-left"));
  back_->setToolTip(tr("Previous iteration"));
  row->addWidget(back_);
  slider_ = new QSlider(Qt::Horizontal);
  slider_->setObjectName("iteration_slider");
  slider_->setAccessibleName(tr("Iteration"));
  slider_->setPageStep(1);
  row->addWidget(slider_, 1);
  forward_ = new QToolButton;
  forward_->setIcon(icon("chevron-right"));
  forward_->setToolTip(tr("Next iteration"));
  row->addWidget(forward_);
  position_ = new QLabel;
  position_->setObjectName("soft");
  position_->setMinimumWidth(110);
  row->addWidget(position_);
  auto* logarithmic = new QCheckBox(tr("Logarithmic nodes"));
  row->addWidget(logarithmic);
  auto* table = new QToolButton;
  table->setIcon(icon("export"));
  table->setToolTip(tr("Save the figures of all iterations as a table or as a picture"));
  table->setAccessibleName(tr("Save figures"));
  row->addWidget(table);
  connect(table, &QToolButton::clicked, this,
          [this] { save(ask_figures_file(this, QString::fromStdString(session_.study().name))); });
  layout->addLayout(row);

  connect(logarithmic, &QCheckBox::toggled, nodes_, &Plot::set_logarithmic);
  connect(slider_, &QSlider::valueChanged, &session, &Session::show_iteration);
  connect(back_, &QToolButton::clicked, this,
          [this] { session_.show_iteration(std::max(0, session_.shown() - 1)); });
  connect(forward_, &QToolButton::clicked, this,
          [this] { session_.show_iteration(session_.shown() + 1); });
  connect(&session, &Session::iterations_changed, this, &ConvergencePanel::follow_iterations);
  connect(&session, &Session::selection_changed, this, &ConvergencePanel::follow_iterations);
  connect(&session, &Session::run_finished, this, &ConvergencePanel::follow_iterations);
  connect(&session, &Session::study_changed, this, [this] {
    if (session_.study().domain.has_value() == error_->isHidden()) follow_iterations();
  });
  connect(&session, &Session::shown_changed, this, &ConvergencePanel::follow_shown);
  follow_iterations();
}

std::vector<IterationRecord> ConvergencePanel::records() const {
  const auto& iterations = session_.iterations();
  // A project that was opened has its last mesh alone, and the records of all.
  if (const auto& outcome = session_.outcome(); outcome && iterations.size() == 1)
    return outcome->records;
  std::vector<IterationRecord> records;
  for (const Iteration& it : iterations) records.push_back(it.record);
  return records;
}

QString ConvergencePanel::csv() const {
  QString text =
      "iteration,nodes,elements,layers_mean,layers_p5,conformity,quality_min,quality_mean,"
      "unit_edges,seconds,mixed,interface_error\n";
  const auto number = [](double x) { return QString::number(x, 'g', 12); };
  for (const IterationRecord& r : records()) {
    text += QStringList{QString::number(r.iteration), QString::number(r.nodes),
                        QString::number(r.elements),  number(r.layers.mean),
                        number(r.layers.p5),          number(r.conformity),
                        number(r.quality_min),        number(r.quality_mean),
                        number(r.unit_edges),         number(r.seconds),
                        QString::number(r.mixed),     number(r.interface_error)}
                .join(',') +
            '\n';
  }
  return text;
}

void ConvergencePanel::save(const QString& file) {
  if (file.isEmpty()) return;
  session_.wrote(file, save_figures(file, csv(), *plots_));
}

void ConvergencePanel::follow_iterations() {
  Series nodes{tr("nodes"), blue, {}};
  Series mean{tr("mean"), blue, {}};
  Series low{tr("5 %"), amber, {}};
  Series conformity{tr("conformity"), blue, {}};
  Series quality{tr("worst quality"), blue, {}};
  Series mixed{tr("mixed"), amber, {}};
  Series error{tr("interface error"), blue, {}};
  for (const IterationRecord& r : records()) {
    const bool measured = r.layers.places > 0;
    nodes.values.push_back(static_cast<double>(r.nodes));
    mean.values.push_back(measured ? r.layers.mean : std::nan(""));
    low.values.push_back(measured ? r.layers.p5 : std::nan(""));
    conformity.values.push_back(r.conformity);
    quality.values.push_back(r.quality_min);
    // Without mixed elements every border lies on faces of the mesh.
    const bool fuzzy = r.mixed > 0;
    mixed.values.push_back(fuzzy ? static_cast<double>(r.mixed) : std::nan(""));
    error.values.push_back(fuzzy ? r.interface_error : std::nan(""));
  }
  const bool domain = session_.study().domain.has_value();
  nodes_->set_series(domain ? std::vector{nodes, mixed} : std::vector{nodes});
  conformity_->set_series({conformity});
  quality_->set_series({quality});
  error_->set_series({error});
  error_->setVisible(domain);
  show_layers(mean, low);
  follow_shown();
}

void ConvergencePanel::show_layers(Series mean, Series low) {
  const auto& bodies = session_.study().bodies;
  const int selected = session_.selected();
  std::optional<double> asked;
  QString title = tr("Layers");
  if (selected >= 0 && selected < static_cast<int>(bodies.size())) {
    const BodySettings& body = bodies[static_cast<std::size_t>(selected)];
    asked = body.layers;
    if (bodies.size() > 1) title = tr("Layers, all bodies");
    // Once the run is over each body has a record of its own; the last value of one that was done
    // early stands for the rest.
    const auto& outcome = session_.outcome();
    for (const BodyOutcome& made : outcome ? outcome->bodies : std::vector<BodyOutcome>{}) {
      if (made.name != body.name) continue;
      asked = made.layers_asked;
      // One mesh of all bodies has one record.
      if (bodies.size() < 2 || made.records.empty() || session_.study().domain) continue;
      title = tr("Layers, %1").arg(QString::fromStdString(made.name));
      for (std::size_t k = 0; k < mean.values.size(); ++k) {
        const LayerStats& stats = made.records[std::min(k, made.records.size() - 1)].layers;
        mean.values[k] = stats.places > 0 ? stats.mean : std::nan("");
        low.values[k] = stats.places > 0 ? stats.p5 : std::nan("");
      }
    }
  }
  // Five plots leave little room.
  if (session_.study().domain) title = tr("Layers");
  layers_->set_title(title);
  layers_->set_series({mean, low});
  layers_->set_target(session_.iterations().empty() ? std::nullopt : asked, tr("asked"));
}

void ConvergencePanel::follow_shown() {
  const int shown = session_.shown();
  const int last = static_cast<int>(session_.iterations().size()) - 1;
  const std::vector<IterationRecord> all = records();
  int marked = shown;
  if (shown >= 0 && all.size() != session_.iterations().size()) {
    const int iteration = session_.iterations()[static_cast<std::size_t>(shown)].record.iteration;
    const auto at = std::find_if(
        all.begin(), all.end(), [&](const IterationRecord& r) { return r.iteration == iteration; });
    marked = at == all.end() ? -1 : static_cast<int>(at - all.begin());
  }
  for (Plot* plot : all_plots()) plot->set_marked(marked);
  const QSignalBlocker block(slider_);
  slider_->setRange(0, std::max(0, static_cast<int>(all.size()) - 1));
  slider_->setEnabled(last > 0);
  slider_->setToolTip(last == 0 && all.size() > 1 ? tr("A project keeps the last mesh alone")
                                                  : QString());
  back_->setEnabled(shown > 0);
  forward_->setEnabled(shown < last);
  if (shown < 0) {
    position_->setText(tr("no mesh yet"));
    return;
  }
  slider_->setValue(marked);
  const IterationRecord& record = session_.iterations()[shown].record;
  QString text = !session_.has_bodies()  ? tr("opened mesh")
                 : record.iteration == 0 ? tr("0: first mesh")
                                         : QString::number(record.iteration);
  if (shown == last && last > 0) text += tr("  (latest)");
  position_->setText(text);
}

}  // namespace lamella::ui
