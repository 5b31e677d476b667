#include "core/study/moved_faces.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/study/zone_surface.h"

namespace lamella {
namespace {

/// A box whose faces are numbered from the last one on where `backwards`.
Part box(const Vec<3>& low, const Vec<3>& high, bool backwards = false) {
  const StudyZone zone{"box", ZoneBox{low, high}};
  const auto surface = zone_surface(zone, {zone}, zone, 0.1);
  EXPECT_TRUE(surface);
  Part part;
  part.name = "box";
  part.surface = *surface;
  if (backwards)
    for (std::int32_t& face : part.surface.facet_face)
      face = static_cast<std::int32_t>(part.surface.faces.size()) - 1 - face;
  return part;
}

/// The face whose facets all lie in the plane where coordinate `axis` is `at`.
std::int32_t face_on(const Part& part, int axis, double at) {
  for (std::size_t f = 0; f < part.surface.facets.size(); ++f) {
    const auto& facet = part.surface.facets[f];
    if (std::all_of(facet.begin(), facet.end(), [&](std::int32_t v) {
          return std::abs(part.surface.points[static_cast<std::size_t>(v)][axis] - at) < 1e-9;
        }))
      return part.surface.facet_face[f];
  }
  return -1;
}

Study asking_for(std::int32_t face) {
  Study study;
  study.groups.push_back({"gate", GroupKind::gate, "box", {face}});
  SizingObject size;
  size.name = "near gate";
  size.body = "box";
  size.shape = FacesShape{{face}};
  study.sizing.push_back(size);
  return study;
}

const std::vector<std::int32_t>& ids_of(const Study& study) {
  return std::get<FacesShape>(study.sizing[0].shape).ids;
}

TEST(MovedFaces, AskForThePlaceNotForTheNumber) {
  const Part before = box({0, 0, 0}, {40, 30, 2});
  // Numbered the other way round, as they are when features come before; then thicker, then longer.
  const Part cases[] = {box({0, 0, 0}, {40, 30, 2}, true), box({0, 0, 0}, {40, 30, 3}, true),
                        box({0, 0, 0}, {50, 30, 2}, true)};
  for (const Part& after : cases)
    for (const auto& [axis, old_at] : {std::pair(0, 40.0), std::pair(1, 0.0), std::pair(2, 2.0)}) {
      const double at = old_at == 0 ? 0 : [&] {
        double highest = 0;
        for (const Vec<3>& p : after.surface.points) highest = std::max(highest, p[axis]);
        return highest;
      }();
      const std::int32_t number = face_on(before, axis, old_at), now = face_on(after, axis, at);
      ASSERT_GE(number, 0);
      ASSERT_GE(now, 0);
      ASSERT_NE(number, now);
      Study study = asking_for(number);
      EXPECT_EQ(move_faces(study, known_faces(study, {before}), {after}),
                std::vector<std::string>{});
      EXPECT_EQ(study.groups[0].faces, std::vector<std::int32_t>{now}) << axis;
      EXPECT_EQ(ids_of(study), std::vector<std::int32_t>{now}) << axis;
    }
}

TEST(MovedFaces, AFaceThatIsGoneIsTold) {
  const Part before = box({0, 0, 0}, {40, 30, 2});
  // Of the side of 30 x 2 a hundredth is left, elsewhere.
  const Part after = box({0, 0, 0}, {3, 0.6, 0.5});
  Study study = asking_for(face_on(before, 0, 40));
  const auto notes = move_faces(study, known_faces(study, {before}), {after});
  ASSERT_EQ(notes.size(), 2u);
  EXPECT_NE(notes[0].find("gate"), std::string::npos);
  EXPECT_TRUE(study.groups[0].faces.empty());
  EXPECT_TRUE(ids_of(study).empty());
}

TEST(MovedFaces, OtherBodiesKeepTheirs) {
  Part other = box({0, 0, 0}, {1, 1, 1});
  other.name = "other";
  Study study = asking_for(2);
  EXPECT_TRUE(move_faces(study, known_faces(study, {other}), {other}).empty());
  EXPECT_EQ(study.groups[0].faces, std::vector<std::int32_t>{2});
}

}  // namespace
}  // namespace lamella
