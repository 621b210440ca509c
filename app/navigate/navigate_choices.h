// What the user has chosen on the theatre screen. View state: nothing of an operation.
#pragma once

#include <filesystem>
#include <optional>
#include <set>
#include <vector>

#include "app/navigate/navigate_display.h"

namespace arthronaut::navigate {

struct NavigateChoices {
  bones::BoneKind bone = bones::BoneKind::Femur;
  bool saline = true;                         // of the next video or camera
  std::vector<std::filesystem::path> videos;  // of the case, when this mode was entered
  std::size_t video = 0;                      // the next of those
  bool overlay_on = true;
  double overlay_shown_at_s = 0;
  bool undistorts = false;
  std::optional<NavigateLayout> layout;  // empty: as things stand
  double guidance_seen_s = -1e9;         // when guidance was valid last
  int stroke = -1;                       // selected
  std::set<tunnels::TunnelKey> drilled;  // said to be, since the case was opened

  [[nodiscard]] bones::BoneKind other_bone() const {
    return bone == bones::BoneKind::Femur ? bones::BoneKind::Tibia : bones::BoneKind::Femur;
  }
  // What was chosen or seen of one bone says nothing of the other.
  void take_other_bone() {
    bone = other_bone();
    layout.reset();
    guidance_seen_s = -1e9;
    stroke = -1;
  }
};

}  // namespace arthronaut::navigate
