// What the program has to say about a planned tunnel. The numbers are customs and means of studies, each with its
// source; they are no limits of safety, and the surgeon decides.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "planning/bones/bone.h"
#include "planning/tunnels/tunnel.h"

namespace arthronaut::planning_view {

struct PlanCheck {
  enum class Verdict { Fine, Look, Wrong, Note } verdict = Verdict::Note;
  std::string name;    // "Length"
  std::string text;    // "34.1 mm"
  std::string source;  // where the number to compare with comes from; empty when there is none
};

// native_footprint_mm: centre of the native insertion in the bone's frame, where it is known.
[[nodiscard]] std::vector<PlanCheck> check_plan(const tunnels::Tunnel& tunnel,
                                                const tunnels::TunnelGeometry& geometry,
                                                const std::optional<Eigen::Vector3d>& native_footprint_mm);

// "21 mm proximal, 14 mm lateral, 3 mm anterior" of a displacement in LPS; parts below half a millimetre are left out.
[[nodiscard]] std::string anatomical_text(const Eigen::Vector3d& displacement_mm, bones::Side side);

}  // namespace arthronaut::planning_view
