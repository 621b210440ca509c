// What was planned against what was achieved, from a CT after the operation.
//
// For each planned tunnel:
//   1. The plan's bone is found in the images, from nothing and however the patient lay (bone_pose.h), with a
//      verdict. The images' own surfaces are not segmented: an opened bone has no inside that could be told
//      from its outside, and the edges where the plan's surface should be tell the pose to 0.05 mm.
//   2. The drilled tunnel is sought in the voxels within the plan's bone, within 18 mm and 35 degrees of the
//      plan (tunnel_search.h): a straight, round bore, darker than the bone all around it.
//   3. Axis and diameter are fitted to the grey about its wall, metal and what is beside it passed over
//      (tunnel_fit.h). Where the axis crosses the surface of the plan's bone is the entry.
//   4. It is a tunnel only where the cortex under the bone's surface is missing at the entry and there beside
//      it. It ends where it comes out in the same way, or where the grey of its middle steps up.
//
// Use it for CT. What it does not tell: a tunnel whose graft is as dense as the marrow and that has no denser
// rim, or that lies in marrow of fat (not found; what lies beside it is unreliable then, where the missing
// cortex of the hidden one's mouth is seen, or it is more than 12 mm off); which of two tunnels is the
// planned one where one is planned (the nearer, though the other may be seen better; unreliable); a bore that
// is bent, or one of two diameters beyond the first of them. A loose screw alone in a tunnel says nothing of
// the tunnel. Slices of 2 mm and more may be refused: they make a bone look longer.
//
// Frames: everything is in the plan's LPS, mm, unless its name says otherwise. Angles in rad.
#pragma once

#include <limits>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "planning/bones/bone.h"
#include "planning/geometry/rigid_transform.h"
#include "planning/images/volume.h"
#include "planning/postop/goes_on.h"
#include "planning/tunnels/tunnel.h"
#include "planning/tunnels/tunnel_quantity.h"

namespace arthronaut::postop {

// How wide the tunnel is, from the entry on.
struct Width {
  double from_entry_mm = 0;
  double diameter_mm = 0;
  double sigma_mm = std::numeric_limits<double>::infinity();  // one sigma; infinite where a file doesn't say
};

struct AchievedTunnel {
  bool is_found = false;    // false: the numbers are meaningless
  tunnels::Tunnel tunnel;   // the entry on the plan's bone, the direction in the plan's sense
  double length_mm = 0;     // within the bone, to where it comes out, ends or goes on as a thinner bore
  bool comes_out = false;   // else it is a socket
  bool end_is_seen = true;  // false: how long it is is not known; the length is to where images or bone end
  double beyond_mm = 0;     // diameter of the thinner bore that goes on beyond a socket; 0: none is seen
  double offset_mm = 0;     // of the entry from the planned one
  // From the planned entry to where the axis crosses the plane through it across the plan: what guidance
  // calls the offset. Infinite where a file doesn't say.
  double offset_across_mm = std::numeric_limits<double>::infinity();
  double angle_rad = 0;  // between the axes
  // One sigma each; infinite where a file doesn't say, or it is not known. Of entry and direction by the
  // scatter of the grey and the bone's pose. Of the diameter, and of the length: by the grey, and for an end
  // within the bone by how grainy the marrow about it is.
  double entry_sigma_mm = std::numeric_limits<double>::infinity(),
         direction_sigma_rad = std::numeric_limits<double>::infinity(),
         diameter_sigma_mm = std::numeric_limits<double>::infinity(),
         length_sigma_mm = std::numeric_limits<double>::infinity();
  double metal_share = 0;                                         // of what is inside it
  std::vector<Width> widths;                                      // where its wall is seen
  bool reliable = false;                                          // all of it
  std::vector<std::string> reasons = {"compare was not called"};  // why it is not reliable
  // What of it may be relied on all the same, where not all of it may: the reasons are about the rest.
  tunnels::Quantities known = {};
};

// Whether the differences are those to this plan, and not to one of before: to what files round.
[[nodiscard]] bool is_against(const AchievedTunnel& achieved, const tunnels::Tunnel& plan);
// The same of the plan that has this tunnel; false where it has none.
[[nodiscard]] bool is_against(const AchievedTunnel& achieved, const tunnels::TunnelKey& key,
                              const std::map<tunnels::TunnelKey, tunnels::Tunnel>& planned);

struct AchievedBone {
  bool is_found = false;  // false: the pose is meaningless
  geometry::RigidTransform plan_from_postop;
  double rms_mm = 0;         // of the surface off the images' edges, the worst tenth left out
  double on_edge_share = 0;  // of the surface in the images: an edge within 1 mm
  double in_view_share = 0;  // of the surface within 90 mm of the planned entry
  bool reliable = false;
  std::vector<std::string> reasons = {"compare was not called"};
};

// One planned tunnel.
struct Comparison {
  AchievedBone bone;
  AchievedTunnel tunnel;  // reliable only when the bone is
  // Why a file holds this one, though newer images were compared since; empty: none were, or this is of them.
  std::string kept_because = {};
};

// Whether its numbers stand, all of them, whatever became of the plan since.
[[nodiscard]] bool is_relied_on(const Comparison& comparison);
// Which of them do. How much bone is left beside the tunnel follows from all.
[[nodiscard]] tunnels::Quantities relied_on(const Comparison& comparison);
// The same of these: where an axis runs is both its entry and its direction.
[[nodiscard]] bool is_relied_on(const Comparison& comparison, const tunnels::Quantities& quantities);
// Takes all trust from it, for a reason that is told first.
void doubt(Comparison& comparison, const std::string& reason);

enum class ComparisonVerdict {
  BoneNotFound,
  TunnelNotFound,
  OfAnEarlierPlan,
  NotReliable,
  ReliableInPart,
  Reliable
};
// is_of_the_plan: its differences are those to the plan that is there, on the bone that is there.
[[nodiscard]] ComparisonVerdict verdict_of(const Comparison& comparison, bool is_of_the_plan);
// "bone not found in the images", "no tunnel found", "of an earlier plan", "not reliable", "reliable in
// part", "reliable"
[[nodiscard]] std::string_view to_text(ComparisonVerdict verdict);

struct ComparisonOptions {
  // What is as bright is taken for bone where the bone's place is sought from nothing; nothing else. A bone
  // that is not found so is sought among all that is brighter than soft tissue.
  double threshold_hu = 200;
};

// The images of one operation, made ready once for all of its bones. The volume must outlive it.
class PostopImages {
 public:
  // Throws InvalidInput when the images show no bone at all.
  explicit PostopImages(const images::Volume& postop, const ComparisonOptions& options = {});
  ~PostopImages();
  PostopImages(PostopImages&&) noexcept;
  PostopImages& operator=(PostopImages&&) noexcept;

  // `bone`: closed, outward, as it was planned on. Never throws on poor images: read the reasons. The same
  // input gives the same result. 3 to 10 s. Where `goes_on` ended it nothing was found, and compare was not
  // called by what the reasons say.
  // `others`: the bone's other planned tunnel, where there are two. What lies nearer to it is taken for it.
  [[nodiscard]] Comparison compare(const geometry::TriangleMesh& bone, const tunnels::Tunnel& plan,
                                   std::span<const tunnels::Tunnel> others = {},
                                   const GoesOn& goes_on = {}) const;

 private:
  struct Prepared;
  std::unique_ptr<Prepared> prepared_;
};

}  // namespace arthronaut::postop
