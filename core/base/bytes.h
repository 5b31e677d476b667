#pragma once

#include <cstdint>
#include <cstring>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "core/base/result.h"

namespace lamella {

/// Takes bytes that come one piece after the other.
using ByteSink = std::function<void(const char*, std::size_t)>;
/// Gives the next bytes, as many as asked but at the end; returns how many.
using ByteSource = std::function<std::size_t(char*, std::size_t)>;

/// Values as bytes for another process of this program on this machine: the layout is that of
/// memory, and no file has it.
class ByteWriter {
 public:
  explicit ByteWriter(ByteSink sink) : sink_(std::move(sink)) {}

  template <class T>
  void value(const T& v) {
    static_assert(std::is_trivially_copyable_v<T>);
    sink_(reinterpret_cast<const char*>(&v), sizeof v);
  }
  /// Elements without pointers: numbers, arrays and vectors of fixed size.
  template <class T>
  void array(const std::vector<T>& values) {
    static_assert(std::is_trivially_destructible_v<T>);
    value(static_cast<std::uint64_t>(values.size()));
    sink_(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
  }
  void text(const std::string& s) {
    value(static_cast<std::uint64_t>(s.size()));
    sink_(s.data(), s.size());
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

 private:
  ByteSink sink_;
};

/// All that `write(writer)` writes.
template <class Write>
std::string bytes_of(const Write& write) {
  std::string bytes;
  ByteWriter writer([&](const char* more, std::size_t n) { bytes.append(more, n); });
  write(writer);
  return bytes;
}

/// Reads what a ByteWriter wrote, in the same order. Past the end nothing is read and `ok` is false
/// from then on.
class ByteReader {
 public:
  /// At most `most` bytes are believed to come, so that a wrong length takes no more memory.
  ByteReader(ByteSource source, std::uint64_t most) : source_(std::move(source)), left_(most) {}
  explicit ByteReader(std::string_view bytes)
      : source_([bytes](char* to, std::size_t n) mutable {
          n = bytes.copy(to, n);
          bytes.remove_prefix(n);
          return n;
        }),
        left_(bytes.size()) {}

  template <class T>
  void value(T& v) {
    static_assert(std::is_trivially_copyable_v<T>);
    if (fits(1, sizeof v)) next(&v, sizeof v);
  }
  template <class T>
  void array(std::vector<T>& values) {
    static_assert(std::is_trivially_destructible_v<T>);
    values.resize(count(sizeof(T)));
    next(values.data(), values.size() * sizeof(T));
  }
  void text(std::string& s) {
    s.resize(count(1));
    next(s.data(), s.size());
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
  bool done() {
    char more = 0;
    return ok_ && source_(&more, 1) == 0;
  }

 private:
  bool fits(std::uint64_t n, std::size_t bytes) {
    ok_ = ok_ && left_ / bytes >= n;
    return ok_;
  }
  void next(void* to, std::size_t n) {
    if (n == 0 || !ok_) return;
    ok_ = source_(static_cast<char*>(to), n) == n;
    left_ -= n;
  }

  ByteSource source_;
  std::uint64_t left_;
  bool ok_ = true;
};

/// An error, by either of them.
template <class Io, class E>
void members(Io& io, E& error) requires std::is_same_v<std::remove_const_t<E>, Error> {
  io.value(error.code);
  io.text(error.message);
  io.text(error.hint);
}

}  // namespace lamella
