#include "core/base/png.h"

#include <zlib.h>

namespace lamella {

namespace {

void put(std::string& out, std::uint32_t n) {
  for (int shift = 24; shift >= 0; shift -= 8) out += static_cast<char>(n >> shift & 255);
}

void put_chunk(std::string& out, const std::string& kind, const std::string& data) {
  put(out, static_cast<std::uint32_t>(data.size()));
  const std::string body = kind + data;
  out += body;
  put(out, static_cast<std::uint32_t>(
               crc32(0, reinterpret_cast<const Bytef*>(body.data()), uInt(body.size()))));
}

}  // namespace

std::string png(const Image& image) {
  // Each row as its difference to the one above, which is mostly zero in drawings.
  const std::size_t row = 3 * static_cast<std::size_t>(image.width);
  std::string rows;
  rows.reserve((row + 1) * static_cast<std::size_t>(image.height));
  for (std::size_t y = 0; y < static_cast<std::size_t>(image.height); ++y) {
    rows += '\2';
    for (std::size_t x = 0; x < row; ++x) {
      const int above = y > 0 ? image.rgb[(y - 1) * row + x] : 0;
      rows += static_cast<char>(image.rgb[y * row + x] - above);
    }
  }
  uLongf size = compressBound(rows.size());
  std::string packed(size, '\0');
  // Fails for want of memory or of room only, and there is room.
  compress2(reinterpret_cast<Bytef*>(packed.data()), &size,
            reinterpret_cast<const Bytef*>(rows.data()), rows.size(), Z_DEFAULT_COMPRESSION);
  packed.resize(size);

  std::string head;
  put(head, static_cast<std::uint32_t>(image.width));
  put(head, static_cast<std::uint32_t>(image.height));
  head += std::string("\x08\x02\0\0\0", 5);  // 8 bits, RGB
  std::string out = "\x89PNG\r\n\x1a\n";
  put_chunk(out, "IHDR", head);
  put_chunk(out, "IDAT", packed);
  put_chunk(out, "IEND", "");
  return out;
}

}  // namespace lamella
