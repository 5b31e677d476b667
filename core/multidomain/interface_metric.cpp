#include "core/multidomain/interface_metric.h"

#include <algorithm>
#include <span>
#include <tuple>

#include "core/base/parallel.h"
#include "core/mesh/adjacency.h"
#include "core/metric/intersect.h"

namespace lamella {

namespace {

/// Calls visit(region, ratio in a, ratio in b) for every region of one of the two.
template <class Visit>
void for_each_region(std::span<const Share> a, std::span<const Share> b, Visit visit) {
  std::size_t i = 0, j = 0;
  while (i < a.size() || j < b.size()) {
    if (j == b.size() || (i < a.size() && a[i].region < b[j].region)) {
      visit(a[i].region, static_cast<double>(a[i].ratio), 0.0);
      ++i;
    } else if (i == a.size() || b[j].region < a[i].region) {
      visit(b[j].region, 0.0, static_cast<double>(b[j].ratio));
      ++j;
    } else {
      visit(a[i].region, static_cast<double>(a[i].ratio), static_cast<double>(b[j].ratio));
      ++i;
      ++j;
    }
  }
}

template <int D>
Mat<D> outer(const Vec<D>& v) {
  return v * v.transpose();
}

/// The intersection (A.1.3.2) of a metric with v v^T, which asks for the size 1/|v| along v alone.
template <int D>
void intersect_with(const Vec<D>& v, Metric<D>& m) {
  const double ratio = v.dot(m.llt().solve(v));
  if (ratio > 1) m += (1 - 1 / ratio) * outer<D>(v);
}

/// What a border with unit normal n at x asks along itself: an element of the size h across does
/// not bend out of the border, which takes a size of sqrt(8 s h / kappa) where it is curved by
/// kappa, with the sagitta s h. The curvature is that over the length of an element.
template <int D>
void follow_border(const Zone<D>& zone, const Vec<D>& x, const ZoneDistance<D>& border,
                   const Metric<D>& natural, double least, double slope, double h,
                   Metric<D>& metric) {
  constexpr double sagitta = 1;   // of the size across
  constexpr double kSharp = 0.8;  // cosine between faces at an edge
  const Vec<D>& n = border.normal;
  const Vec<D> foot = x + border.distance * n;
  const Vec<D> outward = zone.at(foot - 1e-3 * least * n).distance < 0 ? n : Vec<D>(-n);
  Mat<D> tangents = Mat<D>::Identity();
  if constexpr (D == 2) {
    tangents.col(0) = Vec<D>(-n[1], n[0]);
  } else {
    tangents.col(0) = n.unitOrthogonal();
    tangents.col(1) = n.cross(Vec<D>(tangents.col(0)));
  }
  Mat<D> bent = Mat<D>::Zero();
  for (int j = 0; j + 1 < D; ++j) {
    const Vec<D> t = tangents.col(j);
    double step = 0.5 / std::sqrt(t.dot(natural * t));
    for (int round = 0; round < 2; ++round) {
      const std::array<Vec<D>, 2> beside{foot + step * t, foot - step * t};
      const std::array<ZoneDistance<D>, 2> at{zone.at(beside[0]), zone.at(beside[1])};
      for (int side = 0; side < 2; ++side) {
        if (at[side].normal.dot(outward) > kSharp) continue;
        // Beyond an edge the other face is a border too, as far as the edge is.
        const Vec<D> corner = beside[side] - at[side].distance * at[side].normal;
        const double away = std::abs(t.dot(corner - x));
        intersect_with<D>(t / (3 * least + 3 * slope * away), metric);
      }
      bent.col(j) = (at[0].normal - at[1].normal) / (2 * step);
      const double size = std::sqrt(8 * sagitta * h / std::max(bent.col(j).norm(), 1e-300));
      if (size > step) break;
      step = std::max(h, size / 2);
    }
  }
  Eigen::Matrix<double, D - 1, D - 1> shape =
      (tangents.transpose() * bent).template topLeftCorner<D - 1, D - 1>();
  shape = (0.5 * (shape + shape.transpose())).eval();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, D - 1, D - 1>> solver(shape);
  for (int a = 0; a + 1 < D; ++a) {
    const Vec<D> along = tangents.template leftCols<D - 1>() * solver.eigenvectors().col(a);
    intersect_with<D>(std::sqrt(std::abs(solver.eigenvalues()[a]) / (8 * sagitta * h)) * along,
                      metric);
  }
}

/// Eigenvalues above `largest` lowered to it.
template <int D>
Metric<D> clipped(const Metric<D>& m, double largest) {
  Spectrum<D> s = spectrum<D>(m);
  if (s.values[D - 1] <= largest) return m;
  s.values = s.values.cwiseMin(largest);
  return s.vectors * s.values.asDiagonal() * s.vectors.transpose();
}

/// Items of keys in [0, count), grouped: those of key k at [first[k], first[k + 1]).
std::vector<std::uint32_t> starts(std::size_t count, const std::vector<std::uint32_t>& sizes) {
  std::vector<std::uint32_t> first(count + 1, 0);
  for (std::size_t k = 0; k < count; ++k) first[k + 1] = first[k] + sizes[k];
  return first;
}

}  // namespace

template <int D>
std::vector<FillingGradient<D>> filling_gradients(const SimplexMesh<D>& mesh,
                                                  const Filling& filling,
                                                  const std::vector<std::int32_t>& jump) {
  std::vector<FillingGradient<D>> terms;
  const auto shares = [&](std::int32_t e) {
    return std::span(filling.shares)
        .subspan(filling.first[e], filling.first[e + 1] - filling.first[e]);
  };
  const auto measure = [&](std::int32_t e) {
    return signed_measure<D>(mesh.corners(mesh.elements[e]));
  };
  // facet_normal has (D-1)! times the measure of the facet.
  const auto normal = [&](const FaceUse<D>& use) -> Vec<D> {
    return facet_normal<D>(mesh.corners(opposite_facet<D>(mesh.elements[use.element], use.local))) /
           factorial(D - 1);
  };
  const auto uses = face_uses<D>(mesh.elements, mesh.points.size());
  for_each_face<D>(uses, [&](std::size_t first, std::size_t last) {
    if (last - first != 2) return;
    const std::int32_t a = uses[first].element, b = uses[first + 1].element;
    if (!filling.mixed(a) && !filling.mixed(b) &&
        shares(a).front().region == shares(b).front().region)
      return;
    const Vec<D> n = normal(uses[first]) / (measure(a) + measure(b));
    // The jump and the normal both change sign with the side: each element gets the same.
    for_each_region(shares(a), shares(b), [&](std::int32_t region, double ga, double gb) {
      if (ga == gb) return;
      terms.push_back({a, region, (gb - ga) * n});
      terms.push_back({b, region, (gb - ga) * n});
    });
  });
  if (!jump.empty()) {
    std::vector<typename SimplexMesh<D>::Facet> jumping;
    for (std::size_t f = 0; f < mesh.facets.size(); ++f)
      if (std::count(jump.begin(), jump.end(), mesh.facet_group[f]) > 0) {
        jumping.push_back(mesh.facets[f]);
        std::sort(jumping.back().begin(), jumping.back().end());
      }
    std::sort(jumping.begin(), jumping.end());
    for_each_face<D>(uses, [&](std::size_t first, std::size_t last) {
      if (last - first != 1 ||
          !std::binary_search(jumping.begin(), jumping.end(), uses[first].nodes))
        return;
      const std::int32_t a = uses[first].element;
      const Vec<D> n = normal(uses[first]) / measure(a);
      for (const Share& share : shares(a))
        terms.push_back({a, share.region, -static_cast<double>(share.ratio) * n});
    });
  }
  std::stable_sort(terms.begin(), terms.end(), [](const auto& a, const auto& b) {
    return std::tie(a.element, a.region) < std::tie(b.element, b.region);
  });
  std::size_t kept = 0;
  for (std::size_t i = 0; i < terms.size(); ++i) {
    if (kept > 0 && terms[kept - 1].element == terms[i].element &&
        terms[kept - 1].region == terms[i].region)
      terms[kept - 1].gradient += terms[i].gradient;
    else
      terms[kept++] = terms[i];
  }
  terms.resize(kept);
  return terms;
}

template <int D>
Result<MetricField<D>> interface_metric(const SimplexMesh<D>& mesh, const Filling& filling,
                                        const MetricField<D>& natural,
                                        const InterfaceParams& params, const Progress& progress) {
  if (params.h_min.size() != static_cast<std::size_t>(filling.regions) ||
      std::any_of(params.h_min.begin(), params.h_min.end(), [](double h) { return !(h > 0); }))
    return Error{Code::usage, "Interfaces need one positive size for each region.",
                 "Set the interface size of every body, in mm."};
  const std::vector<FillingGradient<D>> gradients =
      filling_gradients<D>(mesh, filling, params.jump);
  std::vector<std::uint32_t> sizes(mesh.elements.size(), 0);
  for (const auto& g : gradients) ++sizes[g.element];
  const std::vector<std::uint32_t> of_element = starts(sizes.size(), sizes);
  sizes.assign(mesh.points.size(), 0);
  for (const auto& e : mesh.elements)
    for (const NodeId n : e) ++sizes[n];
  const std::vector<std::uint32_t> of_node = starts(sizes.size(), sizes);
  std::vector<std::int32_t> elements(of_node.back());
  std::vector<std::uint32_t> next(of_node.begin(), of_node.end() - 1);
  for (std::size_t e = 0; e < mesh.elements.size(); ++e)
    for (const NodeId n : mesh.elements[e]) elements[next[n]++] = static_cast<std::int32_t>(e);

  MetricField<D> metric = natural;
  const double step = std::pow(2.0, -(params.round + 1));
  const auto capture = [&](std::size_t n) {
    thread_local std::vector<FillingGradient<D>> at;  // one a region
    at.clear();
    double volume = 0;
    for (std::uint32_t i = of_node[n]; i < of_node[n + 1]; ++i) {
      const std::int32_t e = elements[i];
      const double measure = signed_measure<D>(mesh.corners(mesh.elements[e]));
      volume += measure;
      for (std::uint32_t g = of_element[e]; g < of_element[e + 1]; ++g) {
        auto same = std::find_if(at.begin(), at.end(), [&](const auto& other) {
          return other.region == gradients[g].region;
        });
        if (same == at.end()) same = at.insert(at.end(), {0, gradients[g].region, Vec<D>::Zero()});
        same->gradient += measure * gradients[g].gradient;
      }
    }
    if (at.empty()) return;
    const double densest = spectrum<D>(natural[n]).values[D - 1];
    double h = std::numeric_limits<double>::infinity();
    for (const auto& g : at) h = std::min(h, params.h_min[g.region]);
    h = std::max(h, step * size_from_eigenvalue(densest));
    const double across = eigenvalue_from_size(h);
    if (params.combination == Combination::sum) {
      Mat<D> tensor = Mat<D>::Zero();
      for (const auto& g : at) tensor += outer<D>(g.gradient / volume);
      const double largest = spectrum<D>(tensor).values[D - 1];
      if (!(largest > 0)) return;
      metric[n] += across / largest * tensor;
    } else {
      for (const auto& g : at)
        if (const double length = g.gradient.norm(); length > 0)
          metric[n] = intersect<D>(metric[n], natural[n] + across * outer<D>(g.gradient / length));
    }
    metric[n] = clipped<D>(metric[n], std::max(across, densest));
  };
  if (!parallel_each(metric.size() - 1, params.threads, progress,
                     [&](std::size_t i) { capture(i + 1); }))
    return cancelled_error();
  return metric;
}

template <int D>
MetricFunction<D> interface_metric_at(const Partition<D>& partition, MetricFunction<D> natural,
                                      std::vector<std::optional<double>> h_min, double share,
                                      double slope) {
  return [&partition, natural = std::move(natural), h_min = std::move(h_min), share,
          slope](const Vec<D>& x) -> Metric<D> {
    const Metric<D> inside = natural(x);
    const double densest = spectrum<D>(inside).values[D - 1];
    const double layer = size_from_eigenvalue(densest);
    const auto across = [&](int region) { return h_min[region].value_or(share * layer); };
    // Beyond this the border asks for three times the size that there is.
    double finest = share * layer;
    for (const std::optional<double>& h : h_min) finest = std::min(finest, h.value_or(finest));
    const double reach = 2 * finest + 3 * layer / slope;
    thread_local std::vector<Border<D>> near;
    partition.borders(x, reach, near);
    if (near.empty()) return inside;
    const double own = across(partition.region_of(x));
    double strongest = densest;
    Metric<D> metric = inside;
    for (const auto& [zone, border] : near) {
      // A step across the border tells whose it is.
      const Vec<D> foot = x + border.distance * border.normal;
      const Vec<D> beyond = foot + 0.1 * finest * border.normal;
      const double least = std::min(own, across(partition.region_of(beyond)));
      const double h = least + slope * std::max(0.0, border.distance - 2 * least);
      strongest = std::max(strongest, eigenvalue_from_size(h));
      intersect_with<D>(border.normal / h, metric);
      follow_border<D>(partition.zone(zone), x, border, inside, least, slope, h, metric);
    }
    return clipped<D>(metric, strongest);
  };
}

#define LAMELLA_INSTANTIATE(D)                                                                  \
  template std::vector<FillingGradient<D>> filling_gradients<D>(                                \
      const SimplexMesh<D>&, const Filling&, const std::vector<std::int32_t>&);                 \
  template Result<MetricField<D>> interface_metric<D>(const SimplexMesh<D>&, const Filling&,    \
                                                      const MetricField<D>&,                    \
                                                      const InterfaceParams&, const Progress&); \
  template MetricFunction<D> interface_metric_at<D>(                                            \
      const Partition<D>&, MetricFunction<D>, std::vector<std::optional<double>>, double, double);
LAMELLA_INSTANTIATE(2)
LAMELLA_INSTANTIATE(3)
#undef LAMELLA_INSTANTIATE

}  // namespace lamella
