#pragma once

#include <cstdint>
#include <cstring>
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
