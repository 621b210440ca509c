// Named points of a bone, in its frame (LPS, mm), by the field's terms; and which of them somebody has looked
// at.
#pragma once

#include <Eigen/Core>
#include <map>
#include <span>
#include <string>
#include <string_view>

#include "planning/bones/bone.h"

namespace arthronaut::landmarks {

// By name; the names are those of known_landmarks().
using Landmarks = std::map<std::string, Eigen::Vector3d>;

// Proposed: by the program, from the bone's shape (propose.h), and looked at by nobody yet. Confirmed: a
// person placed it, moved it or said that it is right.
enum class LandmarkState { Proposed, Confirmed };
[[nodiscard]] std::string_view to_text(LandmarkState state);  // "proposed", "confirmed"
// Throws InvalidInput for any other word.
[[nodiscard]] LandmarkState landmark_state_from_text(std::string_view text);

// By name. A landmark that has no state here is a confirmed one: those of older cases were placed by hand.
using LandmarkStates = std::map<std::string, LandmarkState>;
[[nodiscard]] LandmarkState state_of(const LandmarkStates& states, std::string_view name);

// Further from where the bone's shape puts it (propose.h) a landmark is to be looked at once more, whoever
// confirmed it: what was picked by hand and what is proposed differ by 3 mm at most on the bones that this
// was measured on.
inline constexpr double kFarFromShape_mm = 10;

// What a name stands for, for lists, tooltips and checks of input.
struct LandmarkKind {
  std::string_view name;     // "blumensaat_anterior", as in files and on the command line
  std::string_view title;    // "Blumensaat's line, anterior end"
  std::string_view meaning;  // where it is, in a sentence
};
// Every landmark of a bone, in the order in which they are best gone through.
[[nodiscard]] std::span<const LandmarkKind> known_landmarks(bones::BoneKind bone);
// nullptr for a name that the bone has not.
[[nodiscard]] const LandmarkKind* find_landmark(bones::BoneKind bone, std::string_view name);

}  // namespace arthronaut::landmarks
