// A small picture of a case for lists: its bones with their tunnels, from in front. It is kept as
// cache/thumbnail.png in the case's folder, which may be deleted at any time.
#pragma once

#include <filesystem>

#include "app/library/plan_verdict.h"
#include "planning/cases/case.h"

namespace arthronaut::workstation_library {

inline constexpr int kThumbnailWidth = 200, kThumbnailHeight = 160;

[[nodiscard]] std::filesystem::path thumbnail_file(const std::filesystem::path& case_folder);
// There with the plan's verdict, and neither older than case and plan.
[[nodiscard]] bool has_thumbnail(const std::filesystem::path& case_folder);
struct ThumbnailCase {
  cases::Case knee;
  plan_review::TunnelVerdict verdict;
};
// The case, its bones as coarse as a small picture needs, and what is wrong in its plan: seconds where they
// are fine. Throws IoError or InvalidInput for a case that cannot be read.
[[nodiscard]] ThumbnailCase load_for_thumbnail(const std::filesystem::path& case_folder);
// Draws it (off-screen, see scene/plan_picture.h) and keeps picture and verdict: some 100 ms. Throws IoError
// where it cannot be written, InvalidInput for a case without bones, DeviceError without OpenGL.
void draw_thumbnail(const std::filesystem::path& case_folder, const ThumbnailCase& loaded);

}  // namespace arthronaut::workstation_library
