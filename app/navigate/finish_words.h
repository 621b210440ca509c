// The check list with which an operation ends: what was drilled in each bone, and whether its world marker is
// out. Pure: what was said in, words out.
#pragma once

#include <vector>

#include "app/navigate/beginning_words.h"

namespace arthronaut::navigate {

// Of one bone that has a planned tunnel.
struct FinishedBone {
  bones::BoneKind bone = bones::BoneKind::Femur;
  bool is_drilled = false;     // all that are planned in it, by the surgeon's word
  bool marker_is_out = false;  // likewise
  // As it was measured, of the bone that is navigated; empty: nothing was measured, or not of this bone.
  std::optional<operation::AchievedTunnel> measured;
};

struct FinishList {
  std::vector<CardLine> lines;  // two for each bone
  bool is_done = false;         // every line
};
[[nodiscard]] FinishList finish_list(const std::vector<FinishedBone>& bones);

// What the pedal does next once a tunnel was said to be drilled.
enum class FinishAction { TakeMarkerOut, OtherBone, EndSource, Nothing };
// `bone`: that is navigated. `is_under_way`: pictures come.
[[nodiscard]] FinishAction finish_action(const std::vector<FinishedBone>& bones, bones::BoneKind bone,
                                         bool is_under_way);
[[nodiscard]] std::string words_of(FinishAction action, bones::BoneKind bone);

}  // namespace arthronaut::navigate
