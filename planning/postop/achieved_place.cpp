#include "planning/postop/achieved_place.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <limits>
#include <utility>

#include "planning/files/format.h"

namespace arthronaut::postop {

namespace {

using Eigen::Vector3d;
using landmarks::AnatomicalDirection;

std::vector<AchievedPlace::Share> shares(const Vector3d& planned, const Vector3d& achieved,
                                         const tunnels::PlanSurroundings& surroundings) {
  if (const auto& quadrant = surroundings.quadrant) {
    const auto from = quadrant->percent_of(planned), to = quadrant->percent_of(achieved);
    return {{"Deep to shallow", from.deep_shallow, to.deep_shallow},
            {"High to low", from.high_low, to.high_low}};
  }
  if (const auto& plateau = surroundings.plateau) {
    const auto from = plateau->percent_of(planned), to = plateau->percent_of(achieved);
    return {{"Anterior to posterior", from.anterior_posterior, to.anterior_posterior},
            {"Medial to lateral", from.medial_lateral, to.medial_lateral}};
  }
  return {};
}

// The widest and the narrowest of some ten stretches of an even bore lie up to 5.4 errors of their difference
// apart where the marrow is grainy; widened by 2 mm they lie 27 apart.
constexpr double kBeyondErrors = 8;

// Less well known than this, a range says of a wall what there is to say: half of the 1 mm below which a wall
// may break.
constexpr double kMostWallSigma_mm = 0.5;
// How near the surface of a bone out of a CT is to the bone, in the median.
constexpr double kSurface_mm = 0.1;

struct LeastWall {
  double thickness_mm, station_mm;
};

std::optional<LeastWall> wall_of(const tunnels::Tunnel& drilled, double depth_mm,
                                 const geometry::Surface& bone) {
  const auto measured = tunnels::measure(drilled, bone);
  if (!measured.enters_bone || measured.thinnest_station_mm > depth_mm) return std::nullopt;
  return LeastWall{measured.wall_mm, measured.thinnest_station_mm};
}

// One so much wider holds every tunnel whose axis is off by that, and one so much narrower lies within: where
// either leaves another wall than that much less or more, it leaps in between.
void try_walls(const AchievedTunnel& achieved, double depth_mm, const geometry::Surface& bone,
               AchievedPlace& place) {
  const auto wall = wall_of(achieved.tunnel, depth_mm, bone);
  if (!wall ||
      !std::isfinite(achieved.entry_sigma_mm + achieved.direction_sigma_rad + achieved.diameter_sigma_mm))
    return;
  // Across the axis in one of two directions, of the radius, and of the bone's surface.
  const auto side_sigma_mm = [&](double station_mm) {
    return std::sqrt(0.5 * (std::pow(achieved.entry_sigma_mm, 2) +
                            std::pow(achieved.direction_sigma_rad * station_mm, 2)) +
                     std::pow(0.5 * achieved.diameter_sigma_mm, 2) + kSurface_mm * kSurface_mm);
  };
  constexpr double kSigmas = 2;
  const double by_mm = kSigmas * side_sigma_mm(achieved.length_mm);
  double leap_mm = 0;
  place.least_wall_mm = place.most_wall_mm = wall->thickness_mm;
  for (const double wider_mm : {by_mm, -by_mm}) {
    tunnels::Tunnel other = achieved.tunnel;
    other.diameter_mm += 2 * wider_mm;
    const auto moved = wall_of(other, depth_mm, bone);
    if (!moved) return;
    leap_mm = std::max(leap_mm, std::abs(moved->thickness_mm - (wall->thickness_mm - wider_mm)));
    place.least_wall_mm = std::min(place.least_wall_mm, moved->thickness_mm);
    place.most_wall_mm = std::max(place.most_wall_mm, moved->thickness_mm);
  }
  place.wall_sigma_mm = std::hypot(side_sigma_mm(wall->station_mm), leap_mm / kSigmas);
}

constexpr const char* kByProposed = " (by proposed landmarks)";
bool is_by_proposed(const AchievedPlace& place) {
  return place.landmarks_are == landmarks::LandmarkState::Proposed;
}

}  // namespace

AchievedPlace place_of(const tunnels::Tunnel& drilled, double depth_mm, const tunnels::Tunnel& plan,
                       const tunnels::PlanSurroundings& surroundings,
                       landmarks::LandmarkState landmarks_are) {
  AchievedPlace place;
  place.landmarks_are = landmarks_are;
  if (surroundings.axes) {
    const Vector3d off = drilled.entry_mm - plan.entry_mm;
    const landmarks::AnatomicalAxes& axes = *surroundings.axes;
    place.off_mm = {off.dot(axes.anterior), off.dot(axes.proximal), off.dot(axes.lateral)};
    place.axes_from = axes.origin;
  }
  place.grid = shares(plan.entry_mm, drilled.entry_mm, surroundings);
  if (!surroundings.surface) return place;
  const auto planned = tunnels::measure(plan, *surroundings.surface);
  if (planned.enters_bone) place.planned_wall_mm = planned.wall_mm;
  if (const auto wall = wall_of(drilled, depth_mm, *surroundings.surface)) place.wall_mm = wall->thickness_mm;
  return place;
}

AchievedPlace place_of(const AchievedTunnel& achieved, const tunnels::Tunnel& plan,
                       const tunnels::PlanSurroundings& surroundings,
                       landmarks::LandmarkState landmarks_are) {
  constexpr double kOut = std::numeric_limits<double>::infinity();
  const double depth_mm = achieved.comes_out ? kOut : achieved.length_mm;
  AchievedPlace place = place_of(achieved.tunnel, depth_mm, plan, surroundings, landmarks_are);
  if (surroundings.surface) try_walls(achieved, depth_mm, *surroundings.surface, place);
  return place;
}

bool is_wall_known(const AchievedPlace& place) {
  return place.wall_mm.has_value() && std::isfinite(place.wall_sigma_mm);
}

std::string off_in_words(const AchievedPlace& place) {
  constexpr double kNothing_mm = 0.05;  // rounds to 0.0
  std::array<std::pair<AnatomicalDirection, double>, 3> ways{
      {{AnatomicalDirection::Anterior, place.off_mm.x()},
       {AnatomicalDirection::Proximal, place.off_mm.y()},
       {AnatomicalDirection::Lateral, place.off_mm.z()}}};
  std::stable_sort(ways.begin(), ways.end(),
                   [](const auto& a, const auto& b) { return std::abs(a.second) > std::abs(b.second); });
  std::string words;
  for (const auto& [direction, mm] : ways) {
    if (std::abs(mm) < kNothing_mm) continue;
    words += (words.empty() ? "" : ", ") +
             files::format("%.1f mm %s", std::abs(mm), std::string(to_text(direction, mm > 0)).c_str());
  }
  if (words.empty()) return "in place";
  using Origin = landmarks::AnatomicalAxes::Origin;
  if (place.axes_from == Origin::FromScanner)
    words += " (by " + std::string(to_text(place.axes_from)) + ")";
  else if (place.axes_from == Origin::FromLandmarks && is_by_proposed(place))
    words += kByProposed;
  return words;
}

std::string grid_in_words(const AchievedPlace& place) {
  std::string words;
  for (const AchievedPlace::Share& share : place.grid) {
    std::string name(share.name);
    name[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(name[0])));
    words += (words.empty() ? "" : "; ") + files::format("%s %.1f %%, planned %.1f %%", name.c_str(),
                                                         share.achieved_percent, share.planned_percent);
  }
  return words.empty() || !is_by_proposed(place) ? words : words + kByProposed;
}

std::string wall_in_words(const AchievedPlace& place) {
  if (!place.wall_mm) return {};
  const bool grazes = std::isfinite(place.wall_sigma_mm) && place.wall_sigma_mm > kMostWallSigma_mm;
  return (grazes ? files::format("%.1f to %.1f mm, it grazes the bone's surface", place.least_wall_mm,
                                 place.most_wall_mm)
                 : files::format("%.1f mm", *place.wall_mm)) +
         (place.planned_wall_mm ? files::format("; planned %.1f mm", *place.planned_wall_mm) : "");
}

std::string sigma_in_words(double sigma, int decimals) {
  if (!std::isfinite(sigma)) return "\u00B1 not known";
  return files::format("\u00B1 %.*f", decimals, std::max(sigma, std::pow(10.0, -decimals)));
}

std::string length_in_words(const AchievedTunnel& achieved) {
  std::string words = files::format("%.1f mm", achieved.length_mm);
  if (!achieved.end_is_seen) return words + ", its end not seen";
  if (achieved.comes_out) return words;
  words += ", a socket";
  if (achieved.beyond_mm > 0) words += files::format("; beyond it a bore of %.1f mm", achieved.beyond_mm);
  return words;
}

std::string widths_in_words(const std::vector<Width>& widths) {
  if (widths.empty()) return {};
  const auto [least, most] = std::ranges::minmax_element(widths, {}, &Width::diameter_mm);
  std::string from = files::format("%.1f", least->diameter_mm), to = files::format("%.1f", most->diameter_mm);
  if (from == to) return to + " mm";
  const bool is_wider =
      most->diameter_mm - least->diameter_mm > kBeyondErrors * std::hypot(most->sigma_mm, least->sigma_mm);
  return from + " to " + to + " mm" +
         (is_wider ? files::format(", widest %.0f mm from the entry", most->from_entry_mm) : "");
}

}  // namespace arthronaut::postop
