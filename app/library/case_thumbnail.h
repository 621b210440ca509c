// A small picture of a case for lists: its bones with their tunnels, from in front. It is kept as
// cache/thumbnail.png in the case's folder, which may be deleted at any time.
#pragma once

#include <filesystem>

#include "planning/cases/case.h"

namespace arthronaut::workstation_library {

inline constexpr int kThumbnailWidth = 200, kThumbnailHeight = 160;

[[nodiscard]] std::filesystem::path thumbnail_file(const std::filesystem::path& case_folder);
// There, and not older than case and plan.
[[nodiscard]] bool has_thumbnail(const std::filesystem::path& case_folder);
// The case, its bones as coarse as a small picture needs: seconds where they are fine. Throws IoError or
// InvalidInput for a case that cannot be read.
[[nodiscard]] cases::Case load_for_thumbnail(const std::filesystem::path& case_folder);
// Draws it (off-screen, see scene/plan_picture.h) and keeps the picture: some 100 ms. Throws IoError where it
// cannot be written, InvalidInput for a case without bones, DeviceError without OpenGL.
void draw_thumbnail(const std::filesystem::path& case_folder, const cases::Case& knee);

}  // namespace arthronaut::workstation_library
