// A case's plan with everything that is asked of it: what screen, command line and report say of a tunnel is
// said here, once.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "planning/cases/case.h"
#include "planning/geometry/surface.h"
#include "planning/norms/footprint.h"
#include "planning/tunnels/knee_checks.h"
#include "planning/tunnels/plan_checks.h"

namespace arthronaut::plan_review {

// What the checks ask of one bone. Made once a bone and its landmarks.
struct ReviewedBone {
  std::shared_ptr<const geometry::Surface> surface;  // never null
  tunnels::PlanSurroundings surroundings;
  // By the default norm; nullopt where the landmarks give no grid.
  std::optional<norms::ExpectedFootprint> footprint;
};
// surface: of that mesh, not null.
[[nodiscard]] ReviewedBone review_bone(const geometry::TriangleMesh& mesh, bones::BoneKind kind,
                                       bones::Side side, const landmarks::Landmarks& landmarks,
                                       std::shared_ptr<const geometry::Surface> surface);

// As planned and as measured; null where there is no tunnel, or no bone to measure it in.
struct MeasuredTunnel {
  const tunnels::Tunnel* tunnel = nullptr;
  const tunnels::TunnelGeometry* geometry = nullptr;
};
// The checks of a bone's tunnel, then those of the whole knee that concern it. Empty without that tunnel.
[[nodiscard]] std::vector<tunnels::PlanCheck> checks_of(bones::BoneKind kind, const MeasuredTunnel& femoral,
                                                        const MeasuredTunnel& tibial,
                                                        const tunnels::PlanSurroundings& surroundings,
                                                        const tunnels::KneeSurroundings& knee);

// A case that is only looked at.
class CaseReview {
 public:
  // Takes the landmarks as the case has them: what they don't give is not checked. Half a second a bone.
  explicit CaseReview(const cases::Case& knee);

  [[nodiscard]] bool has_bone(bones::BoneKind kind) const { return bones_.contains(kind); }
  // Precondition: has_bone(kind).
  [[nodiscard]] const ReviewedBone& bone(bones::BoneKind kind) const { return bones_.at(kind); }
  // Null members where the plan has no such tunnel or the case no such bone.
  [[nodiscard]] MeasuredTunnel tunnel(bones::BoneKind kind) const;
  [[nodiscard]] std::vector<tunnels::PlanCheck> checks(bones::BoneKind kind) const;

 private:
  struct Planned {
    tunnels::Tunnel tunnel;
    tunnels::TunnelGeometry geometry;
  };
  std::map<bones::BoneKind, ReviewedBone> bones_;
  std::map<bones::BoneKind, Planned> planned_;
  tunnels::KneeSurroundings knee_;
};

}  // namespace arthronaut::plan_review
