// Which files of a folder are pictures and which are videos, by their extension.
#pragma once

#include <filesystem>
#include <vector>

namespace arthronaut::sources {

[[nodiscard]] bool looks_like_picture(const std::filesystem::path& file);
[[nodiscard]] bool looks_like_video(const std::filesystem::path& file);

// The regular files that look so right inside a folder, by name; none in a folder that can't be read.
[[nodiscard]] std::vector<std::filesystem::path> pictures_in(const std::filesystem::path& folder);
[[nodiscard]] std::vector<std::filesystem::path> videos_in(const std::filesystem::path& folder);

}  // namespace arthronaut::sources
