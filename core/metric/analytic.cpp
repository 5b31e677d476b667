#include "core/metric/analytic.h"

#include <algorithm>
#include <charconv>
#include <map>
#include <optional>

namespace lamella {
namespace {

/// lambda u u^T, the part of a metric along the unit vector u with the size h.
template <int D>
Mat<D> along(const Vec<D>& u, double h) {
  return eigenvalue_from_size(h) * u * u.transpose();
}

/// h_r along the unit vector u, h_t across it.
Metric<2> radial(const Vec<2>& u, double h_r, double h_t) {
  return along<2>(u, h_r) + along<2>(Vec<2>(-u[1], u[0]), h_t);
}

Metric<3> diagonal(double hx, double hy, double hz) {
  return Vec<3>(eigenvalue_from_size(hx), eigenvalue_from_size(hy), eigenvalue_from_size(hz))
      .asDiagonal();
}

/// Size that grows linearly from h0 on the plane t = 0.5 to h at a distance of 0.5 from it.
double sheet(double h0, double t, double h = 0.1) {
  return h0 + (h - h0) * std::abs(t - 0.5) / 0.5;
}

/// Size along one side of George and Borouchaki's rectangle: from 1 down to 0.05 at t = 2, up by a
/// factor of 20 until `middle`, down by a factor of 5 until `end`, then back to 1 over 2.
double borouchaki(double t, double middle, double end) {
  if (t <= 2) return 1 - 0.95 * t / 2;
  if (t <= middle) return 0.05 * std::pow(20.0, (t - 2) / (middle - 2));
  if (t <= end) return std::pow(0.2, (t - middle) / (end - middle));
  return 0.2 + 0.8 * std::pow((t - end) / 2, 4);
}
double borouchaki_x(double x) { return borouchaki(x, 3.5, 5); }
double borouchaki_y(double y) { return borouchaki(y, 4.5, 7); }

using Values = std::map<std::string, double, std::less<>>;
using Function3 = MetricFunction<3>;

template <int D>
struct Named {
  Values defaults;
  MetricFunction<D> (*make)(const Values&);
};
template <int D>
using Table = std::vector<std::pair<std::string, Named<D>>>;

/// polar-1 and polar-2: a cylinder around z whose sizes depend on the radius.
Function3 polar(double h0, bool refine_around) {
  return [=](const Vec<3>& x) {
    const double r = std::hypot(x[0], x[1]);
    double h_t = 0.1;
    if (refine_around) {
      const double near = std::clamp(1 - 10 * std::abs(r - 0.5), 0.0, 1.0);
      h_t = 0.025 * near + 0.1 * (1 - near);
    }
    const Vec<2> u = r > 0 ? Vec<2>(x[0] / r, x[1] / r) : Vec<2>(1, 0);
    Metric<3> m = diagonal(0.1, 0.1, 0.1);
    m.topLeftCorner<2, 2>() = radial(u, sheet(h0, r), h_t);
    return m;
  };
}

Function3 thinbox(const Values& v, bool isotropic) {
  const double s = v.at("s"), h_t = v.at("ht");
  return [=](const Vec<3>& x) {
    const double hy = borouchaki_x(7 * x[1]) / s, hz = borouchaki_y(9 * x[2]) / s;
    return isotropic ? isotropic_metric<3>(std::min({h_t, hy, hz})) : diagonal(h_t, hy, hz);
  };
}

/// The metrics of 3D, and of 2D as their block of x and y.
const Table<3>& table3() {
  static const Table<3> all = {
      {"uniform",
       {{{"h", 0.1}},
        [](const Values& v) -> Function3 {
          return [m = isotropic_metric<3>(v.at("h"))](const Vec<3>&) { return m; };
        }}},
      {"constaniso",
       {{{"hx", 0.1}, {"hy", 0.1}, {"hz", 0.1}},
        [](const Values& v) -> Function3 {
          return [m = diagonal(v.at("hx"), v.at("hy"), v.at("hz"))](const Vec<3>&) { return m; };
        }}},
      {"linear",
       {{{"h0", 0.001}},
        [](const Values& v) -> Function3 {
          return [h0 = v.at("h0")](const Vec<3>& x) { return diagonal(0.1, 0.1, sheet(h0, x[2])); };
        }}},
      {"polar-1", {{{"h0", 0.001}}, [](const Values& v) { return polar(v.at("h0"), false); }}},
      {"polar-2", {{{"h0", 0.001}}, [](const Values& v) { return polar(v.at("h0"), true); }}},
      {"gb2d",
       {{},
        [](const Values&) -> Function3 {
          return
              [](const Vec<3>& x) { return diagonal(borouchaki_x(x[0]), borouchaki_y(x[1]), 1); };
        }}},
      {"gb2d-iso",
       {{},
        [](const Values&) -> Function3 {
          return [](const Vec<3>& x) {
            return isotropic_metric<3>(std::min(borouchaki_x(x[0]), borouchaki_y(x[1])));
          };
        }}},
      {"thinbox", {{{"ht", 0.05}, {"s", 10}}, [](const Values& v) { return thinbox(v, false); }}},
      {"thinbox-iso",
       {{{"ht", 0.05}, {"s", 10}}, [](const Values& v) { return thinbox(v, true); }}},
  };
  return all;
}

Metric<4> diagonal(double hx, double hy, double hz, double ht) {
  return Vec<4>(eigenvalue_from_size(hx), eigenvalue_from_size(hy), eigenvalue_from_size(hz),
                eigenvalue_from_size(ht))
      .asDiagonal();
}

/// The metrics of space-time, x_3 = t.
const Table<4>& table4() {
  static const Table<4> all = {
      {"uniform",
       {{{"h", 0.1}},
        [](const Values& v) -> MetricFunction<4> {
          return [m = isotropic_metric<4>(v.at("h"))](const Vec<4>&) { return m; };
        }}},
      {"constaniso",
       {{{"hx", 0.1}, {"hy", 0.1}, {"hz", 0.1}, {"ht", 0.1}},
        [](const Values& v) -> MetricFunction<4> {
          return [m = diagonal(v.at("hx"), v.at("hy"), v.at("hz"), v.at("ht"))](const Vec<4>&) {
            return m;
          };
        }}},
      {"tesseract-linear",
       {{{"h0", 0.0025}},
        [](const Values& v) -> MetricFunction<4> {
          return [h0 = v.at("h0")](const Vec<4>& x) {
            return diagonal(0.25, 0.25, 0.25, sheet(h0, x[3], 0.25));
          };
        }}},
  };
  return all;
}

template <int D>
std::vector<std::string> names_of(const Table<D>& table) {
  std::vector<std::string> names;
  for (const auto& entry : table) names.push_back(entry.first);
  return names;
}

template <class Names>
std::string listed(const Names& names) {
  std::string text;
  for (const auto& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

/// Puts "key=value" into the values; an error tells the keys that exist.
std::optional<Error> set_value(std::string_view name, std::string_view item, Values& values) {
  const std::size_t equals = item.find('=');
  const auto it = values.find(item.substr(0, equals));
  if (it == values.end()) {
    std::vector<std::string> keys;
    for (const auto& [key, value] : values) keys.push_back(key);
    return Error{Code::usage,
                 "The metric " + std::string(name) + " has no parameter '" +
                     std::string(item.substr(0, equals)) + "'.",
                 keys.empty() ? "It has none." : "It has: " + listed(keys) + "."};
  }
  const std::string_view digits =
      equals == std::string_view::npos ? std::string_view{} : item.substr(equals + 1);
  double value = 0;
  const auto end = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (end.ec != std::errc{} || end.ptr != digits.data() + digits.size() || !(value > 0) ||
      !std::isfinite(value))
    return Error{Code::usage,
                 "The parameter '" + std::string(item) + "' of the metric " + std::string(name) +
                     " is not a positive number.",
                 "Write it as NAME:key=value, for example uniform:h=0.5."};
  it->second = value;
  return {};
}

template <int D>
Result<MetricFunction<D>> parse(std::string_view specification, const Table<D>& table,
                                const std::string& dimension) {
  const std::size_t colon = specification.find(':');
  const std::string_view name = specification.substr(0, colon);
  const auto it = std::find_if(table.begin(), table.end(),
                               [&](const auto& entry) { return entry.first == name; });
  if (it == table.end())
    return Error{Code::usage,
                 "There is no metric called '" + std::string(name) + "' in " + dimension + ".",
                 "Known metrics in " + dimension + ": " + listed(names_of(table)) + "."};
  Values values = it->second.defaults;
  if (colon != std::string_view::npos) {
    std::string_view rest = specification.substr(colon + 1);
    for (bool more = true; more;) {
      const std::size_t comma = rest.find(',');
      if (auto error = set_value(name, rest.substr(0, comma), values)) return *error;
      more = comma != std::string_view::npos;
      if (more) rest.remove_prefix(comma + 1);
    }
  }
  return it->second.make(values);
}

}  // namespace

template <int D>
MetricFunction<D> cartesian_metric(const Mat<D>& axes, const Vec<D>& h) {
  return [m = metric_from_sizes<D>(axes, h)](const Vec<D>&) { return m; };
}

MetricFunction<2> polar_metric(const Vec<2>& origin, double h_r, double h_theta) {
  return [=](const Vec<2>& x) -> Metric<2> {
    const Vec<2> d = x - origin;
    const double r = d.norm();
    if (!(r > 0)) return isotropic_metric<2>(h_r);
    return radial(d / r, h_r, h_theta);
  };
}

Metric<3> cylindrical_metric_at(const Vec<3>& d, const Vec<3>& axis, const Vec<3>& h) {
  const Vec<3> across = d - axis * axis.dot(d);
  const double r = across.norm();
  if (!(r > 0))
    return along<3>(axis, h[2]) +
           eigenvalue_from_size(h[0]) * (Mat<3>::Identity() - axis * axis.transpose());
  const Vec<3> e_r = across / r;
  return along<3>(e_r, h[0]) + along<3>(axis.cross(e_r), h[1]) + along<3>(axis, h[2]);
}

Metric<3> spherical_metric_at(const Vec<3>& d, const Vec<3>& axis, const Vec<3>& h) {
  const double r = d.norm();
  if (!(r > 0)) return isotropic_metric<3>(h[0]);
  const Vec<3> e_r = d / r, around = axis.cross(d);
  const double ground = around.norm();
  if (!(ground > 0))
    return along<3>(e_r, h[0]) +
           eigenvalue_from_size(h[2]) * (Mat<3>::Identity() - e_r * e_r.transpose());
  // The printed (A.22) divides the third column by ground^2; the unit vector is e_r x e_theta.
  const Vec<3> e_theta = around / ground;
  return along<3>(e_r, h[0]) + along<3>(e_theta, h[1]) + along<3>(e_r.cross(e_theta), h[2]);
}

MetricFunction<3> cylindrical_metric(const Vec<3>& origin, const Vec<3>& axis, double h_r,
                                     double h_theta, double h_z) {
  return [=, w = axis.normalized().eval()](const Vec<3>& x) -> Metric<3> {
    return cylindrical_metric_at(x - origin, w, {h_r, h_theta, h_z});
  };
}

MetricFunction<3> spherical_metric(const Vec<3>& origin, double h_r, double h_theta, double h_phi) {
  return [=](const Vec<3>& x) -> Metric<3> {
    return spherical_metric_at(x - origin, Vec<3>::UnitZ(), {h_r, h_theta, h_phi});
  };
}

template <int D>
Result<MetricFunction<D>> named_metric(std::string_view specification) {
  if constexpr (D == 4) {
    return parse(specification, table4(), "4D");
  } else if constexpr (D == 3) {
    return parse(specification, table3(), "3D");
  } else {
    auto parsed = parse(specification, table3(), "2D");
    if (!parsed) return parsed.error();
    return MetricFunction<2>([f = std::move(*parsed)](const Vec<2>& x) -> Metric<2> {
      return f(Vec<3>(x[0], x[1], 0)).topLeftCorner<2, 2>();
    });
  }
}

const std::vector<std::string>& metric_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all = names_of(table3());
    for (const std::string& name : names_of(table4()))
      if (std::find(all.begin(), all.end(), name) == all.end()) all.push_back(name);
    return all;
  }();
  return names;
}

template <int D>
MetricField<D> sample_metric(const MetricFunction<D>& metric, const std::vector<Vec<D>>& points) {
  MetricField<D> field(points.size(), Metric<D>::Identity());
  for (std::size_t i = 1; i < points.size(); ++i) field[i] = metric(points[i]);
  return field;
}

template MetricFunction<2> cartesian_metric<2>(const Mat<2>&, const Vec<2>&);
template MetricFunction<3> cartesian_metric<3>(const Mat<3>&, const Vec<3>&);
template MetricFunction<4> cartesian_metric<4>(const Mat<4>&, const Vec<4>&);
template Result<MetricFunction<2>> named_metric<2>(std::string_view);
template Result<MetricFunction<3>> named_metric<3>(std::string_view);
template Result<MetricFunction<4>> named_metric<4>(std::string_view);
template MetricField<2> sample_metric<2>(const MetricFunction<2>&, const std::vector<Vec<2>>&);
template MetricField<3> sample_metric<3>(const MetricFunction<3>&, const std::vector<Vec<3>>&);
template MetricField<4> sample_metric<4>(const MetricFunction<4>&, const std::vector<Vec<4>>&);

}  // namespace lamella
