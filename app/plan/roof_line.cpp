#include "app/plan/roof_line.h"

#include <algorithm>
#include <array>

#include "app/widgets/controls.h"

namespace arthronaut::plan {

namespace {

constexpr bones::BoneKind kFemur = bones::BoneKind::Femur;

// Files round; a drag moves further.
bool runs_through(const landmarks::Landmarks& marks, const landmarks::Landmarks& line) {
  constexpr double kSame_mm = 0.01;
  return std::ranges::all_of(
      std::array{"blumensaat_anterior", "blumensaat_posterior"}, [&](const char* name) {
        const auto here = marks.find(name), there = line.find(name);
        return here != marks.end() && there != line.end() && (here->second - there->second).norm() < kSame_mm;
      });
}

}  // namespace

RoofLine roof_line(const open_case::PlanModel& model) {
  const auto& proposal = model.proposal(kFemur);
  if (!proposal || !proposal->is_usable()) return RoofLine::NotKnown;
  const landmarks::Landmarks& marks = model.landmarks(kFemur);
  // The model asks for RoofConvention::Ends.
  if (runs_through(marks, proposal->landmarks)) return RoofLine::Ends;
  if (runs_through(marks, proposal->by_other_roof)) return RoofLine::Flat;
  return RoofLine::Neither;
}

std::string roof_line_in_words(const open_case::PlanModel& model) {
  std::string words = "Blumensaat's line: ";
  switch (roof_line(model)) {
    case RoofLine::NotKnown:
      return words + "as its landmarks lie";
    case RoofLine::Ends:
      words += "from end to end of the roof";
      break;
    case RoofLine::Flat:
      words += "along the flat of the roof, its hill left out";
      break;
    case RoofLine::Neither:
      words += "as its landmarks lie, by neither convention";
      break;
  }
  const landmarks::Proposal& proposal = *model.proposal(kFemur);
  return words + (proposal.roof == landmarks::RoofShape::Straight
                      ? ". This roof is straight"
                      : ". In this roof stands a " + std::string(to_text(proposal.roof)) + " of " +
                            widgets::fixed(proposal.hill_mm, 1) + " mm");
}

std::optional<LaidRoof> with_other_roof(const open_case::PlanModel& model) {
  const RoofLine now = roof_line(model);
  if (now == RoofLine::NotKnown) return std::nullopt;
  const landmarks::Proposal& proposal = *model.proposal(kFemur);
  if (proposal.by_other_roof.empty()) return std::nullopt;
  LaidRoof laid{model.landmarks(kFemur), model.landmark_states(kFemur),
                now == RoofLine::Ends ? RoofLine::Flat : RoofLine::Ends};
  for (const auto& [name, flat_mm] : proposal.by_other_roof) {
    const auto from_end_to_end = proposal.landmarks.find(name);
    if (laid.line == RoofLine::Ends && from_end_to_end == proposal.landmarks.end()) continue;
    laid.landmarks[name] = laid.line == RoofLine::Flat ? flat_mm : from_end_to_end->second;
    laid.states[name] = landmarks::LandmarkState::Proposed;
  }
  return laid;
}

}  // namespace arthronaut::plan
