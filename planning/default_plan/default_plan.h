// A first plan without a hand: tunnels through the native footprint where a person marked it, else through
// the one that norms expect, aimed as a drill can follow so that they pass the plan's own checks where
// the bone lets them. What the window's one key and `arthronaut plan --default` call. A proposal: the
// surgeon moves it.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "planning/bones/bone.h"
#include "planning/bones/unseen_parts.h"
#include "planning/geometry/surface.h"
#include "planning/landmarks/landmarks.h"
#include "planning/landmarks/propose.h"
#include "planning/norms/insertion_norms.h"
#include "planning/tunnels/plan_checks.h"
#include "planning/tunnels/tunnel.h"

namespace arthronaut::default_plan {

struct Options {
  norms::Bundle bundle = norms::Bundle::Whole;
  double diameter_mm = 9.0;  // see tunnels/diameter_range.h
  // Femur: the knee is flexed while the portal's drill goes in; the axis points at the portal then. 110 to
  // 120 degrees is customary through the anteromedial portal.
  double flexion_deg = 115;
  // Tibia: of the guide, between the tunnel and the plane across the bone's long axis, in the sagittal plane;
  // between it and a plateau that slopes backwards it is greater by the slope.
  double guide_deg = 55;
  // Asked between one direction and the next; then the outcome is Stopped.
  std::stop_token stop = {};
  // Throws InvalidInput: field, value, range.
  void check() const;
};

// A bone as the caller has it at hand. `landmarks` and `states` as in the case; where they give no grid or no
// axes, what is proposed takes the place of all of them that nobody confirmed (landmarks::take_proposal).
struct BoneInput {
  const bones::Bone* bone = nullptr;
  const geometry::Surface* surface = nullptr;  // of that mesh
  landmarks::Landmarks landmarks;
  landmarks::LandmarkStates states;
  // Made before and kept by the caller, since it takes a while; without it it is made here.
  const landmarks::Proposal* proposal = nullptr;
  // Of the ligament's other bundle, planned already: bone is left between the two where a drill can follow.
  // Without it either leaves room for the other one of the usual diameter: of two defaults either may be
  // planned first. Where the norms' places leave less bone than the plan's check asks for, the posterolateral
  // entry is moved off its norm, away from the other one on the line between them, by quarters of its spread
  // (one sigma), then the anteromedial one, whose wall is the thinner; beside a planned one the one asked
  // for. DefaultTunnel::place says how far.
  const tunnels::Tunnel* beside = nullptr;
  // Where nobody has seen the bone: a direction that leaves there is taken where no other one passes.
  bones::UnseenParts unseen = {};
};

// The entry nearest to the norm's place and within its spread that passes every check of the tunnel alone.
// Where none does and the tunnel at the norm's place is wrong: one where nothing is, the fewest checks fail,
// and of these the wall is thickest.
struct OtherEntry {
  Eigen::Vector3d entry_mm = Eigen::Vector3d::Zero();
  std::vector<tunnels::PlanCheck> failed;  // to be looked at there, as DefaultTunnel::failed
  [[nodiscard]] bool passes() const { return failed.empty(); }
};

struct DefaultTunnel {
  enum class Outcome {
    NotRun,
    Planned,
    NoLandmarks,  // the shape gives no landmarks, and nobody placed those that the grid needs
    NoFootprint,  // no bone at the norm's place of the grid
    NoAim,        // no direction that a drill can follow stays in the bone
    Stopped,      // by Options::stop
  } outcome = Outcome::NotRun;
  std::string message = "no default was asked for";
  tunnels::Tunnel tunnel;
  std::string source;      // of the norm that the entry follows
  double off_norm_mm = 0;  // how far the entry was moved off the norm's place
  // The same in words, and why: "1.1 mm off the norm's place, away from the AM tunnel, for 2.0 mm of bone
  // between the two: 0.9 mm at the norm's place".
  std::string place;
  std::vector<std::string> doubts;  // why the plan is not reliable: proposed landmarks, doubts of the shape
  // The plan's checks of this tunnel alone (check_plan) that no direction passes which was tried from there.
  // Not that of its diameter, which was asked for: the plan's own checks say that. With them "Exit", not
  // checked, where every one leaves unseen.
  std::vector<tunnels::PlanCheck> failed;
  // Of a single tunnel of which some fail: an entry within the norm's spread from which one of the same aim
  // does better. `place` says where it lies. The surgeon may move there (moved_within_spread).
  std::optional<OtherEntry> other_entry;
  [[nodiscard]] bool is_usable() const { return outcome == Outcome::Planned; }
};

// One bone. Throws InvalidInput for options out of range alone.
[[nodiscard]] DefaultTunnel plan_bone(const BoneInput& input, bones::Side side, const Options& options = {});

// Entered at `other_entry` instead of at the norm's place; `place` says how far off that it is and what
// failed there, `failed` what does here. As it was where nothing within the norm's spread is better, or
// nothing failed. Which place passes may differ by 1 to 2 mm between two scans of a bone, so nobody is moved
// there unasked.
[[nodiscard]] DefaultTunnel moved_within_spread(DefaultTunnel made);

// What to keep clear of: the tunnel of the other bundle in that bone. Null for the whole ligament's, and
// where there is none.
[[nodiscard]] const tunnels::Tunnel* beside(const tunnels::TunnelKey& key,
                                            const std::map<tunnels::TunnelKey, tunnels::Tunnel>& planned);

}  // namespace arthronaut::default_plan
