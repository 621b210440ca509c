#include "app/navigate/navigate_scene.h"

#include <algorithm>

#include "app/navigate/scene_words.h"
#include "app/widgets/afar_text.h"

namespace arthronaut::navigate {

namespace {

// Where to draw next is shown until that is settled: afterwards nothing asks for more.
bool asks_for_strokes(NavigateLayout layout, const operation::RegistrationState* bone) {
  return layout == NavigateLayout::Register && bone != nullptr && bone->online != nullptr &&
         bone->online->registration.has_pose && bone->online->state < registration::OnlineState::Confirmed;
}

// Which bone it is, and of two tunnels which one guides.
std::string bone_of(const NavigateScreen& screen) {
  return widgets::sentence(tunnels::name_of(screen.plan ? screen.plan->key() : screen.bone));
}

// What its colours tell; empty: nothing.
std::string colours_of(const NavigateScreen& screen, bool asks) {
  if (asks) return "Orange: draw here";
  if (screen.layout == NavigateLayout::Guide) return "";
  const bool has_strokes = screen.live != nullptr && !screen.live->operation->registration->drawn->empty();
  return has_strokes ? "Green: on the bone" : "";
}

ShownScene shown_of(const NavigateScreen& screen) {
  ShownScene shown;
  shown.drawn_bone = screen.drawn_bone;
  if (screen.plan) {
    const Eigen::Vector3d &entry = screen.plan->entry_mm, &direction = screen.plan->direction;
    shown.plan = {entry.x(),
                  entry.y(),
                  entry.z(),
                  direction.x(),
                  direction.y(),
                  direction.z(),
                  screen.planned_length_mm};
  }
  shown.layout = screen.layout;
  shown.selected_stroke = screen.layout == NavigateLayout::Register ? screen.selected_stroke : -1;
  if (screen.live == nullptr) return shown;
  shown.registration = screen.live->operation->registration;
  if (!screen.display.world_is_placed) return shown;
  const pipeline::FrameResult& frame = screen.frame();
  if (screen.display.tip_is_valid) shown.tip_frame = frame.frame_index;
  if (screen.display.guidance_is_valid) shown.guide_frame = frame.frame_index;
  return shown;
}

}  // namespace

void NavigateScene::show(const widgets::Ui& ui, const NavigateScreen& screen) {
  if (!renewal_.is_due(shown_of(screen), ui.now_s, ui.by_processor)) return;
  const ShownScene& shown = renewal_.shown();
  scene::SceneContent content;
  content.bones.push_back({screen.drawn_bone, scene::kBoneColor, 1.0});
  if (screen.plan) scene::add_planned_tunnel(content, *screen.plan, screen.planned_length_mm);
  if (shown.registration != nullptr) {
    const operation::RegistrationState& bone = *shown.registration;
    touched_.add_strokes(content, bone, *screen.surface, shown.selected_stroke);
    if (shown.tip_frame >= 0)
      content.balls.push_back(
          {bone.in_force.registration->marker_from_bone.inverse() * screen.frame().tip_in_world_mm, 2.5,
           scene::kGuideColor, false});
    if (asks_for_strokes(shown.layout, &bone)) {
      add_patches(content, bone.online->coach);
      if (bone.online->coach.next_patch_in_bone_mm)
        content.balls.push_back({*bone.online->coach.next_patch_in_bone_mm, 5, scene::kAchievedColor, false});
    }
  }
  if (shown.guide_frame >= 0) {
    const guidance::GuidanceNumbers& g = screen.display.guidance;
    scene::add_guide(content, g.guide_point_mm, g.guide_direction, std::max(screen.planned_length_mm, 5.0));
  }
  pane_.show(content);
}

void NavigateScene::draw(const widgets::Ui& ui, const widgets::Rect& area, const NavigateScreen& screen) {
  if (screen.drawn_bone == nullptr) return;
  show(ui, screen);
  const ImFont* const font = ui.theme.afar;
  const bool asks = asks_for_strokes(renewal_.shown().layout, renewal_.shown().registration.get());
  widgets::Rect pane = area;
  (void)pane.cut_left(ui.theme.px(14));  // as far in as the words above and below it
  const SceneWords parts = scene_words(pane, bone_of(screen), colours_of(screen, asks), font->FontSize,
                                       ui.theme.px(12), [&](const std::string& words) {
                                         return font->CalcTextSizeA(font->FontSize, 1e9F, 0, words.c_str()).x;
                                       });
  // Beside pictures that come, a key would wait for the large one.
  pane_.smooth_at_rest(!ui.by_processor || screen.live == nullptr || !is_under_way(*screen.live));
  pane_.draw(ui, "navigate.view", parts.view);
  const ShownScene& shown = renewal_.shown();
  // A guide that is not known is amiss only while it is to be followed.
  const bool is_missed = shown.layout == NavigateLayout::Guide && !screen.display.guidance_is_valid;
  widgets::draw_afar(ui, parts.place, is_missed ? widgets::kCaution : widgets::kText, parts.words);
}

}  // namespace arthronaut::navigate
