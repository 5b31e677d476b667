#include "app/cli_sizing.h"

#include <algorithm>

#include "app/cli_text.h"

namespace lamella::cli {

namespace {

/// "0.3" is a size in mm, "0.3x" a factor of the natural size.
bool read_size(std::string_view text, SizeCorrection& correction) {
  const bool factor = !text.empty() && text.back() == 'x';
  if (factor) text.remove_suffix(1);
  (factor ? correction.factor : correction.size) = read_number<double>(text);
  return (factor ? correction.factor : correction.size).has_value();
}

/// One kind of option: how many numbers come before the size, and the shape they make.
struct Kind {
  const char* name;
  const char* form;
  int numbers;
  SizingShape (*shape)(const std::vector<double>&);
};
constexpr Kind kSphere = {"sphere", "X,Y,Z,R,SIZE", 4,
                          [](const std::vector<double>& v) -> SizingShape {
                            return SphereShape{{v[0], v[1], v[2]}, v[3]};
                          }};
constexpr Kind kBox = {"box", "X,Y,Z,X,Y,Z,SIZE", 6,
                       [](const std::vector<double>& v) -> SizingShape {
                         const Vec<3> a(v[0], v[1], v[2]), b(v[3], v[4], v[5]);
                         BoxShape box;
                         box.center = 0.5 * (a + b);
                         box.size = (a - b).cwiseAbs();
                         return box;
                       }};
constexpr Kind kCylinder = {"cylinder", "X,Y,Z,X,Y,Z,R,SIZE", 7,
                            [](const std::vector<double>& v) -> SizingShape {
                              return CylinderShape{{v[0], v[1], v[2]}, {v[3], v[4], v[5]}, v[6]};
                            }};

Error misread(const std::string& name, const std::string& form, const std::string& text) {
  return {Code::usage, "--size-" + name + " " + text + " is not understood.",
          "Write it as " + form +
              ", lengths in mm; SIZE is a size, or with an x behind it a factor "
              "of the natural one, as 0.3x."};
}

Result<SizingObject> with_numbers(const Kind& kind, const std::string& text,
                                  const SizeCorrection& asked) {
  std::vector<double> values;
  std::string_view rest = text;
  for (int i = 0; i < kind.numbers; ++i) {
    const std::size_t comma = rest.find(',');
    const auto value = read_number<double>(rest.substr(0, comma));
    if (comma == rest.npos || !value) return misread(kind.name, kind.form, text);
    values.push_back(*value);
    rest.remove_prefix(comma + 1);
  }
  SizeCorrection correction = asked;
  if (!read_size(rest, correction)) return misread(kind.name, kind.form, text);
  return SizingObject{std::string(kind.name) + " " + text, "", kind.shape(values), correction};
}

Result<SizingObject> on_face(const std::string& text, const SizeCorrection& asked) {
  const std::size_t comma = text.rfind(',');
  SizeCorrection correction = asked;
  if (comma == text.npos || comma == 0 ||
      !read_size(std::string_view(text).substr(comma + 1), correction))
    return misread("face", "BODY:FACE,SIZE", text);
  // Names of bodies may have a colon too.
  const std::size_t colon = text.rfind(':', comma);
  const std::string face =
      colon == text.npos ? text.substr(0, comma) : text.substr(colon + 1, comma - colon - 1);
  FacesShape shape;
  if (const auto id = read_number<std::int32_t>(face))
    shape.ids = {*id};
  else
    shape.names = {face};
  return SizingObject{"face " + text, colon == text.npos ? "" : text.substr(0, colon), shape,
                      correction};
}

/// "0.5,3", "0.5,3,part:2,lid", "0.5,3,part:-2,-lid".
Result<SizingObject> boundary_layer(const std::string& text) {
  const Error misread{
      Code::usage, "--boundary-layer " + text + " is not understood.",
      "Write it as THICKNESS,N or THICKNESS,N,BODY:FACE,.., a minus before each face "
      "that shall have none."};
  const std::size_t first = text.find(','), second = text.find(',', first + 1);
  if (first == text.npos) return misread;
  const auto thickness = read_number<double>(std::string_view(text).substr(0, first));
  const auto layers =
      read_number<int>(std::string_view(text).substr(first + 1, second - first - 1));
  if (!thickness || !layers) return misread;
  SizingObject object{"boundary layer " + text, "", WholeBody{},
                      BoundaryLayer{*thickness, *layers}};
  if (second == text.npos) return object;
  // Names of bodies may have a colon too.
  const std::size_t colon = text.rfind(':');
  if (colon == text.npos || colon < second) return misread;
  object.body = text.substr(second + 1, colon - second - 1);
  FacesShape faces;
  faces.others = text[colon + 1] == '-';
  for (std::size_t begin = colon + 1; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    std::string face = text.substr(begin, end - begin);
    if (faces.others != (!face.empty() && face[0] == '-')) return misread;
    if (faces.others) face.erase(0, 1);
    if (face.empty()) return misread;
    if (const auto id = read_number<std::int32_t>(face))
      faces.ids.push_back(*id);
    else
      faces.names.push_back(face);
    begin = end + 1;
  }
  object.shape = faces;
  return object;
}

}  // namespace

Result<std::vector<SizingObject>> sizing_of(const MeshCommand& c) {
  SizeCorrection asked;
  if (c.size_gradation) asked.gradation = *c.size_gradation;
  asked.keep_directions = c.size_keep_directions;
  std::vector<SizingObject> objects;
  const auto add = [&](const std::vector<std::string>& texts, auto read) -> std::optional<Error> {
    for (const std::string& text : texts) {
      Result<SizingObject> object = read(text);
      if (!object) return object.error();
      objects.push_back(std::move(*object));
    }
    return std::nullopt;
  };
  const auto numbers = [&](const Kind& kind) {
    return [&](const std::string& text) { return with_numbers(kind, text, asked); };
  };
  if (auto error = add(c.size_spheres, numbers(kSphere))) return *error;
  if (auto error = add(c.size_boxes, numbers(kBox))) return *error;
  if (auto error = add(c.size_cylinders, numbers(kCylinder))) return *error;
  if (auto error = add(c.size_faces, [&](const std::string& t) { return on_face(t, asked); }))
    return *error;
  if (auto error = add(c.boundary_layers, boundary_layer)) return *error;
  return objects;
}

}  // namespace lamella::cli
