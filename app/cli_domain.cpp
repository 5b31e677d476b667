#include "app/cli_domain.h"

#include <vector>

#include "app/cli_text.h"

namespace lamella::cli {

namespace {

/// Empty when one of them is no number.
std::vector<double> numbers_of(const std::string& text) {
  std::vector<double> numbers;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    const std::optional<double> number =
        read_number<double>(std::string_view(text).substr(begin, end - begin));
    if (!number) return {};
    numbers.push_back(*number);
    begin = end + 1;
  }
  return numbers;
}

}  // namespace

Result<StudyDomain> domain_of(const std::string& text) {
  const std::size_t equals = text.find('=');
  const std::string kind = text.substr(0, equals);
  const std::string value = equals == std::string::npos ? "" : text.substr(equals + 1);
  const std::vector<double> n = value.empty() ? std::vector<double>{} : numbers_of(value);
  const auto point = [&](std::size_t first) {
    return Vec<3>(n[first], n[first + 1], n[first + 2]);
  };
  if (kind == "bodies" && equals == std::string::npos) return StudyDomain{DomainBodies{}};
  if (kind == "margin" && equals == std::string::npos) return StudyDomain{DomainMargin{}};
  if (kind == "margin" && n.size() == 1 && n[0] > 0) return StudyDomain{DomainMargin{n[0]}};
  if (kind == "body" && !value.empty()) return StudyDomain{DomainBody{value}};
  if (kind == "box" && n.size() == 6 && (point(3) - point(0)).minCoeff() > 0)
    return StudyDomain{ZoneBox{point(0), point(3)}};
  if (kind == "cylinder" && n.size() == 7 && n[6] > 0 && point(0) != point(3))
    return StudyDomain{ZoneCylinder{point(0), point(3), n[6]}};
  return Error{
      Code::usage, "--domain \"" + text + "\" is not understood.",
      "Give bodies, margin, margin=SHARE, body=NAME, box=X,Y,Z,X,Y,Z with the lower corner "
      "first, or cylinder=X,Y,Z,X,Y,Z,R."};
}

}  // namespace lamella::cli
