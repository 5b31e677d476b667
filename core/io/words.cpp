#include "core/io/words.h"

#include <algorithm>
#include <cstdlib>

namespace lamella {
namespace {

bool is_space(char c) { return static_cast<unsigned char>(c) <= ' '; }

}  // namespace

std::string_view Words::next() {
  for (;;) {
    while (at_ < text_.size() && is_space(text_[at_])) ++at_;
    if (at_ >= text_.size() || text_[at_] != '#') break;
    while (at_ < text_.size() && text_[at_] != '\n') ++at_;
  }
  const std::size_t begin = at_;
  while (at_ < text_.size() && !is_space(text_[at_])) ++at_;
  return last_ = text_.substr(begin, at_ - begin);
}

std::string_view Words::peek() {
  const std::size_t at = at_;
  const std::string_view last = last_, word = next();
  at_ = at;
  last_ = last;
  return word;
}

bool Words::read(double& value) {
  std::string_view word = next();
  if (word.size() > 1 && word[0] == '+') word.remove_prefix(1);
  const auto r = std::from_chars(word.data(), word.data() + word.size(), value);
  if (r.ec == std::errc::result_out_of_range) {
    // Too small or too large for a double: zero or infinity, as strtod decides.
    value = std::strtod(std::string(word).c_str(), nullptr);
    return true;
  }
  return r.ec == std::errc{} && r.ptr == word.data() + word.size();
}

bool Words::read(std::int64_t& value) {
  std::string_view word = next();
  if (word.size() > 1 && word[0] == '+') word.remove_prefix(1);
  const auto r = std::from_chars(word.data(), word.data() + word.size(), value);
  return r.ec == std::errc{} && r.ptr == word.data() + word.size();
}

std::size_t Words::line() const {
  const auto begin = text_.begin();
  const auto end = last_.data() == nullptr ? begin : begin + (last_.data() - text_.data());
  return 1 + static_cast<std::size_t>(std::count(begin, end, '\n'));
}

}  // namespace lamella
