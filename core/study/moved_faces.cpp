#include "core/study/moved_faces.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "core/geometry/triangles.h"

namespace lamella {
namespace {

/// What a face is known by.
struct FaceLook {
  double area = 0;
  Vec<3> center = Vec<3>::Zero();  // of its area
  Vec<3> normal = Vec<3>::Zero();  // mean by area
};

std::vector<FaceLook> looks_of(const ReferenceSurface<3>& surface) {
  std::vector<FaceLook> looks(surface.faces.size());
  for (std::size_t f = 0; f < surface.facets.size(); ++f) {
    std::array<Vec<3>, 3> p;
    for (std::size_t k = 0; k < 3; ++k)
      p[k] = surface.points[static_cast<std::size_t>(surface.facets[f][k])];
    const Vec<3> normal = 0.5 * (p[1] - p[0]).cross(p[2] - p[0]);
    FaceLook& look = looks[static_cast<std::size_t>(surface.facet_face[f])];
    look.area += normal.norm();
    look.center += normal.norm() * (p[0] + p[1] + p[2]) / 3;
    look.normal += normal;
  }
  for (FaceLook& look : looks)
    if (look.area > 0) {
      look.center /= look.area;
      look.normal /= look.area;
    }
  return looks;
}

/// 0: the same; 1 and more: another one. `reach`: mm that a face may have moved.
double unlikeness(const FaceLook& a, const FaceLook& b, double reach) {
  if (a.area <= 0 || b.area <= 0) return 1;
  return (a.center - b.center).norm() / reach + std::abs(std::log(a.area / b.area)) / std::log(4) +
         2 * (a.normal - b.normal).norm();
}

/// [face before] the face it is after; -1: none.
std::vector<std::int32_t> matches(const ReferenceSurface<3>& before,
                                  const ReferenceSurface<3>& after) {
  const std::vector<FaceLook> old_looks = looks_of(before), looks = looks_of(after);
  std::vector<std::int32_t> found(old_looks.size(), -1);
  std::vector<bool> taken(looks.size());
  const auto find = [&](std::size_t k, double reach, bool free) {
    double least = 1;
    for (std::size_t m = 0; m < looks.size(); ++m)
      if (const double other = unlikeness(old_looks[k], looks[m], reach);
          other < least && !(free && taken[m])) {
        least = other;
        found[k] = static_cast<std::int32_t>(m);
      }
  };
  for (std::size_t k = 0; k < found.size(); ++k) find(k, 0.5 * std::sqrt(old_looks[k].area), false);
  for (const std::int32_t m : found)
    if (m >= 0) taken[static_cast<std::size_t>(m)] = true;
  // A face that is nowhere near may have moved along with a wall: it is one that no other has
  // become.
  const double far = 0.25 * diagonal_of(before.points);
  for (std::size_t k = 0; k < found.size(); ++k)
    if (found[k] < 0) find(k, far, true);
  return found;
}

}  // namespace

std::vector<std::string> move_faces(Study& study, const std::vector<Part>& before,
                                    const std::vector<Part>& after) {
  std::vector<std::string> notes;
  std::map<std::string, std::vector<std::int32_t>> known;  // by part
  const auto move = [&](const std::string& who, const std::string& body,
                        std::vector<std::int32_t>& ids) {
    if (ids.empty()) return;
    const auto called = [&](const std::vector<Part>& parts) {
      return std::find_if(parts.begin(), parts.end(), [&](const Part& part) {
        return part.name == body || (body.empty() && parts.size() == 1);
      });
    };
    const auto old_part = called(before), part = called(after);
    if (old_part == before.end() || part == after.end()) return;
    const auto [at, first] = known.try_emplace(part->name);
    if (first) at->second = matches(old_part->surface, part->surface);
    std::vector<std::int32_t> moved;
    for (const std::int32_t id : ids) {
      const bool there = id >= 0 && static_cast<std::size_t>(id) < at->second.size();
      const std::int32_t now = there ? at->second[static_cast<std::size_t>(id)] : -1;
      if (now < 0)
        notes.push_back(who + ": \"" + part->name + "\" has no face like number " +
                        std::to_string(id) + " any more.");
      else if (std::find(moved.begin(), moved.end(), now) == moved.end())
        moved.push_back(now);
    }
    ids = std::move(moved);
  };
  for (BoundaryGroup& group : study.groups)
    move("Group \"" + group.name + "\"", group.body, group.faces);
  for (SizingObject& object : study.sizing)
    if (auto* faces = std::get_if<FacesShape>(&object.shape))
      move("Size \"" + object.name + "\"", object.body, faces->ids);
  return notes;
}

}  // namespace lamella
