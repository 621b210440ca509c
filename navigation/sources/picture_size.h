// What a still picture is and how large it says that it is, read from its header alone: a megabyte of PNG can
// claim, and decode to, gigabytes.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

namespace arthronaut::sources {

enum class PictureFormat { Png, Jpeg, Bmp, Tiff, WebP, Pbm, Pgm, Ppm };

struct PictureSize {
  std::uint64_t width = 0, height = 0;
};

// By the bytes it begins with, not by its name; nullopt for everything else. Never throws.
[[nodiscard]] std::optional<PictureFormat> picture_format(std::span<const std::uint8_t> bytes);

// nullopt for what is no picture and for a header that breaks off. Never throws.
[[nodiscard]] std::optional<PictureSize> picture_size(std::span<const std::uint8_t> bytes);

}  // namespace arthronaut::sources
