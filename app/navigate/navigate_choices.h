// What the user has chosen on the theatre screen. View state: nothing of an operation.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/navigate/hindrance.h"
#include "app/navigate/navigate_display.h"
#include "app/navigate/pedal_step.h"
#include "app/navigate/reached_plan.h"
#include "navigation/operation/operation_state.h"

namespace arthronaut::navigate {

// Of what a press would say for the surgeon.
inline constexpr double kReadable_s = 1.5;

// What is asked on a card of its own, in the place of the numbers.
enum class Question { None, Resume, TimeOut, Finish };

struct NavigateChoices {
  bones::BoneKind bone = bones::BoneKind::Femur;
  bool saline = true;                         // of the next video or camera
  std::vector<std::filesystem::path> videos;  // of the case, when this mode was entered
  std::size_t video = 0;                      // the next of those
  bool overlay_on = true;
  double overlay_shown_at_s = 0;
  bool undistorts = false;
  std::optional<NavigateLayout> layout;      // empty: as things stand
  double guidance_seen_s = -1e9;             // when something was guided last
  double touch_asked_s = -1e9;               // when a touch was asked for last
  int stroke = -1;                           // selected
  std::optional<operation::Step> looked_at;  // the surgeon went back to it; empty: the one of now
  PedalStep pedal;                           // what is asked of the surgeon now
  double pedal_since_s = 0;                  // and since when
  Question asked = Question::None;           // on a card that stands on the screen
  SteadyWords missing;                       // what that waits for
  std::size_t offered_tunnel = 0;   // of two that nobody has chosen from: the one that a press would choose
  bool goes_to_other_bone = false;  // once the source has ended
  bool shows_menu = false, shows_more = false;  // of the menu its second page
  ReachedPlan reached;
  // Of the case, as it was when this mode was entered.
  bool has_real_scope = false, has_camera_file = false;
  std::optional<tools::ToolSet> tools;  // empty: there are none, or they can't be read

  // A question begins to be read when its card is there, not while the menu lies over it.
  void note_asked(Question question, double now_s) {
    if (std::exchange(asked, question) != question && question != Question::None) pedal_since_s = now_s;
  }
  void note_pedal(const PedalStep& step, double now_s) {
    if (step == pedal) return;
    pedal = step;
    pedal_since_s = now_s;
  }

  // What is asked of the surgeon now stood there for so long.
  [[nodiscard]] bool was_asked_for(double now_s, double seconds) const {
    return now_s - pedal_since_s >= seconds;
  }

  [[nodiscard]] bones::BoneKind other_bone() const {
    return bone == bones::BoneKind::Femur ? bones::BoneKind::Tibia : bones::BoneKind::Femur;
  }
  // What was chosen or seen of one bone says nothing of the other.
  void take_other_bone() {
    bone = other_bone();
    layout.reset();
    looked_at.reset();
    guidance_seen_s = touch_asked_s = -1e9;
    stroke = -1;
    offered_tunnel = 0;
  }
};

}  // namespace arthronaut::navigate
