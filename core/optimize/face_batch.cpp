#include "core/optimize/face_batch.h"

#include <algorithm>

// The same source for processors with and without wide vectors, chosen when the program starts.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__)
#define LAMELLA_VECTOR __attribute__((target_clones("arch=x86-64-v3", "default")))
#else
#define LAMELLA_VECTOR
#endif
#define LAMELLA_INLINE inline __attribute__((always_inline))

namespace lamella {
namespace {

template <int D>
using Group = typename FaceBatch<D>::Group;
constexpr int width = 4;
/// Four numbers, worked on at once; the compiler maps them onto what the processor has.
using Quad = double __attribute__((vector_size(width * sizeof(double)), may_alias));
using Whole = std::int32_t __attribute__((vector_size(width * sizeof(std::int32_t)), may_alias));
/// Of four comparisons: all bits of a lane, or none.
using Mask = std::int64_t __attribute__((vector_size(width * sizeof(std::int64_t))));
constexpr double infinity = std::numeric_limits<double>::infinity();

LAMELLA_INLINE Quad load(const double (&lanes)[width]) {
  return *reinterpret_cast<const Quad*>(lanes);
}
LAMELLA_INLINE void store(double* lanes, Quad q) { *reinterpret_cast<Quad*>(lanes) = q; }
LAMELLA_INLINE Quad root(Quad q) {
  Quad r;
  for (int l = 0; l < width; ++l) r[l] = std::sqrt(q[l]);
  return r;
}
LAMELLA_INLINE Quad least(Quad a, Quad b) { return a < b ? a : b; }

/// Of a symmetric matrix, upper triangle row by row.
template <int D>
LAMELLA_INLINE Quad determinant(const Quad* m) {
  if constexpr (D == 2) {
    return m[0] * m[2] - m[1] * m[1];
  } else if constexpr (D == 3) {
    return m[0] * (m[3] * m[5] - m[4] * m[4]) - m[1] * (m[1] * m[5] - m[4] * m[2]) +
           m[2] * (m[1] * m[4] - m[3] * m[2]);
  } else {
    // By the 2 x 2 minors of the upper and the lower two rows.
    const Quad s0 = m[0] * m[4] - m[1] * m[1], s1 = m[0] * m[5] - m[1] * m[2];
    const Quad s2 = m[0] * m[6] - m[1] * m[3], s3 = m[1] * m[5] - m[4] * m[2];
    const Quad s4 = m[1] * m[6] - m[4] * m[3], s5 = m[2] * m[6] - m[5] * m[3];
    const Quad c5 = m[7] * m[9] - m[8] * m[8], c4 = m[5] * m[9] - m[6] * m[8];
    const Quad c3 = m[5] * m[8] - m[6] * m[7], c2 = m[2] * m[9] - m[3] * m[8];
    const Quad c1 = m[2] * m[8] - m[3] * m[7], c0 = m[2] * m[6] - m[3] * m[5];
    return s0 * c5 - s1 * c4 + s2 * c3 + s3 * c2 - s4 * c1 + s5 * c0;
  }
}

/// The same number in all lanes.
template <int N>
struct Spread {
  Quad lanes[N];
  LAMELLA_INLINE explicit Spread(const double* values) {
    for (int k = 0; k < N; ++k) lanes[k] = Quad{} + values[k];
  }
};

/// What depends on the apex in four elements: h^2, D! times the measure, and the factor that makes
/// it the measure in the metric over that of the unit simplex.
template <int D>
struct Shapes {
  Quad w[D], metric[Packed<D>::size], size, volume, scale;
};

template <int D>
LAMELLA_INLINE void shapes(const Group<D>& g, const Quad* apex, const Quad* carried, Shapes<D>& s) {
  constexpr double mean = 1.0 / (D + 1);
  for (int k = 0; k < D; ++k) s.w[k] = apex[k] - load(g.center[k]);
  for (int k = 0; k < Packed<D>::size; ++k) s.metric[k] = mean * (load(g.metric[k]) + carried[k]);
  s.volume = load(g.normal[0]) * s.w[0];
  for (int k = 1; k < D; ++k) s.volume += load(g.normal[k]) * s.w[k];
  Quad trace = {};
  for (int i = 0, k = 0; i < D; ++i)
    for (int j = i; j < D; ++j, ++k)
      trace += s.metric[k] * (load(g.edges[k]) + (i == j ? D : 2.0 * D) * (s.w[i] * s.w[j]));
  s.size = trace * (2.0 / (D * (D + 1)));
  s.scale = root(determinant<D>(s.metric) * ((1 << D) * mean));
}

template <int D>
LAMELLA_INLINE Quad power(Quad h2) {
  if constexpr (D == 2) return h2;
  if constexpr (D == 3) return h2 * root(h2);
  return h2 * h2;
}

template <int D>
LAMELLA_INLINE void rate_group(const Group<D>& g, const Quad* apex, const Quad* carried,
                               double relaxation, double weight, Quad& quality, Quad& energy) {
  Shapes<D> s;
  shapes<D>(g, apex, carried, s);
  const Quad h = power<D>(s.size), inverse = 1 / h, measure = s.volume * s.scale;
  const Quad q = least(relaxation * (measure * inverse), least(h, inverse));
  const Quad e = h / measure + weight * (h + inverse - 2);
  Quad w2 = s.w[0] * s.w[0];
  for (int k = 1; k < D; ++k) w2 += s.w[k] * s.w[k];
  // Flat within rounding, or ill oriented.
  const Mask sound = (s.volume > 0) & (s.volume * s.volume > 1e-22 * (load(g.normal2) * w2));
  quality = sound ? q : Quad{-1, -1, -1, -1};
  energy = sound ? e : Quad{infinity, infinity, infinity, infinity};
}

/// Four elements with one apex, which is a node where `node` is not 0.
template <int D>
LAMELLA_INLINE void rate_star(const Group<D>& g, NodeId node, const double* apex,
                              const double* carried, double relaxation, double weight,
                              typename FaceBatch<D>::Rates& rates) {
  Quad quality, energy;
  rate_group<D>(g, Spread<D>(apex).lanes, Spread<Packed<D>::size>(carried).lanes, relaxation,
                weight, quality, energy);
  Whole none = *reinterpret_cast<const Whole*>(g.nodes[0]) < 0;
  for (int k = 0; k < D; ++k) none |= *reinterpret_cast<const Whole*>(g.nodes[k]) == node;
  const Mask empty = __builtin_convertvector(none, Mask);
  quality = empty ? Quad{infinity, infinity, infinity, infinity} : quality;
  const Quad excess = empty ? Quad{} : energy - 1;
  store(rates.quality, quality);
  store(rates.energy, energy);
  rates.count = width + (none[0] + none[1]) + (none[2] + none[3]);
  rates.worst = std::min(std::min(quality[0], quality[1]), std::min(quality[2], quality[3]));
  rates.sum = (excess[0] + excess[1]) + (excess[2] + excess[3]);
}

template <int D>
LAMELLA_INLINE bool derive_group(const Group<D>& g, const Quad* apex, const Quad* carried,
                                 double weight, double (*gradient)[width], double (*hessian)[width],
                                 double (*convex)[width]) {
  constexpr double p = 0.5 * D, c = 4.0 / (D + 1);
  Shapes<D> s;
  shapes<D>(g, apex, carried, s);
  const Quad measure = s.volume * s.scale, a = power<D>(s.size);
  const Quad inv_s = 1 / s.size, inv_v = 1 / measure, inv_a = 1 / a;
  const Quad by_size = p * inv_s * (a * inv_v + weight * (a - inv_a));
  const Quad by_volume = -a * inv_v * inv_v;
  const Quad ss =
      inv_s * inv_s * (p * (p - 1) * a * (inv_v + weight) + weight * p * (p + 1) * inv_a);
  const Quad vv = 2 * a * inv_v * inv_v * inv_v;
  const Quad sv = -p * a * inv_s * inv_v * inv_v;
  const Quad floor = 0.1 * p * inv_s * a * inv_v;
  const Quad curve = c * (by_size > floor ? by_size : floor);
  Quad u[D], n[D];
  for (int i = 0; i < D; ++i) {
    Quad r = s.metric[Packed<D>::index(0, i)] * s.w[0];
    for (int j = 1; j < D; ++j)
      r += s.metric[Packed<D>::index(i < j ? i : j, i < j ? j : i)] * s.w[j];
    u[i] = c * r;
    n[i] = s.scale * load(g.normal[i]);
    store(gradient[i], load(gradient[i]) + by_size * u[i] + by_volume * n[i]);
  }
  // by_size c M + ss u u^T + sv (u n^T + n u^T) + vv n n^T
  for (int i = 0, k = 0; i < D; ++i)
    for (int j = i; j < D; ++j, ++k) {
      const Quad stiff = curve * s.metric[k] + vv * n[i] * n[j];
      store(convex[k], load(convex[k]) + stiff);
      store(hessian[k],
            load(hessian[k]) + stiff + ss * u[i] * u[j] + sv * (u[i] * n[j] + n[i] * u[j]));
    }
  const auto sound = measure > 0;
  return sound[0] & sound[1] & sound[2] & sound[3];
}

/// Determinant of the rows i, j and k of three columns.
LAMELLA_INLINE Quad minor(const Quad (&c)[3][4], int i, int j, int k) {
  return c[0][i] * (c[1][j] * c[2][k] - c[1][k] * c[2][j]) -
         c[0][j] * (c[1][i] * c[2][k] - c[1][k] * c[2][i]) +
         c[0][k] * (c[1][i] * c[2][j] - c[1][j] * c[2][i]);
}

/// Reads the nodes of four faces: normals, centers and sums over the edges.
template <int D>
LAMELLA_INLINE void read_faces(Group<D>& g, const Vec<D>* points, const Packed<D>* carried) {
  Quad p[D][D], e[D - 1][D], n[D];
  for (int k = 0; k < D; ++k) {
    const double* x[width];
    const double* m[width];
    for (int l = 0; l < width; ++l) {
      x[l] = points[g.nodes[k][l]].data();
      m[l] = carried[g.nodes[k][l]].c.data();
    }
    for (int d = 0; d < D; ++d) p[k][d] = Quad{x[0][d], x[1][d], x[2][d], x[3][d]};
    for (int c = 0; c < Packed<D>::size; ++c) {
      const Quad own{m[0][c], m[1][c], m[2][c], m[3][c]};
      store(g.metric[c], k == 0 ? own : load(g.metric[c]) + own);
    }
  }
  for (int d = 0; d < D; ++d) {
    Quad sum = p[0][d];
    for (int k = 1; k < D; ++k) sum += p[k][d];
    store(g.center[d], sum * (1.0 / D));
    for (int k = 1; k < D; ++k) e[k - 1][d] = p[k][d] - p[0][d];
  }
  if constexpr (D == 2) {
    n[0] = e[0][1];
    n[1] = -e[0][0];
  } else if constexpr (D == 3) {
    n[0] = e[0][2] * e[1][1] - e[0][1] * e[1][2];
    n[1] = e[0][0] * e[1][2] - e[0][2] * e[1][0];
    n[2] = e[0][1] * e[1][0] - e[0][0] * e[1][1];
  } else {
    n[0] = minor(e, 1, 2, 3);
    n[1] = -minor(e, 0, 2, 3);
    n[2] = minor(e, 0, 1, 3);
    n[3] = -minor(e, 0, 1, 2);
  }
  Quad n2 = n[0] * n[0];
  for (int d = 0; d < D; ++d) {
    store(g.normal[d], n[d]);
    if (d > 0) n2 += n[d] * n[d];
  }
  store(g.normal2, n2);
  for (int i = 0, c = 0; i < D; ++i)
    for (int j = i; j < D; ++j, ++c) {
      Quad sum = {};
      for (int a = 0; a < D; ++a)
        for (int b = a + 1; b < D; ++b) sum += (p[b][i] - p[a][i]) * (p[b][j] - p[a][j]);
      store(g.edges[c], (i == j ? 1 : 2) * (D + 1.0) / D * sum);
    }
}

#define LAMELLA_DIMENSION(D)                                                                     \
  LAMELLA_VECTOR void read_lanes(Group<D>& g, const Vec<D>* points, const Packed<D>* carried) {  \
    read_faces<D>(g, points, carried);                                                           \
  }                                                                                              \
  LAMELLA_VECTOR void rate_lanes(const Group<D>& g, NodeId node, const double* apex,             \
                                 const double* carried, double relaxation, double weight,        \
                                 FaceBatch<D>::Rates& rates) {                                   \
    rate_star<D>(g, node, apex, carried, relaxation, weight, rates);                             \
  }                                                                                              \
  LAMELLA_VECTOR void rate_four(const Group<D>& g, const double(*apex)[width],                   \
                                const double(*carried)[width], double relaxation, double weight, \
                                double* quality, double* energy) {                               \
    Quad x[D], m[Packed<D>::size], q, e;                                                         \
    for (int k = 0; k < D; ++k) x[k] = load(apex[k]);                                            \
    for (int k = 0; k < Packed<D>::size; ++k) m[k] = load(carried[k]);                           \
    rate_group<D>(g, x, m, relaxation, weight, q, e);                                            \
    store(quality, q);                                                                           \
    store(energy, e);                                                                            \
  }                                                                                              \
  LAMELLA_VECTOR bool derive_lanes(const Group<D>& g, const double* apex, const double* carried, \
                                   double weight, double(*gradient)[width],                      \
                                   double(*hessian)[width], double(*convex)[width]) {            \
    return derive_group<D>(g, Spread<D>(apex).lanes, Spread<Packed<D>::size>(carried).lanes,     \
                           weight, gradient, hessian, convex);                                   \
  }
LAMELLA_DIMENSION(2)
LAMELLA_DIMENSION(3)
LAMELLA_DIMENSION(4)
#undef LAMELLA_DIMENSION

}  // namespace

template <int D>
void FaceBatch<D>::derive(int group) {
  if (groups_.size() < static_cast<std::size_t>(groups())) groups_.resize(groups());
  for (; derived_ <= group; ++derived_) {
    Group& g = groups_[derived_];
    const int first = derived_ * width;
    for (int l = 0; l < width; ++l) {
      const CavityFace<D>& f = faces_[std::min(first + l, size() - 1)];
      for (int k = 0; k < D; ++k) g.nodes[k][l] = f.nodes[k];
    }
    read_lanes(g, source_->points.data(), source_->carried.data());
    for (int l = size() - first; l < width; ++l) g.nodes[0][l] = -1;
  }
}

template <int D>
RealFace<D> FaceBatch<D>::real(int i) {
  const int group = i / width, l = i % width;
  derive(group);
  const Group& g = groups_[group];
  RealFace<D> f;
  static_cast<CavityFace<D>&>(f) = faces_[i];
  for (int d = 0; d < D; ++d) {
    f.normal[d] = g.normal[d][l];
    f.center[d] = g.center[d][l];
  }
  f.normal2 = g.normal2[l];
  for (int k = 0; k < packed; ++k) {
    f.edges.c[k] = g.edges[k][l];
    f.metric_sum.c[k] = g.metric[k][l];
  }
  return f;
}

template <int D>
Rating FaceBatch<D>::rate_one(int i, const RatingKernel<D>& kernel, const Vec<D>& apex,
                              const Packed<D>& apex_carried) {
  return kernel(real(i), apex, apex_carried);
}

template <int D>
void FaceBatch<D>::rate(int group, const RatingKernel<D>& kernel, NodeId node, const Vec<D>& apex,
                        const Packed<D>& apex_carried, Rates& rates) {
  derive(group);
  if (kernel.plain()) {
    rate_lanes(groups_[group], node, apex.data(), apex_carried.c.data(), kernel.relaxation,
               kernel.size_weight, rates);
    return;
  }
  rates.count = 0;
  rates.worst = infinity;
  rates.sum = 0;
  for (int l = 0; l < width; ++l) {
    const int i = group * width + l;
    rates.quality[l] = infinity;
    if (i >= size() || (node != 0 && faces_[i].contains(node))) continue;
    const Rating r = rate_one(i, kernel, apex, apex_carried);
    rates.quality[l] = r.quality;
    rates.energy[l] = r.energy;
    ++rates.count;
    rates.worst = std::min(rates.worst, r.quality);
    rates.sum += r.energy - 1;
  }
}

template <int D>
void FaceBatch<D>::rate_elements(const Nodes& nodes, std::size_t first, std::size_t last,
                                 const RatingKernel<D>& kernel, std::span<Rating> ratings) {
  open(nodes);
  alignas(32) Lanes apex[D], metric[packed];
  Rates rates;
  const auto finish = [&] {
    const int lanes = size();
    if (lanes == 0) return;
    if (kernel.plain()) {
      for (int l = lanes; l < width; ++l) {
        for (int d = 0; d < D; ++d) apex[d][l] = apex[d][0];
        for (int k = 0; k < packed; ++k) metric[k][l] = metric[k][0];
      }
      derive(0);
      rate_four(groups_[0], apex, metric, kernel.relaxation, kernel.size_weight, rates.quality,
                rates.energy);
    }
    for (int l = 0; l < lanes; ++l) {
      const std::int32_t e = faces_[l].element;
      const NodeId n = nodes.elements[e][0];
      ratings[e - first] = kernel.plain() ? Rating{rates.quality[l], rates.energy[l]}
                                          : rate_one(l, kernel, nodes.points[n], nodes.carried[n]);
    }
    open(nodes);
  };
  for (std::size_t e = first; e < last; ++e) {
    const auto& element = nodes.elements[e];
    if (element[1] == 0) continue;
    if (element[0] == 0) {
      ratings[e - first] = {infinity, 0};
      continue;
    }
    const int lane = size();
    add(static_cast<std::int32_t>(e), 0);
    for (int d = 0; d < D; ++d) apex[d][lane] = nodes.points[element[0]][d];
    for (int k = 0; k < packed; ++k) metric[k][lane] = nodes.carried[element[0]].c[k];
    if (size() == width) finish();
  }
  finish();
}

template <int D>
typename FaceBatch<D>::Derivatives FaceBatch<D>::derivatives(const RatingKernel<D>& kernel,
                                                             const Vec<D>& apex,
                                                             const Packed<D>& apex_carried) {
  Derivatives out;
  for (int g = 0; g < groups(); ++g) {
    derive(g);
    alignas(32) Lanes gradient[D] = {}, hessian[packed] = {}, convex[packed] = {};
    const int lanes = std::min(width, size() - g * width);
    if (kernel.plain()) {
      out.sound = derive_lanes(groups_[g], apex.data(), apex_carried.c.data(), kernel.size_weight,
                               gradient, hessian, convex);
    } else {
      // The metric of each element, as if the apex had no part in it.
      Group held = groups_[g];
      for (int l = 0; l < width; ++l) {
        const Packed<D> m =
            kernel.element_metric(real(std::min(g * width + l, size() - 1)), apex_carried);
        for (int k = 0; k < packed; ++k) held.metric[k][l] = (D + 1) * m.c[k];
      }
      out.sound = derive_lanes(held, apex.data(), Packed<D>::zero().c.data(), kernel.size_weight,
                               gradient, hessian, convex);
    }
    if (!out.sound) return out;
    // The lanes behind the last face are left out of the sum.
    for (int l = 0; l < lanes; ++l) {
      for (int k = 0; k < D; ++k) out.gradient[k] += gradient[k][l];
      for (int k = 0; k < packed; ++k) {
        out.hessian.c[k] += hessian[k][l];
        out.convex.c[k] += convex[k][l];
      }
    }
  }
  return out;
}

template class FaceBatch<2>;
template class FaceBatch<3>;
template class FaceBatch<4>;

}  // namespace lamella
