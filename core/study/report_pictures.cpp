#include "core/study/report_pictures.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/mesh/interfaces.h"
#include "core/study/request.h"
#include "core/study/study.h"

namespace lamella {

namespace {

constexpr int kWidth = 1400, kTallest = 620;
constexpr double kMargin = 12;  // pixels
constexpr Rgb kInk{0.11f, 0.15f, 0.2f};
constexpr Rgb kUnmeasured{0.83f, 0.85f, 0.87f};
constexpr Rgb kMark{0.82f, 0.38f, 0.06f};
constexpr std::array<Rgb, 8> kBodies{{{0.66f, 0.80f, 0.89f},
                                      {0.95f, 0.79f, 0.60f},
                                      {0.72f, 0.84f, 0.64f},
                                      {0.82f, 0.74f, 0.88f},
                                      {0.95f, 0.72f, 0.71f},
                                      {0.93f, 0.88f, 0.62f},
                                      {0.66f, 0.85f, 0.82f},
                                      {0.85f, 0.77f, 0.71f}}};
constexpr Rgb kBackgroundColor{0.90f, 0.92f, 0.93f};

/// Layers over those asked: below the bound the color holds.
struct Band {
  double below;
  Rgb color;
  const char* text;
};
constexpr std::array<Band, 6> kBands{{
    {0.5, {0.72f, 0.18f, 0.18f}, "below 0.5 n"},
    {0.75, {0.88f, 0.48f, 0.33f}, "0.5 to 0.75 n"},
    {0.9, {0.96f, 0.79f, 0.61f}, "0.75 to 0.9 n"},
    {1.25, {0.74f, 0.86f, 0.75f}, "0.9 to 1.25 n"},
    {1.75, {0.50f, 0.71f, 0.85f}, "1.25 to 1.75 n"},
    {std::numeric_limits<double>::infinity(), {0.15f, 0.37f, 0.64f}, "more"},
}};

/// Nodes of the bodies that matter: all but what is around them, where there is something in it.
std::vector<char> nodes_in_bodies(const SimplexMesh<3>& mesh) {
  std::vector<char> inside(mesh.points.size(), 0);
  for (std::size_t e = 0; e < mesh.elements.size(); ++e) {
    const auto body = static_cast<std::size_t>(mesh.element_body[e]);
    if (mesh.bodies.size() > 1 && mesh.bodies[body] == kBackground) continue;
    for (const NodeId v : mesh.elements[e]) inside[v] = 1;
  }
  return inside;
}

/// From space to a box of pixels: what is seen along `towards_eye`.
class View {
 public:
  View(const Vec<3>& towards_eye, const Vec<3>& up)
      : eye_(towards_eye.normalized()),
        right_(up.cross(eye_).normalized()),
        up_(eye_.cross(right_)) {}

  void see(const Vec<3>& x) {
    const Vec<3> p = turned(x);
    for (int k = 0; k < 2; ++k) {
      low_[k] = std::min(low_[k], p[k]);
      high_[k] = std::max(high_[k], p[k]);
    }
  }
  /// Height over width of what is seen.
  double aspect() const {
    return (high_[1] - low_[1]) / std::max(high_[0] - low_[0], 1e-12 * (high_[1] - low_[1]));
  }
  void fit(const PixelBox& box) {
    scale_ = std::min((box.right - box.left - 2 * kMargin) / (high_[0] - low_[0]),
                      (box.bottom - box.top - 2 * kMargin) / (high_[1] - low_[1]));
    if (!std::isfinite(scale_)) scale_ = 1;
    x_ = (box.left + box.right - scale_ * (low_[0] + high_[0])) / 2;
    y_ = (box.top + box.bottom + scale_ * (low_[1] + high_[1])) / 2;
  }
  Vec<3> pixel(const Vec<3>& x) const {
    const Vec<3> p = turned(x);
    return {x_ + scale_ * p[0], y_ - scale_ * p[1], scale_ * p[2]};
  }
  Vec<3> turned(const Vec<3>& x) const { return {x.dot(right_), x.dot(up_), x.dot(eye_)}; }
  double scale() const { return scale_; }

 private:
  Vec<3> eye_, right_, up_;
  std::array<double, 2> low_{1e300, 1e300}, high_{-1e300, -1e300};
  double scale_ = 1, x_ = 0, y_ = 0;
};

/// How much of a line of the mesh is seen: nothing where they would blacken the picture.
double line_share(double mean_pixels) { return std::clamp((mean_pixels - 2.5) / 12, 0.0, 0.55); }

ReportPicture picture_of(const Canvas& canvas, std::string caption) {
  const Image image = canvas.image();
  return {std::move(caption), png(image), image.width, image.height};
}

Rgb band_color(double ratio) {
  for (const Band& band : kBands)
    if (ratio < band.below) return band.color;
  return kUnmeasured;  // NaN
}

/// Layers of each node over those asked of its body; NaN where not measured.
std::vector<double> layer_ratios(const Study& study, const MeshState& state) {
  const SimplexMesh<3>& mesh = state.mesh;
  std::vector<int> asked;
  for (const std::string& body : mesh.bodies) asked.push_back(settings_of(study, body).layers);
  std::vector<double> ratios(mesh.points.size(), std::nan(""));
  for (std::size_t e = 0; e < mesh.elements.size(); ++e)
    for (const NodeId v : mesh.elements[e])
      ratios[v] = state.layers[v] / asked[static_cast<std::size_t>(mesh.element_body[e])];
  return ratios;
}

/// A polygon that a plane cuts from an element.
struct Cut {
  std::array<Vec<3>, 4> corners;
  int count = 0;
  std::int32_t body = 0;
  double area() const {
    Vec<3> sum = Vec<3>::Zero();
    for (int k = 1; k + 1 < count; ++k)
      sum += (corners[k] - corners[0]).cross(corners[k + 1] - corners[0]) / 2;
    return sum.norm();
  }
};

/// Polygons in the plane. False when cancelled.
bool cut_elements(const SimplexMesh<3>& mesh, const Vec<3>& origin, const Vec<3>& normal,
                  const Progress& progress, std::vector<Cut>& cuts) {
  std::vector<double> height;
  for (const Vec<3>& x : mesh.points) height.push_back((x - origin).dot(normal));
  for (std::size_t e = 0; e < mesh.elements.size(); ++e) {
    if (e % 65536 == 0 && progress.cancelled()) return false;
    std::array<NodeId, 4> below{}, above{};
    int b = 0, a = 0;
    for (const NodeId v : mesh.elements[e]) (height[v] < 0 ? below[b++] : above[a++]) = v;
    if (a == 0 || b == 0) continue;
    const auto between = [&](NodeId u, NodeId v) -> Vec<3> {
      return mesh.points[u] +
             height[u] / (height[u] - height[v]) * (mesh.points[v] - mesh.points[u]);
    };
    Cut cut;
    cut.body = mesh.element_body[e];
    for (int i = 0; i < b; ++i)
      for (int j = 0; j < a; ++j) cut.corners[cut.count++] = between(below[i], above[j]);
    if (cut.count == 4) std::swap(cut.corners[2], cut.corners[3]);
    cuts.push_back(cut);
  }
  return true;
}

struct Plane {
  Vec<3> origin, normal;
  std::string name;
};

class SectionPictures {
 public:
  SectionPictures(const Study& study, const MeshState& state)
      : study_(study),
        state_(state),
        mesh_(state.mesh),
        counts_(nodes_in_bodies(state.mesh)),
        inner_(counts_) {
    for (const auto& facet : mesh_.facets)
      for (const NodeId v : facet) inner_[v] = 0;
  }

  Result<std::vector<ReportPicture>> draw(const Progress& progress) {
    std::vector<ReportPicture> pictures;
    for (const CutPlane& cut : study_.cuts)
      if (cut.on && pictures.size() < 2)
        if (Result<void> drawn = draw({cut.origin, cut.normal, cut.name}, progress, pictures);
            !drawn)
          return drawn.error();
    if (!pictures.empty()) return pictures;
    Vec<3> low = Vec<3>::Constant(1e300), high = -low;
    for (std::size_t v = 1; v < mesh_.points.size(); ++v) {
      if (!counts_[v]) continue;
      low = low.cwiseMin(mesh_.points[v]);
      high = high.cwiseMax(mesh_.points[v]);
    }
    std::array<int, 3> axes{0, 1, 2};
    std::stable_sort(axes.begin(), axes.end(),
                     [&](int i, int j) { return high[i] - low[i] > high[j] - low[j]; });
    for (int k = 0; k < 2; ++k) {
      const std::optional<Plane> plane = best_plane(axes[k], low, high, progress);
      if (!plane) return cancelled_error();
      if (Result<void> drawn = draw(*plane, progress, pictures); !drawn) return drawn.error();
    }
    return pictures;
  }

 private:
  bool in_body(std::int32_t body) const {
    return mesh_.bodies.size() == 1 || mesh_.bodies[static_cast<std::size_t>(body)] != kBackground;
  }

  /// Across the axis, where it cuts most of the bodies. Not right in the middle, where parts made
  /// by mirroring have an edge. Nothing when cancelled.
  std::optional<Plane> best_plane(int axis, const Vec<3>& low, const Vec<3>& high,
                                  const Progress& progress) const {
    std::optional<Plane> best;
    double most = -1;
    for (const double share : {0.497, 0.417, 0.583, 0.333, 0.667}) {
      Plane plane{(low + high) / 2, Vec<3>::Unit(axis), {}};
      plane.origin[axis] = low[axis] + share * (high[axis] - low[axis]);
      std::vector<Cut> cuts;
      if (!cut_elements(mesh_, plane.origin, plane.normal, progress, cuts)) return {};
      double area = 0;
      for (const Cut& cut : cuts)
        if (in_body(cut.body)) area += cut.area();
      if (area <= 1.02 * most) continue;  // the middle one of those that are alike
      most = area;
      char text[60];
      std::snprintf(text, sizeof text, "%c = %.4g mm", "xyz"[axis], plane.origin[axis]);
      plane.name = text;
      best = plane;
    }
    return best;
  }

  Rgb color_of(std::int32_t body) const {
    return in_body(body) ? kBodies[static_cast<std::size_t>(body) % kBodies.size()]
                         : kBackgroundColor;
  }

  void paint(Canvas& canvas, const View& view, const std::vector<Cut>& cuts) const {
    double pixels = 0;
    std::size_t edges = 0;
    for (const Cut& cut : cuts)
      for (int k = 0; k < cut.count; ++k, ++edges)
        pixels += view.scale() * (cut.corners[(k + 1) % cut.count] - cut.corners[k]).norm();
    const double share =
        line_share(1.5 * pixels / static_cast<double>(std::max<std::size_t>(1, edges)));
    for (const Cut& cut : cuts) {
      const Rgb color = color_of(cut.body);
      std::array<Vec<3>, 4> p;
      for (int k = 0; k < cut.count; ++k) p[k] = view.pixel(cut.corners[k]);
      for (int k = 1; k + 1 < cut.count; ++k)
        canvas.triangle({p[0], p[k], p[k + 1]}, [&](double, double, double) { return color; });
    }
    if (share == 0) return;
    for (const Cut& cut : cuts)
      for (int k = 0; k < cut.count; ++k)
        canvas.line(view.pixel(cut.corners[k]), view.pixel(cut.corners[(k + 1) % cut.count]), kInk,
                    share, 1e30);
  }

  Result<void> draw(const Plane& plane, const Progress& progress,
                    std::vector<ReportPicture>& pictures) const {
    std::vector<Cut> cuts;
    if (!cut_elements(mesh_, plane.origin, plane.normal, progress, cuts)) return cancelled_error();
    if (cuts.empty()) return {};
    const Vec<3> up = std::abs(plane.normal[2]) > 0.9 ? Vec<3>::UnitY() : Vec<3>::UnitZ();
    View whole(-plane.normal, up);
    for (const Cut& cut : cuts)
      for (int k = 0; k < cut.count; ++k) whole.see(cut.corners[k]);
    // A node inside of the wall is in the middle of what is seen.
    std::optional<WallPlace> wall = typical_wall(state_, plane.origin, plane.normal, inner_);
    if (!wall) wall = typical_wall(state_, plane.origin, plane.normal, counts_);
    // As tall as the section needs, with the wall from near in a square beside it.
    const double least = wall ? 420 : 160;
    const double width = wall ? kWidth - least : kWidth;
    const auto height =
        static_cast<int>(std::clamp(width * whole.aspect(), least, static_cast<double>(kTallest)));
    const PixelBox left{0, 0, wall ? kWidth - static_cast<double>(height) : kWidth,
                        static_cast<double>(height)};
    Canvas canvas(kWidth, height);
    whole.fit(left);
    canvas.clip(left);
    paint(canvas, whole, cuts);
    std::string caption = "Section " + plane.name;
    if (wall) {
      const double reach = 1.4 * wall->thickness;
      canvas.circle(whole.pixel(wall->center), std::max(6.0, whole.scale() * reach), kMark);
      View near(-plane.normal, up);
      for (const double side : {-reach, reach})
        near.see(wall->center + side * (up + up.cross(plane.normal)));
      PixelBox box{left.right + 2, 2, kWidth - 2.0, height - 2.0};
      near.fit({box.left - kMargin, box.top - kMargin, box.right + kMargin, box.bottom + kMargin});
      canvas.clip(box);
      paint(canvas, near, cuts);
      const std::array<Vec<3>, 4> frame{
          Vec<3>(box.left, box.top, 0), Vec<3>(box.right - 1, box.top, 0),
          Vec<3>(box.right - 1, box.bottom - 1, 0), Vec<3>(box.left, box.bottom - 1, 0)};
      for (int k = 0; k < 4; ++k) canvas.line(frame[k], frame[(k + 1) % 4], kMark, 1, 1e30);
      char text[60];
      std::snprintf(text, sizeof text, "; right, a wall of %.3g mm", wall->thickness);
      caption += text;
    }
    pictures.push_back(picture_of(canvas, std::move(caption)));
    return {};
  }

  const Study& study_;
  const MeshState& state_;
  const SimplexMesh<3>& mesh_;
  const std::vector<char> counts_;
  std::vector<char> inner_;  // those of `counts_` that lie on no facet
};

}  // namespace

std::vector<std::pair<Rgb, std::string>> layers_legend() {
  std::vector<std::pair<Rgb, std::string>> legend;
  for (const Band& band : kBands) legend.emplace_back(band.color, band.text);
  legend.emplace_back(kUnmeasured, "no thin wall");
  return legend;
}

Result<std::optional<ReportPicture>> layers_map(const Study& study, const MeshState& state,
                                                const Progress& progress) {
  std::optional<ReportPicture> none;
  if (state.layers.size() != state.mesh.points.size()) return none;
  const std::vector<double> ratios = layer_ratios(study, state);
  if (std::all_of(ratios.begin(), ratios.end(), [](double r) { return std::isnan(r); }))
    return none;
  const SimplexMesh<3> shown =
      state.mesh.bodies.size() > 1 ? with_interfaces(state.mesh) : state.mesh;
  if (progress.cancelled()) return cancelled_error();
  const std::vector<char> inside = nodes_in_bodies(shown);
  std::vector<std::array<NodeId, 3>> facets;
  for (const auto& f : shown.facets)
    if (inside[f[0]] && inside[f[1]] && inside[f[2]]) facets.push_back(f);

  View views[] = {{Vec<3>(0.9, -1.3, 1), Vec<3>::UnitZ()},
                  {Vec<3>(-0.9, 1.3, -1), Vec<3>::UnitZ()}};
  double aspect = 0;
  for (View& view : views) {
    for (const auto& f : facets)
      for (const NodeId v : f) view.see(shown.points[v]);
    aspect = std::max(aspect, view.aspect());
  }
  const auto height =
      static_cast<int>(std::clamp(kWidth / 2 * aspect, 120.0, static_cast<double>(kTallest)));
  Canvas canvas(kWidth, height);
  for (int k = 0; k < 2; ++k) {
    const PixelBox box{k * kWidth / 2.0, 0, (k + 1) * kWidth / 2.0, static_cast<double>(height)};
    View& view = views[k];
    view.fit(box);
    canvas.clip(box);
    double pixels = 0;
    std::size_t drawn = 0;
    for (const auto& f : facets) {
      if (++drawn % 16384 == 0 && progress.cancelled()) return cancelled_error();
      std::array<Vec<3>, 3> p, x;
      std::array<double, 3> r;
      double mean = 0;
      int known = 0;
      for (int c = 0; c < 3; ++c) {
        x[c] = view.turned(shown.points[f[c]]);
        p[c] = view.pixel(shown.points[f[c]]);
        r[c] = ratios[f[c]];
        if (std::isnan(r[c])) continue;
        mean += r[c];
        ++known;
      }
      // Where one corner was not measured, the others speak for it.
      for (double& value : r)
        if (std::isnan(value)) value = known > 0 ? mean / known : value;
      for (int c = 0; c < 3; ++c) pixels += (p[c] - p[(c + 1) % 3]).norm() / 3;
      const Vec<3> normal = (x[1] - x[0]).cross(x[2] - x[0]).normalized();
      const auto light =
          static_cast<float>(0.78 + 0.22 * std::abs(normal.dot(Vec<3>(-0.3, 0.5, 0.81))));
      canvas.triangle(p, [&](double a, double b, double c) {
        return light * band_color(a * r[0] + b * r[1] + c * r[2]);
      });
    }
    const double share =
        0.6 * line_share(pixels / static_cast<double>(std::max<std::size_t>(1, drawn)));
    if (share == 0) continue;
    for (const auto& f : facets)
      for (int c = 0; c < 3; ++c)
        if (f[c] < f[(c + 1) % 3])
          canvas.line(view.pixel(shown.points[f[c]]), view.pixel(shown.points[f[(c + 1) % 3]]),
                      kInk, share, 0.8);
  }
  return std::optional(picture_of(canvas, "Layers measured back, over the n asked; two sides"));
}

Result<std::vector<ReportPicture>> sections(const Study& study, const MeshState& state,
                                            const Progress& progress) {
  return SectionPictures(study, state).draw(progress);
}

std::optional<WallPlace> typical_wall(const MeshState& state, const Vec<3>& origin,
                                      const Vec<3>& normal, const std::vector<char>& counts) {
  if (state.thickness.size() != state.mesh.points.size()) return {};
  std::vector<WallPlace> places;
  for (std::size_t n = 1; n < state.mesh.points.size(); ++n) {
    if (!counts.empty() && !counts[n]) continue;
    const Vec<3>& x = state.mesh.points[n];
    const double off = (x - origin).dot(normal);
    if (state.thickness[n] > 0 && std::abs(off) < state.thickness[n] / 2)
      places.push_back({x - off * normal, state.thickness[n]});
  }
  if (places.empty()) return {};
  std::sort(places.begin(), places.end(),
            [](const WallPlace& a, const WallPlace& b) { return a.thickness < b.thickness; });
  const double usual = places[places.size() / 2].thickness;
  std::erase_if(places,
                [&](const WallPlace& p) { return std::abs(p.thickness / usual - 1) > 0.1; });
  Vec<3> middle = Vec<3>::Zero();
  for (const WallPlace& p : places) middle += p.center / static_cast<double>(places.size());
  return *std::min_element(
      places.begin(), places.end(), [&](const WallPlace& a, const WallPlace& b) {
        return (a.center - middle).squaredNorm() < (b.center - middle).squaredNorm();
      });
}

}  // namespace lamella
