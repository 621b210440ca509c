// A small picture of a case for lists: its bones with their tunnels, from in front. It is kept as
// cache/thumbnail.png in the case's folder, which may be deleted at any time.
#pragma once

#include <filesystem>

namespace arthronaut::workstation_library {

inline constexpr int kThumbnailWidth = 200, kThumbnailHeight = 160;

[[nodiscard]] std::filesystem::path thumbnail_file(const std::filesystem::path& case_folder);
// There, and not older than case and plan.
[[nodiscard]] bool has_thumbnail(const std::filesystem::path& case_folder);
// Loads the case and draws it (off-screen, see scene/plan_picture.h): some 100 ms. Throws IoError or
// InvalidInput for a case that cannot be read or written, DeviceError without OpenGL.
void make_thumbnail(const std::filesystem::path& case_folder);

}  // namespace arthronaut::workstation_library
