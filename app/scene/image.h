// A rendered picture as plain memory.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

namespace arthronaut::scene {

struct Image {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb;  // 3 * width * height, top row first
};

// PNG, 8 bit, replaced in one step. Throws IoError.
void write_png(const std::filesystem::path& file, const Image& image);

}  // namespace arthronaut::scene
