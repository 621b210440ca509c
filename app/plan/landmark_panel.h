// The landmarks of a bone as a list: which are proposed by the shape and which a person has looked at, what
// each means, and the one that is worked on. What can be done with it are actions of plan mode.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "app/case/plan_model.h"
#include "app/plan/landmark_drawing.h"
#include "app/widgets/controls.h"

namespace arthronaut::plan {

struct LandmarkRow {
  std::string name, title, meaning;
  enum class State { Confirmed, Proposed, Missing } state = State::Missing;
};
// Every landmark of the bone, in the order in which they are best gone through; those that only somebody who
// saw it can give
// ("native_footprint") stand last.
[[nodiscard]] std::vector<LandmarkRow> landmark_rows(const open_case::PlanModel& model, bones::BoneKind bone);
// Whether the landmark lies in the bone, as the centre of a condyle does, and not on its surface.
[[nodiscard]] bool lies_within_bone(std::string_view name);
// Whether one waits for somebody's look; without one "Confirm all" would do nothing.
[[nodiscard]] bool has_to_confirm(const std::vector<LandmarkRow>& rows);
// "6 of 14 confirmed, 1 not there": of those that are there all can be.
[[nodiscard]] std::string confirmed_in_words(const std::vector<LandmarkRow>& rows);
// How far it lies from where the bone's shape puts it; nullopt where either is not there (yet).
[[nodiscard]] std::optional<double> off_proposal_mm(const open_case::PlanModel& model, bones::BoneKind bone,
                                                    const std::string& name);
// "confirmed, 31.5 mm from where the bone's shape puts it: look": one that was put in the wrong place is seen
// by it.
[[nodiscard]] std::string state_in_words(LandmarkRow::State state, std::optional<double> off_proposal_mm);
// The first that is proposed, after `from` and round again; nullopt when every one is confirmed or missing.
[[nodiscard]] std::optional<std::size_t> next_proposed(const std::vector<LandmarkRow>& rows,
                                                       std::size_t from);

// What is said of the selected one stands beside its picture; so much room is left below. Returns the row
// that was clicked.
[[nodiscard]] std::optional<std::size_t> draw_landmark_list(const widgets::Ui& ui,
                                                            const open_case::PlanModel& model,
                                                            bones::BoneKind bone, std::size_t selected,
                                                            LandmarkDrawing& drawing, float room_below_px);

}  // namespace arthronaut::plan
