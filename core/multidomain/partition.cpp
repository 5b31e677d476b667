#include "core/multidomain/partition.h"

namespace lamella {

namespace {

constexpr double kRounding = 1e-9;  // of the coordinates

/// Without a sign, the normal towards the other side.
template <int D>
ZoneDistance<D> facing(const ZoneDistance<D>& own) {
  return own.distance < 0 ? ZoneDistance<D>{-own.distance, own.normal}
                          : ZoneDistance<D>{own.distance, -own.normal};
}

}  // namespace

template <int D>
Partition<D>::Partition(std::vector<Region<D>> regions, std::string background)
    : regions_(std::move(regions)), background_(std::move(background)) {
  for (const Region<D>& region : regions_) boxes_.push_back(region.zone->box());
}

template <int D>
std::vector<std::string> Partition<D>::names() const {
  std::vector<std::string> names;
  for (const Region<D>& region : regions_) names.push_back(region.name);
  names.push_back(background_);
  return names;
}

template <int D>
ZoneDistance<D> Partition<D>::zone_at(int k, const Vec<D>& x, double reach) const {
  const Box<D>& box = boxes_[k];
  const Vec<D> beyond = x - x.cwiseMax(box.lo).cwiseMin(box.hi);
  const double d2 = beyond.squaredNorm();
  if (d2 > reach * reach) {
    const double d = std::sqrt(d2);
    return {d, d < std::numeric_limits<double>::infinity() ? Vec<D>(beyond / d) : Vec<D>::Zero()};
  }
  return regions_[k].zone->within(x, reach);
}

template <int D>
int Partition<D>::region_of(const Vec<D>& x) const {
  int touched = background();
  const double rounding = kRounding * (1 + x.cwiseAbs().maxCoeff());
  for (int k = 0; k < background(); ++k) {
    const double distance = zone_at(k, x, 2 * rounding).distance;
    if (distance < 0) return k;
    if (distance <= rounding && touched == background()) touched = k;
  }
  return touched;
}

template <int D>
ZoneDistance<D> Partition<D>::at(int region, const Vec<D>& x, double reach) const {
  ZoneDistance<D> taken;  // the union of those before
  for (int k = 0; k < region; ++k) {
    const ZoneDistance<D> next = zone_at(k, x, reach);
    if (next.distance < taken.distance) taken = next;
  }
  taken.distance = -taken.distance;
  taken.normal = -taken.normal;
  if (region == background()) return taken;
  const ZoneDistance<D> own = zone_at(region, x, reach);
  return own.distance >= taken.distance ? own : taken;
}

template <int D>
ZoneDistance<D> Partition<D>::border(const Vec<D>& x, double reach) const {
  // What contains x must be left before any other border is met.
  ZoneDistance<D> nearest;
  for (int k = 0; k < background(); ++k) {
    const ZoneDistance<D> own = zone_at(k, x, reach);
    if (std::abs(own.distance) < nearest.distance) nearest = facing(own);
    if (own.distance < 0) break;
  }
  return nearest;
}

template <int D>
void Partition<D>::borders(const Vec<D>& x, double reach, std::vector<Border<D>>& found) const {
  found.clear();
  for (int k = 0; k < background(); ++k) {
    const ZoneDistance<D> own = zone_at(k, x, reach);
    if (std::abs(own.distance) >= reach) continue;
    const Vec<D> foot = x - own.distance * own.normal;
    const double rounding = kRounding * (1 + x.cwiseAbs().maxCoeff());
    bool hidden = false;
    for (int j = 0; j < k && !hidden; ++j) hidden = zone_at(j, foot, 0).distance < -rounding;
    if (!hidden) found.push_back({k, facing(own)});
  }
}

template class Partition<2>;
template class Partition<3>;

}  // namespace lamella
