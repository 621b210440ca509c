// The panels of the theatre screen. Each reads and draws; none of them keeps a pose.
#pragma once

#include "app/navigate/hindrance.h"
#include "app/navigate/navigate_display.h"
#include "app/navigate/operation_rail.h"
#include "app/navigate/registration_words.h"
#include "app/navigate/theatre_bones.h"
#include "app/widgets/undistorted_texture.h"
#include "planning/plan_review/tunnel_verdict.h"

namespace arthronaut::navigate {

// What the panels read.
struct NavigateScreen {
  const theatre::LiveState* live = nullptr;  // null: no bone was looked at yet
  const NavigateDisplay& display;
  const RegistrationWords& words;                 // of the operation's registration
  bones::BoneKind bone = bones::BoneKind::Femur;  // that is navigated
  // In force: the one that guides. An edit that was not taken over is not here.
  std::optional<tunnels::Tunnel> plan = std::nullopt;
  double planned_length_mm = 0;
  // Which of two tunnels it is, and whether it was said to be drilled; empty for a bone's single tunnel.
  std::string tunnel = "";
  std::shared_ptr<const geometry::Surface> surface = nullptr;          // of the bone; may be null
  std::shared_ptr<const geometry::TriangleMesh> drawn_bone = nullptr;  // with surface
  float overlay_opacity = 1;                                           // 0: off
  NavigateLayout layout = NavigateLayout::Guide;
  int selected_stroke = -1;
  bool undistorts = false;     // shows the picture without the lens' distortion
  std::string next_step = "";  // "register what was touched"
  std::string missing = "";    // what it waits for: "the probe is covered"; empty: nothing
  bool is_wrong = false;       // ... and that is wrong, not only doubtful
  bool pedal_acts = false;     // it is done by the pedal
  bool is_exercise = false;    // it is an exercise's own, and no step of the operation
  Rail rail = {};
  std::optional<operation::Step> looked_at = std::nullopt;  // the surgeon went back to it
  std::optional<double> reached_for_s = std::nullopt;       // the guide has stood on the plan for so long
  std::string patient = "";                                 // in words; empty: not known
  const plan_review::TunnelVerdict* verdict = nullptr;      // of the plan; null: nobody judged it
  bool is_muted = false;                                    // no sound, by the user's word
  std::string sound_trouble = "";                           // why none can be heard; empty: it can
  std::string sharing = "";  // what goes out by OpenIGTLink; empty: nothing is asked for

  // The tool that is told of is the probe. Once the step is done what was touched last still stands there,
  // and what is taken next is looked for already.
  [[nodiscard]] bool is_of_probe() const {
    return layout == NavigateLayout::Register && (looked_at || !needs_guide(*live->operation));
  }
  // Of the newest picture; preconditions: display.has_picture.
  [[nodiscard]] const pipeline::FrameResult& frame() const { return live->operation->frame; }
  [[nodiscard]] const pipeline::PipelineOptions& options() const { return live->operation->source->pipeline; }
  [[nodiscard]] const PictureLines& lines() const;  // of the picture; empty when there are none
  // A source runs or has run, and what is known is of this one: there is something to say about it.
  [[nodiscard]] bool has_source() const {
    return live != nullptr && live->phase != theatre::LiveState::Phase::NoSource &&
           live->operation->source != nullptr && !is_of_source_before(*live);
  }
};

// The live picture on the graphics card.
struct VideoTextures {
  widgets::VideoTexture raw;
  widgets::UndistortedTexture undistorted;
};

// The picture, cut to the round view, with the plan drawn on it. Nothing else is ever put over it: what warns
// stands beside it, where no marker can be.
void draw_video(const widgets::Ui& ui, const widgets::Rect& area, const NavigateScreen& screen,
                VideoTextures& textures);
// The nine steps, each with its state by shape and colour; framed the one that the surgeon went back to.
void draw_rail(const widgets::Ui& ui, const widgets::Rect& area, const NavigateScreen& screen);
// What to do now, and whether the pedal does it.
void draw_words(const widgets::Ui& ui, const widgets::Rect& area, const NavigateScreen& screen);
// Why nothing guides, and what to do about it.
void draw_reason(const widgets::Ui& ui, const widgets::Rect& area, const NavigateScreen& screen);
// Lens, markers, registration and record in one line, each with its sign.
void draw_states(const widgets::Ui& ui, const widgets::Rect& area, const NavigateScreen& screen);
void draw_bullseye(const widgets::Ui& ui, const widgets::Rect& area, const NavigateScreen& screen);
void draw_numbers(const widgets::Ui& ui, const widgets::Rect& area, const NavigateScreen& screen);
// How deep the drill is, or why that is not said; cut off the top of `rest`. Needs a source.
void draw_depth(const widgets::Ui& ui, widgets::Rect& rest, const NavigateScreen& screen);
// While the probe draws: how far the registration is, and what is missing. Needs a status.
void draw_registration(const widgets::Ui& ui, const widgets::Rect& area, const NavigateScreen& screen);
// The same in every detail: strokes, touches, earlier ones.
void draw_registration_details(const widgets::Ui& ui, const widgets::Rect& area,
                               const NavigateScreen& screen);
// Markers, lens, registration, probe, record: each with its state and the reason.
void draw_tracking(const widgets::Ui& ui, const widgets::Rect& area, const NavigateScreen& screen);

}  // namespace arthronaut::navigate
