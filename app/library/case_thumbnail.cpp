#include "app/library/case_thumbnail.h"

#include "app/scene/plan_picture.h"
#include "app/scene/scene_content.h"
#include "planning/files/private_folder.h"

namespace arthronaut::workstation_library {

namespace fs = std::filesystem;

fs::path thumbnail_file(const fs::path& case_folder) { return case_folder / "cache" / "thumbnail.png"; }

bool has_thumbnail(const fs::path& case_folder) {
  std::error_code error;
  const auto made = fs::last_write_time(thumbnail_file(case_folder), error);
  if (error) return false;
  for (const char* file : {"case.json", "plan.json"}) {
    const auto written = fs::last_write_time(case_folder / file, error);
    if (!error && written > made) return false;
  }
  return true;
}

cases::Case load_for_thumbnail(const fs::path& case_folder) {
  constexpr std::size_t kTriangles = 30'000;
  cases::Case knee = cases::load_case(case_folder);
  for (auto& [kind, bone] : knee.bones) bone.mesh = *scene::simplified(bone.mesh, kTriangles);
  return knee;
}

void draw_thumbnail(const fs::path& case_folder, const cases::Case& knee) {
  const scene::Image picture = scene::render_plan_picture({.knee = &knee,
                                                           .only_bone = {},
                                                           .achieved = {},
                                                           .curve_points_in_bone = {},
                                                           .view = scene::ViewDirection::Anterior,
                                                           .width = kThumbnailWidth,
                                                           .height = kThumbnailHeight});
  files::create_private_folder(thumbnail_file(case_folder).parent_path());
  scene::write_png(thumbnail_file(case_folder), picture);
}

}  // namespace arthronaut::workstation_library
