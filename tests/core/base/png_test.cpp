#include "core/base/png.h"

#include <gtest/gtest.h>
#include <zlib.h>

namespace lamella {
namespace {

std::uint32_t number_at(const std::string& bytes, std::size_t at) {
  std::uint32_t n = 0;
  for (std::size_t k = 0; k < 4; ++k) n = n << 8 | static_cast<unsigned char>(bytes[at + k]);
  return n;
}

// What the standard says of a file of this kind, read back by hand.
TEST(Png, HoldsEveryPixelAndSoundChecksums) {
  Image image{5, 3, {}};
  for (int k = 0; k < 5 * 3 * 3; ++k) image.rgb.push_back(static_cast<std::uint8_t>(37 * k));
  const std::string bytes = png(image);
  EXPECT_EQ(bytes.substr(0, 8), "\x89PNG\r\n\x1a\n");
  std::string packed;
  std::size_t chunks = 0;
  for (std::size_t at = 8; at < bytes.size(); ++chunks) {
    const std::uint32_t size = number_at(bytes, at);
    const std::string kind = bytes.substr(at + 4, 4), data = bytes.substr(at + 8, size);
    const std::string body = kind + data;
    EXPECT_EQ(number_at(bytes, at + 8 + size),
              crc32(0, reinterpret_cast<const Bytef*>(body.data()), uInt(body.size())))
        << kind;
    if (kind == "IHDR") {
      EXPECT_EQ(number_at(data, 0), 5u);
      EXPECT_EQ(number_at(data, 4), 3u);
      EXPECT_EQ(data.substr(8), std::string("\x08\x02\0\0\0", 5));
    }
    if (kind == "IDAT") packed = data;
    at += 12 + size;
  }
  EXPECT_EQ(chunks, 3u);
  std::string rows(3 * 16, '\0');
  uLongf size = rows.size();
  ASSERT_EQ(uncompress(reinterpret_cast<Bytef*>(rows.data()), &size,
                       reinterpret_cast<const Bytef*>(packed.data()), packed.size()),
            Z_OK);
  ASSERT_EQ(size, rows.size());
  std::vector<std::uint8_t> back;
  for (std::size_t y = 0; y < 3; ++y) {
    EXPECT_EQ(rows[16 * y], 2) << "each row as its difference to the one above";
    for (std::size_t x = 0; x < 15; ++x)
      back.push_back(
          static_cast<std::uint8_t>(rows[16 * y + 1 + x] + (y > 0 ? back[15 * (y - 1) + x] : 0)));
  }
  EXPECT_EQ(back, image.rgb);
}

}  // namespace
}  // namespace lamella
