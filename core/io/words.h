#pragma once

#include <charconv>
#include <cstdint>
#include <string>
#include <string_view>
#include <type_traits>

namespace lamella {

/// Builds text fast: integers, and doubles by the shortest digits that read back to the same value.
class TextBuilder {
 public:
  TextBuilder& operator<<(std::string_view text) {
    text_ += text;
    return *this;
  }
  TextBuilder& operator<<(char c) {
    text_ += c;
    return *this;
  }
  template <class T>
  requires std::is_arithmetic_v<T> TextBuilder& operator<<(T value) {
    char digits[32];
    const auto end = std::to_chars(digits, digits + sizeof digits, value).ptr;
    text_.append(digits, end);
    return *this;
  }
  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

/// Words of a text separated by white space; '#' comments to the end of the line.
class Words {
 public:
  explicit Words(std::string_view text) : text_(text) {}

  /// Empty at the end of the text.
  std::string_view next();
  /// The word that next() will return.
  std::string_view peek();
  /// Reads a number; false at the end or when the word is not one (see `last`).
  bool read(double& value);
  bool read(std::int64_t& value);
  /// The word read last, for messages.
  std::string_view last() const { return last_; }
  /// Line of the word read last, from 1.
  std::size_t line() const;
  /// Characters of the whole text.
  std::size_t size() const { return text_.size(); }
  /// Characters read so far over all, in [0, 1].
  double fraction() const {
    return text_.empty() ? 1 : static_cast<double>(at_) / static_cast<double>(text_.size());
  }

 private:
  std::string_view text_;
  std::size_t at_ = 0;
  std::string_view last_;
};

}  // namespace lamella
