#include "core/study/moved_faces.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "core/geometry/triangles.h"
#include "core/study/json_members.h"

namespace lamella {
namespace {

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
std::vector<std::int32_t> matches(const KnownFaces& before, const ReferenceSurface<3>& after) {
  const std::vector<FaceLook>&old_looks = before.faces, looks = looks_of(after);
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
  const double far = 0.25 * before.diagonal;
  for (std::size_t k = 0; k < found.size(); ++k)
    if (found[k] < 0) find(k, far, true);
  return found;
}

/// Calls `visit(who, body, ids)` for each list of face numbers of the study.
template <class AStudy, class Visit>
void each_list(AStudy& study, const Visit& visit) {
  for (auto& group : study.groups) visit("Group \"" + group.name + "\"", group.body, group.faces);
  for (auto& object : study.sizing)
    if (auto* faces = std::get_if<FacesShape>(&object.shape))
      visit("Size \"" + object.name + "\"", object.body, faces->ids);
}

/// The one part there is where `body` is empty.
const Part* part_called(const std::vector<Part>& parts, const std::string& body) {
  const auto at = std::find_if(parts.begin(), parts.end(), [&](const Part& part) {
    return part.name == body || (body.empty() && parts.size() == 1);
  });
  return at == parts.end() ? nullptr : &*at;
}

}  // namespace

std::vector<KnownFaces> known_faces(const Study& study, const std::vector<Part>& parts) {
  std::vector<KnownFaces> known;
  each_list(study, [&](const std::string&, const std::string& body,
                       const std::vector<std::int32_t>& ids) {
    const Part* part = ids.empty() ? nullptr : part_called(parts, body);
    if (!part || std::any_of(known.begin(), known.end(),
                             [&](const KnownFaces& k) { return k.part == part->name; }))
      return;
    known.push_back({part->name, diagonal_of(part->surface.points), looks_of(part->surface)});
  });
  return known;
}

std::string known_faces_json(const std::vector<KnownFaces>& known) {
  Json all = Json::array();
  for (const KnownFaces& k : known) {
    Json faces = Json::array();
    for (const FaceLook& look : k.faces)
      faces.push_back({look.area, look.center[0], look.center[1], look.center[2], look.normal[0],
                       look.normal[1], look.normal[2]});
    all.push_back({{"part", k.part}, {"diagonal", k.diagonal}, {"faces", std::move(faces)}});
  }
  return all.dump();
}

Result<std::vector<KnownFaces>> known_faces_from(const std::string& json) {
  const Error damaged{Code::bad_input, "What it tells of faces is not in its form.", ""};
  const Json all = Json::parse(json, nullptr, false);
  if (!all.is_array()) return damaged;
  std::vector<KnownFaces> known;
  for (const Json& item : all) {
    KnownFaces k;
    if (!item.is_object() || !item.contains("part") || !item["part"].is_string() ||
        !item.contains("diagonal") || !item["diagonal"].is_number() || !item.contains("faces") ||
        !item["faces"].is_array())
      return damaged;
    k.part = item["part"].get<std::string>();
    k.diagonal = item["diagonal"].get<double>();
    for (const Json& face : item["faces"]) {
      if (!face.is_array() || face.size() != 7 ||
          !std::all_of(face.begin(), face.end(), [](const Json& x) { return x.is_number(); }))
        return damaged;
      const auto at = [&](std::size_t i) { return face[i].get<double>(); };
      k.faces.push_back({at(0), {at(1), at(2), at(3)}, {at(4), at(5), at(6)}});
    }
    known.push_back(std::move(k));
  }
  return known;
}

std::vector<std::string> move_faces(Study& study, const std::vector<KnownFaces>& before,
                                    const std::vector<Part>& after) {
  std::vector<std::string> notes;
  std::map<std::string, std::vector<std::int32_t>> known;  // by part
  each_list(
      study, [&](const std::string& who, const std::string& body, std::vector<std::int32_t>& ids) {
        const Part* part = ids.empty() ? nullptr : part_called(after, body);
        if (!part) return;
        const auto old_part = std::find_if(before.begin(), before.end(), [&](const KnownFaces& k) {
          return k.part == part->name;
        });
        if (old_part == before.end()) return;
        const auto [at, first] = known.try_emplace(part->name);
        if (first) at->second = matches(*old_part, part->surface);
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
      });
  return notes;
}

}  // namespace lamella
