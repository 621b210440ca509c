// A planned tunnel against its bone and published norms, one line a question. Norms are in plan_norms.h; they
// are no limits of safety, every one can be changed, and the surgeon decides. What concerns both bones is in
// knee_checks.h.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "planning/bones/unseen_parts.h"
#include "planning/geometry/surface_patch.h"
#include "planning/landmarks/anatomical_axes.h"
#include "planning/landmarks/insertion_grids.h"
#include "planning/tunnels/plan_norms.h"
#include "planning/tunnels/tunnel.h"
#include "planning/tunnels/tunnel_places.h"

namespace arthronaut::tunnels {

struct PlanCheck {
  // Fine: as the norm has it. Look: outside of it. Wrong: the tunnel can't be drilled like this. Note: a
  // number alone. NotChecked: nobody looked, since something is missing; the text says what. It is no tick.
  enum class Verdict { Fine, Look, Wrong, Note, NotChecked } verdict = Verdict::NotChecked;
  std::string name;         // "Length"
  std::string text;         // "24.1 mm: shorter than 25 mm"; "not checked: ... is missing"
  std::string source = {};  // where the number to compare with comes from; empty when there is none
  // The same as data. The verdict follows from value, least and greatest where these are there.
  std::optional<double> value = {};
  std::string unit = {};                            // of the value and its limits: "mm", "deg", "%", "mm2"
  std::optional<double> least = {}, greatest = {};  // the limits that it was held against
  std::optional<Eigen::Vector3d> at_mm = {};  // the place that it speaks of, bone frame: to be shown there
  // On axes that tell lateral from medial, or on landmarks that were proposed by the side.
  bool rests_on_side = true;
};
// "fine", "look", "wrong", "note", "not checked": the sign beside the number, for files and for those who see
// no colour.
[[nodiscard]] std::string_view to_text(PlanCheck::Verdict verdict);
// Look or wrong: not as the norm has it. What was not checked has not failed.
[[nodiscard]] bool is_failed(const PlanCheck& check);
// "Wall: 0.4 mm at 0.0 mm of depth: may break out, less than 1 mm" of each that is wrong.
[[nodiscard]] std::vector<std::string> wrong_in_words(const std::vector<PlanCheck>& checks);

// What is known of the bone beside the tunnel; a check that lacks its part says so and is not made. Made once
// a bone.
struct PlanSurroundings {
  std::optional<landmarks::FemoralQuadrant> quadrant = {};  // femur
  std::optional<landmarks::TibialGrid> plateau = {};        // tibia
  std::optional<Eigen::Vector3d> native_footprint_mm = {};  // centre of the native insertion
  std::optional<landmarks::AnatomicalAxes> axes = {};
  BoneExtents extents = {};  // along the axes
  landmarks::Landmarks landmarks = {};
  // The bone's, for what is asked of its shape.
  std::shared_ptr<const geometry::Surface> surface = {};
  // Where nobody has seen the bone: of a tunnel that leaves there nobody knows where it leaves the bone, and
  // one that begins there is wrong.
  bones::UnseenParts unseen = {};
  // The expected footprints of the ligament and of its bundles, as they lie on the bone; a missing one is
  // unknown.
  std::map<norms::Bundle, geometry::SurfacePatch> footprints = {};

  // Whether the landmarks give the percentages of a point on this bone.
  [[nodiscard]] bool has_grid() const { return quadrant || plateau; }
};
// Without footprints, which come from norms. surface: of that mesh; without it the entry is not
// checked.
[[nodiscard]] PlanSurroundings surroundings_of(const geometry::TriangleMesh& bone, bones::BoneKind kind,
                                               const landmarks::Landmarks& landmarks, bones::Side side,
                                               std::shared_ptr<const geometry::Surface> surface = nullptr);

// The angle between the tunnel's projection on the coronal plane and the plateau's medial-lateral line, in
// the bone's own axes, degrees in [0, 90]: 90 is a tunnel along the tibia's long axis.
[[nodiscard]] double coronal_angle_deg(const Eigen::Vector3d& direction,
                                       const landmarks::AnatomicalAxes& axes);

// In a fixed order, length first. A tunnel of one bundle is held against that bundle's norms. A tunnel that
// misses the bone gives one check, which says so. About a millisecond.
[[nodiscard]] std::vector<PlanCheck> check_plan(const Tunnel& tunnel, const TunnelGeometry& geometry,
                                                const PlanSurroundings& surroundings,
                                                const PlanNorms& norms = {});

}  // namespace arthronaut::tunnels
