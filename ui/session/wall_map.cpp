#include "ui/session/wall_map.h"

#include "ui/session/session.h"

namespace lamella::ui {

WallMap::WallMap(Session& session) : session_(session) {
  connect(&session, &Session::parts_changed, this, &WallMap::follow);
  connect(&session, &Session::surfaces_changed, this, &WallMap::follow);
  connect(&session, &Session::activity_changed, this, &WallMap::follow);
  connect(&worker_, &Worker::progressed, this, [this](double fraction, const QString&) {
    percent_ = static_cast<int>(100 * fraction);
    Q_EMIT changed();
  });
  connect(&worker_, &Worker::finished, this, [this] {
    follow();
    Q_EMIT changed();
  });
}

void WallMap::want(bool on) {
  if (on == wanted_) return;
  wanted_ = on;
  stopped_ = false;
  follow();
}

void WallMap::stop() {
  if (!worker_.busy()) return;
  stopped_ = true;
  worker_.cancel();
}

void WallMap::follow() {
  const auto shapes = session_.shapes_value();
  if (known_for_ && known_for_ != shapes) {
    known_for_ = nullptr;
    maps_.clear();
    failure_.clear();
    Q_EMIT changed();
  }
  if (measured_ && measured_ != shapes) stopped_ = false;
  // A run needs the processors.
  const bool free =
      session_.activity() == Activity::idle || session_.activity() == Activity::exporting;
  const bool due = wanted_ && !stopped_ && free && !known_for_ && !shapes->empty() &&
                   session_.services().thickness_map;
  if (worker_.busy()) {
    if (!due || measured_ != shapes) worker_.cancel();
    return;
  }
  if (!due) return;
  percent_ = 0;
  measured_ = shapes;
  worker_.start([this, shapes](const Progress& progress) -> Worker::Done {
    Maps maps(shapes->size());
    std::size_t all = 0, before = 0;
    for (const Part& part : *shapes) all += part.surface.facets.size();
    std::optional<Error> error;
    for (std::size_t k = 0; k < shapes->size() && !error; ++k) {
      const ReferenceSurface<3>& surface = (*shapes)[k].surface;
      const std::size_t after = before + surface.facets.size();
      if (surface.facets.empty()) continue;
      const auto share = [&](std::size_t facets) {
        return static_cast<double>(facets) / static_cast<double>(all);
      };
      Result<ThicknessMap> map =
          session_.services().thickness_map(surface, progress.portion(share(before), share(after)));
      before = after;
      if (map)
        maps[k] = std::make_shared<const ThicknessMap>(std::move(*map));
      else
        error = map.error();
    }
    return [this, shapes, maps = std::move(maps), error]() mutable {
      if (shapes != session_.shapes_value()) return;
      if (error && error->code == Code::cancelled) return;
      known_for_ = shapes;
      if (error)
        failure_ = QString::fromStdString(error->message);
      else
        maps_ = std::move(maps);
    };
  });
  Q_EMIT changed();
}

QString WallMap::status() const {
  if (!failure_.isEmpty()) return failure_;
  if (worker_.busy()) return tr("measuring… %1 %, Esc stops").arg(percent_);
  if (stopped_) return tr("stopped; choose it again to measure");
  if (wanted_ && maps_.empty() && session_.activity() == Activity::running)
    return tr("measured after the run");
  return {};
}

}  // namespace lamella::ui
