// A case's plan with everything that is asked of it: what screen, command line and report say of a tunnel is
// said here, once.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "planning/cases/bone_doubts.h"
#include "planning/cases/case.h"
#include "planning/geometry/surface.h"
#include "planning/norms/footprint.h"
#include "planning/plan_review/proposed_landmarks.h"
#include "planning/tunnels/knee_checks.h"
#include "planning/tunnels/plan_checks.h"

namespace arthronaut::plan_review {

// What the checks ask of one bone. Made once a bone and its landmarks.
struct ReviewedBone {
  std::shared_ptr<const geometry::Surface> surface;  // never null
  tunnels::PlanSurroundings surroundings;
  // Of the whole ligament and of its bundles, by the default norms; missing where the landmarks give no grid.
  std::map<norms::Bundle, norms::ExpectedFootprint> footprints;
};
// surface: of that mesh, not null.
[[nodiscard]] ReviewedBone review_bone(const geometry::TriangleMesh& mesh, bones::BoneKind kind,
                                       bones::Side side, const landmarks::Landmarks& landmarks,
                                       std::shared_ptr<const geometry::Surface> surface);

// What a bone says of the whole knee takes the place of what it said before. The insertions are the expected
// ones; of the whole ligament the native one where a landmark gives it.
void put_bone(tunnels::KneeSurroundings& knee, bones::BoneKind kind, const ReviewedBone& bone);

// As planned and as measured in its bone.
struct MeasuredTunnel {
  tunnels::Tunnel tunnel;
  tunnels::TunnelGeometry geometry;
};
// The tunnels of a plan whose bones are there.
using MeasuredPlan = std::map<tunnels::TunnelKey, MeasuredTunnel>;

// The other end of the tunnel's graft: in the other bone the tunnel of the same bundle, else its single one.
// Null where there is none; of a single tunnel against two of bundles too: which of them it goes to nobody
// has said.
[[nodiscard]] const MeasuredTunnel* other_end(const tunnels::TunnelKey& key, const MeasuredPlan& plan);

// What is asked of a tunnel that enters its bone and of the others: how much bone is between it and the other
// one of its bone, then what concerns the whole knee. Precondition: the plan has it.
[[nodiscard]] std::vector<tunnels::PlanCheck> further_checks(const tunnels::TunnelKey& key,
                                                             const MeasuredPlan& plan,
                                                             const tunnels::KneeSurroundings& knee);
// The checks of a tunnel, what is said of the landmarks that they follow from, then the further ones. Empty
// without that tunnel. surroundings, of_landmarks (landmark_check.h): of its bone.
[[nodiscard]] std::vector<tunnels::PlanCheck> checks_of(const tunnels::TunnelKey& key,
                                                        const MeasuredPlan& plan,
                                                        const tunnels::PlanSurroundings& surroundings,
                                                        const tunnels::KneeSurroundings& knee,
                                                        const tunnels::PlanCheck& of_landmarks);

// The same while the side of the knee is in doubt, for a reason that is not empty: what is fine on a knee of
// that side alone, as an entry on the lateral wall, is not checked. What is not fine stays so.
[[nodiscard]] std::vector<tunnels::PlanCheck> as_side_is_doubted(std::vector<tunnels::PlanCheck> checks,
                                                                 const std::string& side_doubt);

// A case that is only looked at.
class CaseReview {
 public:
  // Takes the landmarks as the case has them: what they don't give is not checked. Half a second a bone.
  // by_shape: what propose_landmarks() gave of these bones; of a bone that is not in it no landmark is
  // checked. doubts: what spoke against the bones; the checks are as it leaves them.
  explicit CaseReview(const cases::Case& knee, const std::map<bones::BoneKind, ProposedBone>& by_shape = {},
                      const cases::BoneDoubts& doubts = {});

  [[nodiscard]] bool has_bone(bones::BoneKind kind) const { return bones_.contains(kind); }
  // Precondition: has_bone(kind).
  [[nodiscard]] const ReviewedBone& bone(bones::BoneKind kind) const { return bones_.at(kind); }
  // Whether its landmarks lie where its shape puts them. Precondition: has_bone(kind).
  [[nodiscard]] const tunnels::PlanCheck& landmark_check(bones::BoneKind kind) const {
    return landmark_checks_.at(kind);
  }
  // Those of the plan on a bone of the case.
  [[nodiscard]] const MeasuredPlan& tunnels() const { return planned_; }
  // Empty without that tunnel.
  [[nodiscard]] std::vector<tunnels::PlanCheck> checks(const tunnels::TunnelKey& key) const;

 private:
  std::map<bones::BoneKind, ReviewedBone> bones_;
  std::map<bones::BoneKind, tunnels::PlanCheck> landmark_checks_;
  MeasuredPlan planned_;
  tunnels::KneeSurroundings knee_;
  std::string side_doubt_;
};

}  // namespace arthronaut::plan_review
