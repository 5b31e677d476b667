#pragma once

#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace lamella {

/// Values as bytes for another process of this program on this machine: the layout is that of
/// memory, and no file has it.
class ByteWriter {
 public:
  template <class T>
  void value(const T& v) {
    static_assert(std::is_trivially_copyable_v<T>);
    bytes_.append(reinterpret_cast<const char*>(&v), sizeof v);
  }
  /// Elements without pointers: numbers, arrays and vectors of fixed size.
  template <class T>
  void array(const std::vector<T>& values) {
    static_assert(std::is_trivially_destructible_v<T>);
    value(static_cast<std::uint64_t>(values.size()));
    bytes_.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
  }
  void text(const std::string& s) {
    value(static_cast<std::uint64_t>(s.size()));
    bytes_ += s;
  }
  /// Calls each(element) to write every one.
  template <class List, class Each>
  void list(const List& elements, Each each) {
    value(static_cast<std::uint64_t>(elements.size()));
    for (const auto& element : elements) each(element);
  }
  template <class T, class Write>
  void maybe(const std::optional<T>& thing, Write write) {
    value(thing.has_value());
    if (thing) write(*thing);
  }
  std::string take() { return std::move(bytes_); }

 private:
  std::string bytes_;
};

/// Reads what a ByteWriter wrote, in the same order. Past the end nothing is read and `ok` is false
/// from then on.
class ByteReader {
 public:
  explicit ByteReader(std::string_view bytes) : bytes_(bytes) {}

  template <class T>
  void value(T& v) {
    static_assert(std::is_trivially_copyable_v<T>);
    if (fits(1, sizeof v)) std::memcpy(&v, next(sizeof v), sizeof v);
  }
  template <class T>
  void array(std::vector<T>& values) {
    static_assert(std::is_trivially_destructible_v<T>);
    const std::uint64_t n = count(sizeof(T));
    values.resize(n);
    if (n > 0) std::memcpy(static_cast<void*>(values.data()), next(n * sizeof(T)), n * sizeof(T));
  }
  void text(std::string& s) {
    const std::uint64_t n = count(1);
    s.assign(next(n), n);
  }
  /// Elements that take at least eight bytes each.
  template <class List, class Each>
  void list(List& elements, Each each) {
    elements.resize(count(sizeof(std::uint64_t)));
    for (auto& element : elements) each(element);
  }
  template <class T, class Read>
  void maybe(std::optional<T>& thing, Read read) {
    bool there = false;
    value(there);
    if (there) read(thing.emplace());
  }
  /// A number of things to come that take at least `bytes` each; 0 when so many cannot come.
  std::uint64_t count(std::size_t bytes) {
    std::uint64_t n = 0;
    value(n);
    return fits(n, bytes) ? n : 0;
  }
  bool ok() const { return ok_; }
  /// All was read, and nothing is left.
  bool done() const { return ok_ && bytes_.empty(); }

 private:
  bool fits(std::uint64_t n, std::size_t bytes) {
    ok_ = ok_ && bytes_.size() / bytes >= n;
    return ok_;
  }
  const char* next(std::size_t n) {
    const char* at = bytes_.data();
    bytes_.remove_prefix(n);
    return at;
  }

  std::string_view bytes_;
  bool ok_ = true;
};

}  // namespace lamella
