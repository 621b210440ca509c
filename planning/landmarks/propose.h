// Landmarks from a bone's shape alone: no scanner axis enters, so that a bone gives the same points however
// it lies, of either side, whole or cut off above (femur) or below (tibia) the joint.
//
// The way, each step in a file of its own:
//   1. rough_frame     the cut face or the long axis tells the joint's end; the plane in which the bone comes
//                      nearest to its own mirror image tells medial-lateral; what is missing behind the
//                      mirror plane (the notch; the plateau's rear) tells front from back.
//   2. femur_shape     the direction in which the outlines of both condyles cover each other is the true
//                      lateral view; in it the outline of the notch's roof, from its corner with the back of
//                      the shaft to its corner with the groove, gives Blumensaat's line; extremes in this
//                      view give the rest. Where a slanting cut misleads, the joint's end is looked at from
//                      in front and behind, too.
//   3. tibia_shape     the two halves of the plateau give its plane, its rim the four edges, the ridges
//                      between the halves the eminences.
//   4. the side        where the shaft stands over the condyles and which half reaches further forward.
// They are proposals: a person confirms or moves each.
#pragma once

#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "planning/bones/bone.h"
#include "planning/geometry/surface.h"
#include "planning/geometry/triangle_mesh.h"
#include "planning/landmarks/anatomical_axes.h"
#include "planning/landmarks/landmarks.h"

namespace arthronaut::landmarks {

// The roof of the notch is straight in one knee of three; in others a hill stands in it (Yahagi 2018, KSSTA
// 26:455), and grids differ by where Blumensaat's line is laid.
enum class RoofConvention {
  Flat,  // the best straight line through the roof, hill left out
  Ends,  // from the corner with the back of the shaft to the corner with the groove: as the line is defined
};
[[nodiscard]] std::string_view to_text(RoofConvention convention);  // "flat", "ends"
enum class RoofShape { Straight, SmallHill, LargeHill };
[[nodiscard]] std::string_view to_text(RoofShape shape);  // "straight", "small hill", "large hill"

struct ProposalOptions {
  // The side that the case says. Without it, the one that the shape tells; where the two differ the case's is
  // followed and a doubt is raised.
  std::optional<bones::Side> side;
  RoofConvention roof = RoofConvention::Ends;
  // Of the mesh, where there is one already; else it is made: a tenth of the work.
  const geometry::Surface* surface = nullptr;
  // Asked every few hundredths of a second; then the outcome is Stopped.
  std::stop_token stop = {};
};

struct Proposal {
  enum class Outcome {
    NotRun,
    Proposed,
    NotThisBone,  // no condyles and no notch, or no plateau: nothing is proposed
    Stopped,      // by ProposalOptions::stop
  } outcome = Outcome::NotRun;
  std::string reason = "propose was not called";  // why nothing is proposed; empty when something is
  Landmarks landmarks;                       // by the names of known_landmarks(), all but native_footprint
  std::optional<bones::Side> side_by_shape;  // nullopt: the shape does not tell
  AnatomicalAxes axes;                       // Origin::FromLandmarks, when Proposed
  RoofShape roof = RoofShape::Straight;      // femur
  double hill_mm = 0;                        // femur: how far the hill stands into the notch
  // Femur: Blumensaat's line and the extents that follow from it by the convention that was not asked for.
  Landmarks by_other_roof;
  std::vector<std::string> doubts;  // why a person should look closer, in sentences

  [[nodiscard]] bool is_usable() const { return outcome == Outcome::Proposed; }
};

// mesh: closed, outward, mm (bones::mend_mesh). Never throws for a shape that it does not know: read the
// outcome. A femur of 40,000 triangles takes 0.6 s, a tibia half of that.
[[nodiscard]] Proposal propose(const geometry::TriangleMesh& mesh, bones::BoneKind bone,
                               const ProposalOptions& options = {});

// Puts the proposed landmarks where there are none or proposed ones; confirmed ones stay. What was proposed
// before and is not now goes: axes and grids are never of two proposals. Of an empty one nothing is taken.
void take_proposal(const Proposal& proposal, Landmarks& landmarks, LandmarkStates& states);

}  // namespace arthronaut::landmarks
