#pragma once

#include <algorithm>
#include <cstdlib>
#include <random>
#include <string>
#include <string_view>

namespace lamella::test {

/// Damaged files that a test tries; more of them when LAMELLA_DAMAGES says so.
inline int damage_rounds(int usual) {
  const char* asked = std::getenv("LAMELLA_DAMAGES");
  return asked != nullptr ? std::max(1, std::atoi(asked)) : usual;
}

/// The bytes with one to three damages: bytes changed, a number replaced by one that is out of any
/// range, a line left out, repeated or moved, a stretch left out, the end cut off. The same of the
/// same state of `random`.
inline std::string damaged(std::string bytes, std::mt19937& random) {
  const auto below = [&](std::size_t n) { return n == 0 ? 0 : random() % n; };
  const auto line_at = [&](std::size_t at) {
    const std::size_t before = at == 0 ? std::string::npos : bytes.rfind('\n', at - 1);
    const std::size_t begin = before == std::string::npos ? 0 : before + 1;
    const std::size_t end = bytes.find('\n', begin);
    return std::pair(begin, end == std::string::npos ? bytes.size() : end + 1);
  };
  const std::size_t times = 1 + below(3);
  for (std::size_t k = 0; k < times && !bytes.empty(); ++k) {
    const std::size_t at = below(bytes.size());
    const auto [begin, end] = line_at(at);
    switch (below(7)) {
      case 0:
        for (std::size_t n = 1 + below(4); n > 0; --n)
          bytes[below(bytes.size())] = static_cast<char>(random());
        break;
      case 1: {
        constexpr std::string_view digits = "0123456789.+-eE";
        const std::size_t first = bytes.find_first_of("0123456789", at);
        if (first == std::string::npos) break;
        const std::size_t last = std::min(bytes.find_first_not_of(digits, first), bytes.size());
        constexpr const char* odd[] = {"-1",          "0",   "4294967297", "99999999999999",
                                       "nan",         "inf", "1e999",      "2147483647",
                                       "-2147483648", "",    "1e-5",       "7"};
        bytes.replace(first, last - first, odd[below(std::size(odd))]);
        break;
      }
      case 2:
        bytes.erase(begin, end - begin);
        break;
      case 3:
        bytes.insert(begin, bytes.substr(begin, std::min<std::size_t>(end - begin, 400)));
        break;
      case 4: {
        const std::string line = bytes.substr(begin, end - begin);
        bytes.erase(begin, end - begin);
        bytes.insert(line_at(below(bytes.size() + 1)).first, line);
        break;
      }
      case 5:
        bytes.erase(at, 1 + below(40));
        break;
      default:
        bytes.resize(at);
        break;
    }
  }
  return bytes;
}

}  // namespace lamella::test
