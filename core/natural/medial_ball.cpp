#include "core/natural/medial_ball.h"

#include "core/natural/ellipsoid_fit.h"

namespace lamella {
namespace {

constexpr double kSkin = 1e-4;     // of the diagonal: a start this deep is inside
constexpr double kContact = 1.1;   // of the radius: facets as near as this are touched
constexpr double kDistinct = 0.9;  // cosine above which two contacts are one
constexpr double kFoot = 0.999;    // cosine to the normal above which a contact is inside its facet
constexpr double kOpposite = 0.26;  // hull nearer than this: medial, or a wedge under 30 degrees
constexpr double kGrowth = 0.3;     // of the ideal growth of the radius that a step must reach
constexpr double kFacing = -0.95;   // cosine below which two contacts face each other
constexpr int kRounds = 60;
constexpr int kTrials = 12;
constexpr double kEdge = 0.1;    // of the skin: facets as near as this meet in the place asked
constexpr double kDeep = 0.95;   // of the skin: as deep below a facet is well inside
constexpr double kFloor = 1e-6;  // of the diagonal: smallest radius, where the body has none

struct Start {
  Vec<3> x;
  Nearest<3> foot;
  bool inside;
};

Start start_at(const Locator<3>& surface, const Vec<3>& x) {
  const double skin = kSkin * surface.diagonal();
  const auto here = surface.signed_nearest(x);
  if (here.distance < -skin) return {x, here.foot, true};
  const Vec<3> foot = here.foot.point;
  const auto try_from = [&](const Vec<3>& y) {
    const auto s = surface.signed_nearest(y);
    return std::pair{Start{y, s.foot, s.distance < 0}, s.distance};
  };
  auto [best, depth] = try_from(foot - skin * here.pseudo_normal);
  if (depth < -0.2 * skin) return best;
  // Thinner than the skin, or a corner whose normal sum does not lead inside.
  for (const auto& u : EllipsoidFit::directions())
    for (const double side : {-skin, skin}) {
      const auto [other, d] = try_from(foot + side * u);
      if (d < depth) {
        best = other;
        depth = d;
      }
    }
  return best;
}

/// Directions from the contacts to the center, nearest first, those nearly equal taken once.
struct Contacts {
  std::vector<Vec<3>> away;

  void add(const Vec<3>& center, const Nearest<3>& contact) {
    if (!(contact.distance2 > 0)) return;
    const Vec<3> a = (center - contact.point) / std::sqrt(contact.distance2);
    for (const auto& kept : away)
      if (a.dot(kept) > kDistinct) return;
    away.push_back(a);
  }

  /// See MedialBall.
  Vec<3> across() const {
    if (away.size() != 2 || away[0].dot(away[1]) > kFacing) return Vec<3>::Zero();
    return (away[0] - away[1]).normalized();
  }
};

}  // namespace

Vec<3> smallest_in_hull(const std::vector<Vec<3>>& points) {
  // The face of the hull that holds the answer, grown by the point that lies farthest below it.
  if (points.empty()) return Vec<3>::Zero();
  std::array<Vec<3>, 4> corner;
  int n = 1;
  corner[0] = points[0];
  Vec<3> best = points[0];
  for (std::size_t guard = 0; guard < 4 * points.size(); ++guard) {
    const Vec<3>* lowest = &points[0];
    for (const auto& p : points)
      if (p.dot(best) < lowest->dot(best)) lowest = &p;
    if (lowest->dot(best) > best.squaredNorm() - 1e-12) return best;
    corner[n++] = *lowest;
    // Nearest point over every subset of at most four corners.
    unsigned chosen = 0;
    double norm2 = best.squaredNorm();
    for (unsigned set = 1; set < 1u << n; ++set) {
      std::array<Vec<3>, 4> p;
      int m = 0;
      for (int k = 0; k < n; ++k)
        if (set >> k & 1) p[m++] = corner[k];
      if (m == 4) {
        Mat<3> a;
        for (int k = 0; k < 3; ++k) a.col(k) = p[k] - p[3];
        const double det = a.determinant();
        if (std::abs(det) < 1e-14) continue;
        const Vec<3> s = a.inverse() * -p[3];
        if (s.minCoeff() >= 0 && s.sum() <= 1) return Vec<3>::Zero();
        continue;
      }
      Vec<3> q;
      if (m == 1) {
        q = p[0];
      } else if (m == 2) {
        const Vec<3> e = p[1] - p[0];
        const double s = -e.dot(p[0]) / e.squaredNorm();
        if (!(s >= 0 && s <= 1)) continue;
        q = p[0] + s * e;
      } else {
        const Vec<3> e = p[1] - p[0], f = p[2] - p[0];
        const double ee = e.squaredNorm(), ff = f.squaredNorm(), ef = e.dot(f);
        const double det = ee * ff - ef * ef;
        if (det < 1e-14) continue;
        const double be = -e.dot(p[0]), bf = -f.dot(p[0]);
        const double s = (be * ff - bf * ef) / det, t = (bf * ee - be * ef) / det;
        if (!(s >= 0 && t >= 0 && s + t <= 1)) continue;
        q = p[0] + s * e + t * f;
      }
      if (q.squaredNorm() < norm2) {
        norm2 = q.squaredNorm();
        best = q;
        chosen = set;
      }
    }
    if (chosen == 0) return best;
    int m = 0;
    for (int k = 0; k < n; ++k)
      if (chosen >> k & 1) corner[m++] = corner[k];
    n = m;
  }
  return best;
}

namespace {

MedialBall climb(const Locator<3>& surface, const Start& start) {
  const double floor = kFloor * surface.diagonal();
  MedialBall ball{start.x, std::sqrt(start.foot.distance2), start.foot.facet, 0};
  if (!start.inside || ball.radius < floor) {
    ball.radius = floor;
    return ball;
  }

  Nearest<3> touch = start.foot;
  std::vector<std::int32_t> known;  // facets met on the way: they often settle the matter
  std::vector<Nearest<3>> near;
  while (ball.rounds < kRounds) {
    Contacts contacts;
    contacts.add(ball.center, touch);
    for (const auto f : known) {
      // At its edges another facet may be nearer, and touch in another direction.
      const auto n = surface.nearest_on_facet(ball.center, f);
      const double below = surface.normal(f).dot(n.point - ball.center);
      if (n.distance2 <= kContact * kContact * touch.distance2 &&
          below * below >= kFoot * kFoot * n.distance2)
        contacts.add(ball.center, n);
    }
    Vec<3> g = smallest_in_hull(contacts.away);
    ball.across = contacts.across();
    if (g.norm() < kOpposite) break;
    surface.all_within(ball.center, kContact * ball.radius, near);
    contacts.away.clear();
    for (const auto& n : near) contacts.add(ball.center, n);
    g = smallest_in_hull(contacts.away);
    ball.across = contacts.across();
    const double slope = g.norm();  // growth of the radius per step along u
    if (slope < kOpposite) break;

    const Vec<3> u = g / slope;
    const auto hit = surface.exit(ball.center, u);
    if (!hit) break;
    known.assign({touch.facet, hit->facet});
    for (const auto& n : near)
      if (known.size() < 6) known.push_back(n.facet);

    double s = 0.5 * (hit->t - ball.radius);
    bool moved = false;
    for (int trial = 0; trial < kTrials && s > 1e-6 * ball.radius; ++trial) {
      const Vec<3> c = ball.center + s * u;
      const auto foot = surface.nearest(c);
      const double r = std::sqrt(foot->distance2);
      if (r >= ball.radius + kGrowth * slope * s) {
        ball.center = c;
        ball.radius = r;
        ball.facet = foot->facet;
        touch = *foot;
        moved = true;
        break;
      }
      // The new contact approaches at the rate `toward`: meet it where it is as near as the old.
      const double toward = r > 0 ? u.dot(c - foot->point) / r : -1;
      const double excess = ball.radius + slope * s - r;
      const double shorter = s - excess / std::max(slope - toward, 1e-3);
      s = std::clamp(shorter, 0.05 * s, 0.7 * s);
    }
    if (!moved) break;
    ++ball.rounds;
  }
  return ball;
}

}  // namespace

MedialBall climb_to_medial_ball(const Locator<3>& surface, const Vec<3>& x) {
  return climb(surface, start_at(surface, x));
}

std::vector<MedialBall> medial_balls(const Locator<3>& surface, const Vec<3>& x) {
  const double skin = kSkin * surface.diagonal();
  const auto here = surface.nearest(x);
  const Vec<3> foot = here->point;
  std::vector<Nearest<3>> touched;
  if (here->distance2 <= skin * skin) surface.all_within(foot, kEdge * skin, touched);
  std::vector<Vec<3>> sides;         // normals
  std::vector<std::size_t> side_of;  // [touched]
  for (const auto& t : touched) {
    const Vec<3> n = surface.normal(t.facet);
    const auto known = std::find_if(sides.begin(), sides.end(),
                                    [&](const Vec<3>& side) { return side.dot(n) > kDistinct; });
    side_of.push_back(static_cast<std::size_t>(known - sides.begin()));
    if (known == sides.end()) sides.push_back(n);
  }
  if (sides.size() < 2) return {climb_to_medial_ball(surface, x)};

  // Below each side, and as deep below those that meet it in a convex edge.
  std::vector<Vec<3>> inward;
  std::vector<MedialBall> balls;
  std::vector<char> convex(sides.size());
  for (std::size_t i = 0; i < sides.size(); ++i) {
    const Vec<3> below = foot - skin * sides[i];
    std::fill(convex.begin(), convex.end(), 0);
    for (std::size_t t = 0; t < touched.size(); ++t)
      if (side_of[t] != i &&
          surface.nearest_on_facet(below, touched[t].facet).distance2 < kDeep * kDeep * skin * skin)
        convex[side_of[t]] = 1;
    Vec<3> u = -sides[i];
    for (std::size_t k = 0; k < sides.size(); ++k)
      if (convex[k]) u -= sides[k];
    if (std::any_of(inward.begin(), inward.end(),
                    [&](const Vec<3>& v) { return (u - v).norm() < 1e-6; }))
      continue;
    const Vec<3> y = foot + skin * u;
    const auto s = surface.signed_nearest(y);
    if (s.distance > -kDeep * skin) continue;
    inward.push_back(u);
    balls.push_back(climb(surface, {y, s.foot, true}));
  }
  if (balls.size() < 2) return {climb_to_medial_ball(surface, x)};
  return balls;
}

}  // namespace lamella
