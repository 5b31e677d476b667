#include "app/cli_groups.h"

#include "app/cli_text.h"

namespace lamella::cli {

namespace {

std::vector<std::string> parts_of(const std::string& text) {
  std::vector<std::string> parts(1);
  for (const char c : text) {
    if (c == ',')
      parts.emplace_back();
    else
      parts.back() += c;
  }
  return parts;
}

}  // namespace

Result<BoundaryGroup> read_group(const std::string& text) {
  const Error misread{
      Code::usage, "--group " + text + " is not understood.",
      "Write it as NAME=BODY:FACE,FACE or NAME=BODY:X,Y,Z~ANGLE, lengths in mm and the angle in "
      "radians. BODY: may be left out where there is one body."};
  const std::size_t equals = text.find('=');
  if (equals == text.npos || equals == 0 || equals + 1 == text.size()) return misread;
  BoundaryGroup group;
  group.name = text.substr(0, equals);
  group.kind = group_kind_of(group.name);
  // Names of bodies may have a colon too.
  const std::size_t colon = text.rfind(':');
  const bool body = colon != text.npos && colon > equals;
  if (body) group.body = text.substr(equals + 1, colon - equals - 1);
  const std::string what = text.substr((body ? colon : equals) + 1);
  if (const std::size_t tilde = what.rfind('~'); tilde != what.npos) {
    const std::vector<std::string> coordinates = parts_of(what.substr(0, tilde));
    const auto angle = read_number<double>(std::string_view(what).substr(tilde + 1));
    if (coordinates.size() != 3 || !angle) return misread;
    Flood flood;
    flood.angle = *angle;
    for (int k = 0; k < 3; ++k) {
      const auto x = read_number<double>(coordinates[static_cast<std::size_t>(k)]);
      if (!x) return misread;
      flood.point[k] = *x;
    }
    group.floods.push_back(flood);
    return group;
  }
  for (const std::string& face : parts_of(what)) {
    if (face.empty()) return misread;
    if (const auto id = read_number<std::int32_t>(face))
      group.faces.push_back(*id);
    else
      group.face_names.push_back(face);
  }
  return group;
}

}  // namespace lamella::cli
