#include "core/multidomain/partition.h"

namespace lamella {

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
  return regions_[k].zone->at(x);
}

template <int D>
int Partition<D>::region_of(const Vec<D>& x) const {
  for (int k = 0; k < background(); ++k)
    if (zone_at(k, x, 0).distance < 0) return k;
  return background();
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
  ZoneDistance<D> taken;
  for (int k = 0; k < background(); ++k) {
    const ZoneDistance<D> own = zone_at(k, x, reach);
    if (own.distance < 0)
      return -own.distance < taken.distance ? ZoneDistance<D>{-own.distance, own.normal} : taken;
    if (own.distance < taken.distance) taken = own;
  }
  return taken;
}

template class Partition<2>;
template class Partition<3>;

}  // namespace lamella
