#include "planning/plan_review/landmark_check.h"

#include <algorithm>

#include "planning/files/fixed_number.h"
#include "planning/files/format.h"
#include "planning/landmarks/off_shape.h"

namespace arthronaut::plan_review {

namespace {

using Verdict = tunnels::PlanCheck::Verdict;

std::string title_of(bones::BoneKind bone, const std::string& name) {
  const landmarks::LandmarkKind* const kind = landmarks::find_landmark(bone, name);
  return kind == nullptr ? name : std::string(kind->title);
}

}  // namespace

tunnels::PlanCheck check_landmarks(bones::BoneKind bone, const landmarks::Landmarks& landmarks,
                                   const landmarks::LandmarkStates& states,
                                   const landmarks::Proposal* by_shape, const tunnels::PlanNorms& norms) {
  tunnels::PlanCheck check{.verdict = Verdict::NotChecked, .name = "Landmarks", .text = ""};
  if (by_shape == nullptr || by_shape->outcome == landmarks::Proposal::Outcome::NotRun ||
      by_shape->outcome == landmarks::Proposal::Outcome::Stopped) {
    check.text = "not checked: where the bone's shape puts them is not known yet";
    return check;
  }
  const auto off = landmarks::off_shape(landmarks, *by_shape);
  if (off.empty()) {
    check.text = landmarks.empty() ? "not checked: the landmarks are missing"
                                   : "not checked: the bone's shape gives none";
    return check;
  }
  const landmarks::OffShape& furthest = off.front();
  const bool is_far = furthest.off_mm > norms.far_landmark_mm;
  if (!is_far && std::ranges::none_of(off, [&](const auto& one) {
        return landmarks::state_of(states, one.name) == landmarks::LandmarkState::Confirmed;
      })) {
    check.verdict = Verdict::Note;
    check.text = "taken from the bone's shape: there is nothing to hold against it";
    return check;
  }
  check.verdict = is_far ? Verdict::Look : Verdict::Fine;
  check.text = files::fixed(furthest.off_mm, 1) + " mm from where the bone's shape puts ";
  if (is_far) {
    check.text = title_of(bone, furthest.name) + ": " + check.text + "it";
    const auto others =
        std::ranges::count_if(off, [&](const auto& one) { return one.off_mm > norms.far_landmark_mm; }) - 1;
    if (others > 0)
      check.text +=
          files::format(", and %d more further than %g mm", static_cast<int>(others), norms.far_landmark_mm);
  } else {
    check.text += "them, at most";
  }
  check.source = files::format(
      "%g mm by choice: what is picked by hand and what the shape gives differ by 3 mm at most on the bones "
      "measured",
      norms.far_landmark_mm);
  check.value = furthest.off_mm;
  check.unit = "mm";
  check.greatest = norms.far_landmark_mm;
  check.at_mm = furthest.at_mm;
  return check;
}

std::optional<std::string> landmark_doubt(const tunnels::PlanCheck& of_landmarks) {
  if (!tunnels::is_failed(of_landmarks)) return std::nullopt;
  return of_landmarks.name + ": " + of_landmarks.text;
}

}  // namespace arthronaut::plan_review
