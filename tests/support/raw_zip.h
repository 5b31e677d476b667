#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace lamella::test {

/// An entry of a zip as someone may write it who means no good.
struct RawEntry {
  std::string name, bytes{};
  std::uint32_t mode = 0100644;  ///< of Unix
  std::uint16_t flags = 0;       ///< 1: encrypted
  std::uint16_t method = 0;      ///< 0: stored
};

/// The bytes of a zip with these entries, stored, one after another; nothing is checked.
inline std::string raw_zip(const std::vector<RawEntry>& entries) {
  const auto put = [](std::string& out, std::uint64_t value, int bytes) {
    for (int k = 0; k < bytes; ++k) out.push_back(static_cast<char>(value >> (8 * k)));
  };
  const auto crc_of = [](const std::string& bytes) {
    std::uint32_t crc = ~0u;
    for (const char c : bytes) {
      crc ^= static_cast<unsigned char>(c);
      for (int k = 0; k < 8; ++k) crc = crc & 1 ? crc >> 1 ^ 0xedb88320u : crc >> 1;
    }
    return ~crc;
  };
  std::string out, list;
  for (const RawEntry& entry : entries) {
    std::string common;  // of the header and of the list
    put(common, entry.flags, 2);
    put(common, entry.method, 2);
    put(common, 0, 2);
    put(common, 33, 2);  // 1980-01-01
    put(common, crc_of(entry.bytes), 4);
    put(common, entry.bytes.size(), 4);
    put(common, entry.bytes.size(), 4);
    put(common, entry.name.size(), 2);
    put(common, 0, 2);
    list += "PK\x01\x02";
    put(list, 3 << 8 | 20, 2);
    put(list, 20, 2);
    list += common;
    put(list, 0, 6);
    put(list, std::uint64_t{entry.mode} << 16, 4);
    put(list, out.size(), 4);
    list += entry.name;
    out += "PK\x03\x04";
    put(out, 20, 2);
    out += common + entry.name + entry.bytes;
  }
  const std::size_t at = out.size();
  out += list + "PK\x05\x06";
  put(out, 0, 4);
  put(out, entries.size() & 0xffff, 2);
  put(out, entries.size() & 0xffff, 2);
  put(out, list.size(), 4);
  put(out, at, 4);
  put(out, 0, 2);
  return out;
}

}  // namespace lamella::test
