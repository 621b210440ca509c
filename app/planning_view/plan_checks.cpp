#include "app/planning_view/plan_checks.h"

#include <array>
#include <cmath>
#include <cstdio>

namespace arthronaut::planning_view {

namespace {

using Verdict = PlanCheck::Verdict;

// Customary warning limits; shown as such.
constexpr double kShortTunnel_mm = 25, kThinWall_mm = 2, kBrokenWall_mm = 1;
constexpr double kSmallGraft_mm = 8, kWideTunnel_mm = 11;

std::string mm(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.1f mm", value);
  return text.data();
}

}  // namespace

std::vector<PlanCheck> check_plan(const tunnels::Tunnel& tunnel, const tunnels::TunnelGeometry& geometry,
                                  const std::optional<Eigen::Vector3d>& native_footprint_mm) {
  if (!geometry.enters_bone)
    return {{Verdict::Wrong, "Axis", "misses the bone: place the entry on it and aim inwards", ""}};
  std::vector<PlanCheck> checks;
  const bool is_short = geometry.length_mm < kShortTunnel_mm;
  checks.push_back({is_short ? Verdict::Look : Verdict::Fine, "Length",
                    mm(geometry.length_mm) + (is_short ? ": short" : ""), "25 mm and more is customary"});
  const Verdict wall = geometry.wall_mm < kBrokenWall_mm ? Verdict::Wrong
                       : geometry.wall_mm < kThinWall_mm ? Verdict::Look
                                                         : Verdict::Fine;
  const char* wall_word = wall == Verdict::Wrong ? ": may break out" : wall == Verdict::Look ? ": thin" : "";
  checks.push_back({wall, "Wall", mm(geometry.wall_mm) + wall_word, "2 mm and more is customary"});
  const bool small = tunnel.diameter_mm < kSmallGraft_mm, wide = tunnel.diameter_mm > kWideTunnel_mm;
  checks.push_back({small || wide ? Verdict::Look : Verdict::Fine, "Diameter",
                    mm(tunnel.diameter_mm) + (small ? ": small" : wide ? ": wide" : ""),
                    "grafts of 8 mm and more are called adequate (PMC6024536); up to 11 mm is customary"});
  if (native_footprint_mm)
    checks.push_back({Verdict::Note, "Footprint",
                      mm((tunnel.entry_mm - *native_footprint_mm).norm()) + " from its centre", ""});
  return checks;
}

std::string anatomical_text(const Eigen::Vector3d& displacement_mm, bones::Side side) {
  const double lateral = side == bones::Side::Right ? -displacement_mm.x() : displacement_mm.x();
  struct Part {
    double value;
    const char *positive, *negative;
  };
  const std::array<Part, 3> parts{Part{displacement_mm.z(), "proximal", "distal"}, Part{lateral, "lateral", "medial"},
                                  Part{-displacement_mm.y(), "anterior", "posterior"}};
  std::string text;
  for (const Part& part : parts) {
    if (std::abs(part.value) < 0.5) continue;
    if (!text.empty()) text += ", ";
    text += std::to_string(std::lround(std::abs(part.value))) + " mm " + (part.value > 0 ? part.positive : part.negative);
  }
  return text.empty() ? "at the entry" : text;
}

}  // namespace arthronaut::planning_view
