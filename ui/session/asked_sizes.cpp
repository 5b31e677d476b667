#include "ui/session/asked_sizes.h"

#include <algorithm>
#include <limits>

#include "core/base/parallel.h"
#include "core/sizing/sizing_field.h"
#include "ui/session/session.h"

namespace lamella::ui {

WallMap::Maps asked_sizes(const Session& session, const WallMap::Maps& walls) {
  WallMap::Maps maps(walls.size());
  for (std::size_t k = 0; k < walls.size(); ++k) {
    if (!walls[k]) continue;
    const int index = static_cast<int>(k);
    const BodySettings& body = session.body(index);
    const double low = body.h_min.value_or(session.automatic_size(index));
    const double high = std::max(low, body.h_max.value_or(std::numeric_limits<double>::infinity()));
    Result<SizingField> made =
        SizingField::make(sizing_of(session.study(), body.name), session.shapes()[k].surface);
    const SizingField field = made ? *made : SizingField();
    auto map = std::make_shared<ThicknessMap>(*walls[k]);
    parallel_each(map->points.size(), session.study().options.threads, {}, [&](std::size_t p) {
      double& value = map->thickness[p];
      const double natural = std::clamp(value / body.layers, low, high);
      value = field.empty()
                  ? natural
                  : sizes<3>(field.apply(map->points[p], isotropic_metric<3>(natural)))[0];
    });
    maps[k] = std::move(map);
  }
  return maps;
}

}  // namespace lamella::ui
