#include "planning/landmarks/propose.h"

#include "planning/landmarks/femur_shape.h"
#include "planning/landmarks/tibia_shape.h"

namespace arthronaut::landmarks {

std::string_view to_text(RoofConvention convention) {
  return convention == RoofConvention::Flat ? "flat" : "ends";
}

std::string_view to_text(RoofShape shape) {
  switch (shape) {
    case RoofShape::Straight:
      return "straight";
    case RoofShape::SmallHill:
      return "small hill";
    case RoofShape::LargeHill:
      return "large hill";
  }
  return "unknown";
}

namespace {

// Of either side, since the shape need not tell it. What is not would be proposed here and passed over by
// whoever takes axes of it.
bool gives_axes(const geometry::TriangleMesh& mesh, bones::BoneKind bone, const Landmarks& landmarks) {
  const auto is_believed = [&](bones::Side side) {
    return anatomical_axes(bone, side, landmarks, mesh).origin == AnatomicalAxes::Origin::FromLandmarks;
  };
  return is_believed(bones::Side::Right) || is_believed(bones::Side::Left);
}

}  // namespace

Proposal propose(const geometry::TriangleMesh& mesh, bones::BoneKind bone, const ProposalOptions& options) {
  if (mesh.empty() || !(geometry::surface_area_mm2(mesh) > 0)) {
    Proposal nothing;
    nothing.outcome = Proposal::Outcome::NotThisBone;
    nothing.reason = "the surface is empty";
    return nothing;
  }
  std::optional<geometry::Surface> own_surface;
  const geometry::Surface& surface =
      options.surface != nullptr ? *options.surface : own_surface.emplace(mesh);
  Proposal proposal = bone == bones::BoneKind::Femur ? propose_femur(mesh, surface, options)
                                                     : propose_tibia(mesh, surface, options);
  if (options.stop.stop_requested()) {  // what the steps have by then is worth nothing
    proposal = {};
    proposal.outcome = Proposal::Outcome::Stopped;
    proposal.reason = "it was stopped";
    return proposal;
  }
  if (proposal.is_usable() && !gives_axes(mesh, bone, proposal.landmarks)) {
    proposal = {};
    proposal.outcome = Proposal::Outcome::NotThisBone;
    proposal.reason = "the places that its shape gives lie as on no " + std::string(bones::to_text(bone)) +
                      "; is it cut off through the joint's end?";
  }
  if (proposal.is_usable() && options.side && proposal.side_by_shape &&
      *options.side != *proposal.side_by_shape) {
    proposal.doubts.push_back("by its shape the " + std::string(bones::to_text(bone)) + " is a " +
                              std::string(bones::to_text(*proposal.side_by_shape)) +
                              " one, and the case says " + std::string(bones::to_text(*options.side)));
  }
  if (proposal.is_usable() && !options.side && !proposal.side_by_shape)
    proposal.doubts.push_back("the shape of the " + std::string(bones::to_text(bone)) +
                              " does not tell its side");
  return proposal;
}

void take_proposal(const Proposal& proposal, Landmarks& landmarks, LandmarkStates& states) {
  if (proposal.landmarks.empty()) return;
  std::erase_if(landmarks, [&](const auto& landmark) {
    return state_of(states, landmark.first) == LandmarkState::Proposed;
  });
  std::erase_if(states, [](const auto& state) { return state.second == LandmarkState::Proposed; });
  for (const auto& [name, position] : proposal.landmarks) {
    if (landmarks.contains(name) && state_of(states, name) == LandmarkState::Confirmed) continue;
    landmarks[name] = position;
    states[name] = LandmarkState::Proposed;
  }
}

}  // namespace arthronaut::landmarks
