// How large a still picture says that it is, read from its header alone: a megabyte of PNG can claim, and
// decode to, gigabytes.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

namespace arthronaut::sources {

struct PictureSize {
  std::uint64_t width = 0, height = 0;
};

// Of PNG, JPEG, BMP, TIFF, WebP and PNM; nullopt for everything else and for a header that breaks off. Never
// throws.
[[nodiscard]] std::optional<PictureSize> picture_size(std::span<const std::uint8_t> bytes);

}  // namespace arthronaut::sources
