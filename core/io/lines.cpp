#include "core/io/lines.h"

#include <algorithm>
#include <charconv>

namespace lamella {

bool Lines::next(std::string_view& line) {
  if (at_ >= text_.size()) return false;
  begin_ = at_;
  ++number_;
  const std::size_t end = std::min(text_.find('\n', at_), text_.size());
  line = text_.substr(at_, end - at_);
  at_ = std::min(end + 1, text_.size());
  if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
  return true;
}

std::string_view trimmed(std::string_view text) {
  const auto is_blank = [](char c) { return static_cast<unsigned char>(c) <= ' '; };
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

std::string_view columns(std::string_view line, std::size_t at, std::size_t width) {
  return at < line.size() ? trimmed(line.substr(at, width)) : std::string_view{};
}

std::vector<std::string_view> between_commas(std::string_view line) {
  std::vector<std::string_view> parts;
  for (;;) {
    const std::size_t comma = line.find(',');
    parts.push_back(trimmed(line.substr(0, comma)));
    if (comma == line.npos) return parts;
    line.remove_prefix(comma + 1);
  }
}

bool parse(std::string_view text, double& value) {
  text = trimmed(text);
  if (text.size() > 1 && text[0] == '+') text.remove_prefix(1);
  const char* const end = text.data() + text.size();
  const auto [stop, ec] = std::from_chars(text.data(), end, value);
  if (ec == std::errc{} && stop == end) return true;
  if (ec != std::errc{}) return false;
  // What is left is an exponent in another spelling.
  const char* at = stop;
  if (*at == 'D' || *at == 'd') ++at;
  if (at != end && *at == '+') ++at;
  int exponent = 0;
  const auto [last, bad] = std::from_chars(at, end, exponent);
  if (bad != std::errc{} || last != end || at == end) return false;
  // Through text once more, since a power of ten times the digits would round twice.
  char spelled[64];
  const auto digits = static_cast<std::size_t>(stop - text.data());
  if (digits > 40) return false;
  char* to = std::copy_n(text.data(), digits, spelled);
  *to++ = 'e';
  to = std::to_chars(to, spelled + sizeof spelled, exponent).ptr;
  return std::from_chars(spelled, to, value).ec == std::errc{};
}

bool parse(std::string_view text, std::int64_t& value) {
  text = trimmed(text);
  if (text.size() > 1 && text[0] == '+') text.remove_prefix(1);
  const auto [stop, ec] = std::from_chars(text.data(), text.data() + text.size(), value);
  return ec == std::errc{} && stop == text.data() + text.size();
}

}  // namespace lamella
