// The check list with which an operation ends: what was drilled in each bone, and whether its world marker is
// out. Pure: what was said in, words out.
#pragma once

#include <vector>

#include "app/navigate/beginning_words.h"

namespace arthronaut::navigate {

struct FinishedTunnel {
  tunnels::TunnelKey key = bones::BoneKind::Femur;
  bool is_drilled = false;                            // by the surgeon's word
  std::optional<operation::AchievedTunnel> measured;  // empty: nothing was
  bool was_verified = false;                          // the registration that it was drilled by, by touches
};
// Of one bone that has a planned tunnel, or two.
struct FinishedBone {
  bones::BoneKind bone = bones::BoneKind::Femur;
  std::vector<FinishedTunnel> tunnels;
  bool marker_is_out = false;             // by the surgeon's word
  bool has_begun = false;                 // pictures of it came: its marker was put in, if not before
  [[nodiscard]] bool is_drilled() const;  // all of them
  // What its drilled tunnels were drilled by, all of it, was verified by touches; empty: none is drilled.
  [[nodiscard]] std::optional<bool> was_verified() const;
};

struct FinishList {
  std::vector<CardLine> lines;  // of each bone one for each tunnel, for what guided, and for its marker
  bool is_done = false;         // all is drilled, and every marker out
};
[[nodiscard]] FinishList finish_list(const std::vector<FinishedBone>& bones);

// What the pedal does next once a tunnel was said to be drilled.
enum class FinishAction { TakeMarkerOut, OtherBone, EndSource, Nothing };
// `bone`: that is navigated. `is_under_way`: pictures come.
[[nodiscard]] FinishAction finish_action(const std::vector<FinishedBone>& bones, bones::BoneKind bone,
                                         bool is_under_way);
[[nodiscard]] std::string words_of(FinishAction action, const std::vector<FinishedBone>& bones,
                                   bones::BoneKind bone);

}  // namespace arthronaut::navigate
