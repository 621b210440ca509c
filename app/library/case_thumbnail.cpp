#include "app/library/case_thumbnail.h"

#include "app/scene/plan_picture.h"
#include "app/scene/scene_content.h"
#include "planning/files/private_folder.h"
#include "planning/plan_review/proposed_landmarks.h"

namespace arthronaut::workstation_library {

namespace fs = std::filesystem;

fs::path thumbnail_file(const fs::path& case_folder) { return case_folder / "cache" / "thumbnail.png"; }

bool has_thumbnail(const fs::path& case_folder) {
  return is_of_now(thumbnail_file(case_folder), case_folder) && plan_verdict(case_folder);
}

ThumbnailCase load_for_thumbnail(const fs::path& case_folder) {
  constexpr std::size_t kTriangles = 30'000;
  ThumbnailCase loaded{cases::load_case(case_folder), {}};
  loaded.verdict = judge_plan(loaded.knee, cases::load_bone_doubts(case_folder));
  cases::Case& knee = loaded.knee;
  for (auto& [kind, bone] : knee.bones) bone.mesh = *scene::simplified(bone.mesh, kTriangles);
  // Seen from the front and upright, whichever way the axes of its file lie.
  (void)plan_review::propose_landmarks(knee, plan_review::Proposing::WithoutGrid);
  return loaded;
}

void draw_thumbnail(const fs::path& case_folder, const ThumbnailCase& loaded) {
  keep_plan_verdict(case_folder, loaded.verdict);
  const scene::Image picture = scene::render_plan_picture({.knee = &loaded.knee,
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
