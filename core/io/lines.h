#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

namespace lamella {

/// Lines of a text, without their ends.
class Lines {
 public:
  explicit Lines(std::string_view text) : text_(text) {}

  /// False at the end of the text.
  bool next(std::string_view& line);
  /// The next call of `next` gives the same line again.
  void back() { at_ = begin_, --number_; }
  /// Number of the line read last, from 1.
  std::size_t number() const { return number_; }
  double fraction() const {
    return text_.empty() ? 1 : static_cast<double>(at_) / static_cast<double>(text_.size());
  }

 private:
  std::string_view text_;
  std::size_t at_ = 0, begin_ = 0, number_ = 0;
};

/// Without blanks at both ends.
std::string_view trimmed(std::string_view text);
/// Up to `width` characters from column `at` (from 0), without blanks at both ends.
std::string_view columns(std::string_view line, std::size_t at, std::size_t width);
/// The parts of a line between commas, without blanks at both ends.
std::vector<std::string_view> between_commas(std::string_view line);

/// The whole text is a number, apart from blanks around it. The exponent may begin with D, or as in
/// Nastran with its sign alone (1.5-3).
bool parse(std::string_view text, double& value);
bool parse(std::string_view text, std::int64_t& value);

}  // namespace lamella
