// The panels of the theatre screen. Each reads and draws; none of them keeps a pose.
#pragma once

#include "app/navigate/navigate_display.h"
#include "app/navigate/registration_words.h"
#include "app/widgets/undistorted_texture.h"

namespace arthronaut::navigate {

// What the panels read.
struct NavigateScreen {
  const OperationStatus* status = nullptr;             // null: no operation
  const pipeline::PipelineOptions* options = nullptr;  // of the operation; null with status
  const NavigateDisplay& display;
  const RegistrationWords& words;                 // of status->bone
  bones::BoneKind bone = bones::BoneKind::Femur;  // that is navigated
  std::optional<tunnels::Tunnel> plan = std::nullopt;
  double planned_length_mm = 0;
  std::uint64_t plan_revision = 0;
  std::shared_ptr<const geometry::Surface> surface = nullptr;          // of the bone; may be null
  std::shared_ptr<const geometry::TriangleMesh> drawn_bone = nullptr;  // with surface
  float overlay_opacity = 1;                                           // 0: off
  NavigateLayout layout = NavigateLayout::Guide;
  int selected_stroke = -1;
  bool undistorts = false;                        // shows the picture without the lens' distortion
  std::string_view title = "", calibration = "";  // of the operation: "Simulated operation: probe"
  std::string next_step = "";                     // "register what was touched"
};

// The live picture on the graphics card.
struct VideoTextures {
  widgets::VideoTexture raw;
  widgets::UndistortedTexture undistorted;
};

// The picture, cut to the round view, with the plan drawn on it.
void draw_video(const widgets::Ui& ui, const widgets::Rect& area, const NavigateScreen& screen,
                VideoTextures& textures);
void draw_bullseye(const widgets::Ui& ui, const widgets::Rect& area, const NavigateScreen& screen);
void draw_numbers(const widgets::Ui& ui, const widgets::Rect& area, const NavigateScreen& screen);
// While the probe draws: how far the registration is, what to do next, and everything that can be taken back.
// Needs a status.
void draw_registration(const widgets::Ui& ui, const widgets::Rect& area, const NavigateScreen& screen);
// Markers, lens, registration, probe, record: each with its state and the reason.
void draw_tracking(const widgets::Ui& ui, const widgets::Rect& area, const NavigateScreen& screen);

}  // namespace arthronaut::navigate
