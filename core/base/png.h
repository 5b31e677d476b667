#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace lamella {

/// Rows from the top, three bytes a pixel.
struct Image {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb;
};

/// The image as the bytes of a PNG file.
std::string png(const Image& image);

}  // namespace lamella
