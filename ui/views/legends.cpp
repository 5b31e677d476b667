#include "ui/views/legends.h"

#include <QCoreApplication>
#include <algorithm>

#include "ui/views/mesh_data.h"

namespace lamella::ui {
namespace {

struct Texts {
  Q_DECLARE_TR_FUNCTIONS(lamella::ui::Legends)
};

QString flow_title(ColorBy field, const MeshState* state = nullptr) {
  const bool of_solver = state && state->flow && state->flow->components > 0;
  if (of_solver && (field == ColorBy::field || field == ColorBy::speed)) {
    const QString name = QString::fromStdString(state->flow->field);
    return state->flow->components == 1 ? name : QString("|%1|").arg(name);
  }
  if (field == ColorBy::field) return Texts::tr("Solver's field");
  if (of_solver) return Texts::tr("Indicator");
  return field == ColorBy::speed      ? Texts::tr("Velocity, mm/s")
         : field == ColorBy::pressure ? Texts::tr("Pressure, MPa")
         : field == ColorBy::shear    ? Texts::tr("Shear rate, 1/s")
                                      : Texts::tr("Flow indicator");
}

}  // namespace

Legend thickness_legend(std::vector<double> values) {
  const auto [low, high] = robust_range(std::move(values));
  Legend legend{Texts::tr("Wall thickness"), low, high, sequential_map()};
  legend.is_length = true;
  return legend;
}

Legend size_legend(std::vector<double> values) {
  // The smallest ones are few, and what it is about.
  const auto low = std::min_element(values.begin(), values.end());
  const double least = low == values.end() ? 0 : *low;
  Legend legend = thickness_legend(std::move(values));
  legend.low = std::min(legend.low, least);
  legend.title = Texts::tr("Smallest size asked");
  return legend;
}

Legend field_legend(ColorBy field, const MeshState& state, int layers_asked,
                    const std::string& body) {
  Legend legend;
  switch (field) {
    case ColorBy::body:
      break;
    case ColorBy::quality:
      legend = {Texts::tr("Quality c(T)"), 0, 1, rating_map()};
      break;
    case ColorBy::thickness: {
      const auto& t = state.thickness;
      legend = thickness_legend({t.begin() + 1, t.end()});
      break;
    }
    case ColorBy::size:
      legend = size_legend(field_values(state, field));
      break;
    case ColorBy::layers: {
      // One band a layer, the one of n layers being the first good one.
      const int n = layers_asked;
      legend = {Texts::tr("Layers through the wall, %1 asked").arg(n), 0, 2.0 * n, rating_map()};
      legend.map.bands = std::min(2 * n, 24);
      legend.missing = Texts::tr("no wall to count in");
      break;
    }
    case ColorBy::filling:
      legend = {Texts::tr("Filled by %1").arg(QString::fromStdString(body)), 0, 1, filling_map()};
      legend.bands = {Texts::tr("0 %"), Texts::tr("< 50 %"), Texts::tr("≥ 50 %"),
                      Texts::tr("100 %")};
      break;
    case ColorBy::speed:
    case ColorBy::pressure:
    case ColorBy::shear:
    case ColorBy::indicator:
    case ColorBy::field: {
      const auto [low, high] = robust_range(field_values(state, field));
      legend = {flow_title(field, &state), low, high, sequential_map()};
      break;
    }
  }
  return legend;
}

Legend missing_legend(ColorBy field, bool meshed) {
  Legend legend;
  legend.title = of_flow(field)                ? flow_title(field)
                 : field == ColorBy::quality   ? Texts::tr("Quality c(T)")
                 : field == ColorBy::thickness ? Texts::tr("Wall thickness")
                 : field == ColorBy::size      ? Texts::tr("Smallest size asked")
                 : field == ColorBy::layers    ? Texts::tr("Layers through the wall")
                                               : Texts::tr("Filling ratio");
  legend.missing = !meshed ? Texts::tr("known once the part is meshed")
                   : field == ColorBy::field
                       ? Texts::tr("known once another solver's result is read")
                   : of_flow(field)            ? Texts::tr("known once the flow is solved")
                   : field == ColorBy::filling ? Texts::tr("this mesh has no fuzzy interfaces")
                                               : Texts::tr("not in this mesh");
  return legend;
}

}  // namespace lamella::ui
