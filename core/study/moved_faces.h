#pragma once

#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/study/study.h"

namespace lamella {

/// What a face is known by.
struct FaceLook {
  double area = 0;                 ///< mm^2
  Vec<3> center = Vec<3>::Zero();  ///< of its area, mm
  Vec<3> normal = Vec<3>::Zero();  ///< mean by area

  bool operator==(const FaceLook&) const = default;
};

/// How the faces of a part were, in order of their numbers.
struct KnownFaces {
  std::string part;
  double diagonal = 0;  ///< of its box, mm
  std::vector<FaceLook> faces;

  bool operator==(const KnownFaces&) const = default;
};

/// Of the parts on which the study asks for faces by number.
std::vector<KnownFaces> known_faces(const Study& study, const std::vector<Part>& parts);

/// As JSON, and back. Error: bad_input.
std::string known_faces_json(const std::vector<KnownFaces>& known);
Result<std::vector<KnownFaces>> known_faces_from(const std::string& json);

/// Makes what the study asks of faces by number name the same places of parts that were read again:
/// the numbers of CAD faces change with the model. A face goes to the one of its part most like it
/// in place, area and direction; those of parts that are not known stay as they are. What has
/// no such face is left out. Returns notes that tell of it, one a face.
std::vector<std::string> move_faces(Study& study, const std::vector<KnownFaces>& before,
                                    const std::vector<Part>& after);

}  // namespace lamella
