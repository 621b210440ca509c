// How Blumensaat's line is laid through the roof of the notch, on which every percentage of the femoral grid
// hangs: shown beside the grid, and chosen.
#pragma once

#include <string>

#include "app/case/plan_model.h"

namespace arthronaut::plan {

enum class RoofLine {
  NotKnown,  // the shape tells none, or is still looked at
  Ends,      // landmarks::RoofConvention
  Flat,
  Neither,  // moved by hand, or from elsewhere
};
// As the femur's landmarks have it. Precondition: the model has a femur.
[[nodiscard]] RoofLine roof_line(const open_case::PlanModel& model);
// "Blumensaat's line: from end to end of the roof, in which a small hill of 1.3 mm stands"
[[nodiscard]] std::string roof_line_in_words(const open_case::PlanModel& model);

// The femur's landmarks with the line laid by the other convention than it is, by Ends where it is neither;
// nullopt where the shape gives no such line. Those that move are proposals again.
struct LaidRoof {
  landmarks::Landmarks landmarks;
  landmarks::LandmarkStates states;
  RoofLine line = RoofLine::NotKnown;
};
[[nodiscard]] std::optional<LaidRoof> with_other_roof(const open_case::PlanModel& model);

}  // namespace arthronaut::plan
