#include "ui/session/forecaster.h"

#include <algorithm>

#include "core/study/study_file.h"
#include "ui/session/session.h"

namespace lamella::ui {
namespace {

std::string relevant(Study study) {
  study.name.clear();
  study.cuts.clear();
  study.options.threads = 0;
  study.options.iterations = 1;
  study.options.until_settled = true;
  study.options.memory.reset();
  for (BodySettings& body : study.bodies) {
    body.visible = true;
    body.color.reset();
    body.role = BodyRole::none;
  }
  return study_to_json(study);
}

}  // namespace

Forecaster::Forecaster(Session& session) : QObject(&session), session_(session) {
  wait_.setSingleShot(true);
  wait_.setInterval(600);
  connect(&wait_, &QTimer::timeout, this, &Forecaster::start);
  connect(&session, &Session::parts_changed, this, [this] {
    asked_ = false;
    known_for_.clear();
    bodies_.reset();
    follow();
    Q_EMIT changed();
  });
  connect(&session, &Session::study_changed, this, &Forecaster::follow);
  connect(&session, &Session::activity_changed, this, [this] {
    // A run needs the processors.
    if (session_.activity() != Activity::idle) {
      wait_.stop();
      worker_.cancel();
    } else {
      follow();
    }
  });
  connect(&worker_, &Worker::finished, this, [this] {
    if (again_) wait_.start();
    again_ = false;
    Q_EMIT changed();
  });
}

void Forecaster::ask() {
  asked_ = true;
  known_for_.clear();
  start();
}

void Forecaster::follow() {
  if (!session_.services().forecast || session_.parts().empty()) return;
  // One mesh of all bodies is not forecast; sizes and a budget of memory want one without asking.
  const Study& study = session_.study();
  if (study.domain || (!asked_ && study.sizing.empty() && !study.options.memory)) {
    if (bodies_) {
      bodies_.reset();
      known_for_.clear();
      Q_EMIT changed();
    }
    return;
  }
  // What has just been meshed needs no guess.
  const bool meshed = !session_.iterations().empty() && !session_.outdated();
  if (meshed || session_.activity() != Activity::idle || relevant(session_.study()) == known_for_)
    return;
  wait_.start();
}

void Forecaster::start() {
  if (!session_.services().forecast || session_.parts().empty() || session_.study().domain ||
      session_.activity() != Activity::idle)
    return;
  if (worker_.busy()) {
    again_ = true;
    worker_.cancel();
    return;
  }
  const auto parts = session_.parts_value();
  const auto study = session_.study_value();
  if (parts_ != parts || seed_ != study->options.seed) first_ = nullptr;
  worker_.start([this, parts, study,
                 first = first_](const Progress& progress) mutable -> Worker::Done {
    const Services& services = session_.services();
    const auto forecast = [&]() -> Result<std::vector<BodyForecast>> {
      if (!first) {
        Result<std::vector<FirstMesh>> made =
            first_meshes(*parts, services.meshers(study->options.seed), progress.portion(0, 0.7));
        if (!made) return made.error();
        first = std::make_shared<const std::vector<FirstMesh>>(std::move(*made));
      }
      return services.forecast(*first, *study, *parts, progress.portion(0.7, 1));
    };
    Result<std::vector<BodyForecast>> result = forecast();
    return [this, result = std::move(result), parts, study, first]() mutable {
      if (first) {
        first_ = first;
        parts_ = parts;
        seed_ = study->options.seed;
      }
      if (!result && result.error().code == Code::cancelled) return;
      bodies_.reset();
      failure_.clear();
      if (result)
        bodies_ = std::move(*result);
      else
        failure_ = QString::fromStdString(result.error().message);
      known_for_ = relevant(*study);
    };
  });
  Q_EMIT changed();
}

MeshForecast Forecaster::total() const {
  MeshForecast all;
  if (!bodies_) return all;
  for (const BodyForecast& body : *bodies_) {
    const MeshForecast& mesh = body.flow ? body.flow->mesh : body.mesh.corrected;
    all.nodes += mesh.nodes;
    all.elements += mesh.elements;
    all.memory = std::max(all.memory, mesh.memory);
  }
  return all;
}

QString Forecaster::description() const {
  if (session_.study().domain) return tr("Not known for one mesh of all bodies.");
  if (worker_.busy()) return tr("Counting…");
  if (!failure_.isEmpty()) return failure_;
  if (!bodies_) return tr("Not known yet.");
  double natural = 0, corrected = 0;
  int solves = 0;
  bool flows = false;
  for (const BodyForecast& body : *bodies_) {
    natural += body.mesh.natural.nodes;
    corrected += body.mesh.corrected.nodes;
    if (body.flow) solves += body.flow->solves;
    flows = flows || body.flow;
  }
  const MeshForecast all = total();
  const QString form =
      flows ? tr("At most about %L1 nodes and %L2 elements; meshing takes about %L3 MB.")
            : tr("About %L1 nodes and %L2 elements; meshing takes about %L3 MB.");
  QString text =
      form.arg(all.nodes, 0, 'f', 0).arg(all.elements, 0, 'f', 0).arg(all.memory, 0, 'f', 0);
  if (solves > 0)
    text += " " + tr("The flow is solved %1 times; before it: %L2 nodes.")
                      .arg(solves)
                      .arg(corrected, 0, 'f', 0);
  if (flows && solves == 0)
    text += " " +
            tr("Before the correction by the solver's field: %L1 nodes.").arg(corrected, 0, 'f', 0);
  if (std::abs(corrected - natural) > 0.5)
    text += " " + tr("Without the sizes: %L1 nodes.").arg(natural, 0, 'f', 0);
  return text;
}

}  // namespace lamella::ui
