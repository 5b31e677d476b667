#include "ui/views/legends.h"

#include <QCoreApplication>
#include <algorithm>

#include "ui/views/mesh_data.h"

namespace lamella::ui {
namespace {

QString tr(const char* text) { return QCoreApplication::translate("Scene", text); }

QString flow_title(ColorBy field) {
  return field == ColorBy::speed      ? tr("Velocity, mm/s")
         : field == ColorBy::pressure ? tr("Pressure, MPa")
         : field == ColorBy::shear    ? tr("Shear rate, 1/s")
                                      : tr("Flow indicator");
}

}  // namespace

Legend field_legend(ColorBy field, const MeshState& state, int layers_asked,
                    const std::string& body) {
  Legend legend;
  switch (field) {
    case ColorBy::body:
      break;
    case ColorBy::quality:
      legend = {tr("Quality c(T)"), 0, 1, rating_map()};
      break;
    case ColorBy::thickness: {
      const auto& t = state.thickness;
      const auto [low, high] = robust_range({t.begin() + 1, t.end()});
      legend = {tr("Wall thickness, mm"), low, high, sequential_map()};
      break;
    }
    case ColorBy::layers: {
      // One band a layer, the one of n layers being the first good one.
      const int n = layers_asked;
      legend = {tr("Layers through the wall, %1 asked").arg(n), 0, 2.0 * n, rating_map()};
      legend.map.bands = std::min(2 * n, 24);
      legend.missing = tr("no wall to count in");
      break;
    }
    case ColorBy::filling:
      legend = {tr("Filled by %1").arg(QString::fromStdString(body)), 0, 1, filling_map()};
      legend.bands = {tr("0 %"), tr("< 50 %"), tr("≥ 50 %"), tr("100 %")};
      break;
    case ColorBy::speed:
    case ColorBy::pressure:
    case ColorBy::shear:
    case ColorBy::indicator: {
      const auto [low, high] = robust_range(field_values(state, field));
      legend = {flow_title(field), low, high, sequential_map()};
      break;
    }
  }
  return legend;
}

Legend missing_legend(ColorBy field, bool meshed) {
  Legend legend;
  legend.title = of_flow(field)                ? flow_title(field)
                 : field == ColorBy::quality   ? tr("Quality c(T)")
                 : field == ColorBy::thickness ? tr("Wall thickness")
                 : field == ColorBy::layers    ? tr("Layers through the wall")
                                               : tr("Filling ratio");
  legend.missing = !meshed                     ? tr("known once the part is meshed")
                   : of_flow(field)            ? tr("known once the flow is solved")
                   : field == ColorBy::filling ? tr("this mesh has no fuzzy interfaces")
                                               : tr("not in this mesh");
  return legend;
}

}  // namespace lamella::ui
