// Where a drilled tunnel lies beside the planned one, in the words that surgeons use: which way its entry is
// off, where both entries are in the bone's grid, and how much bone both leave beside them.
#pragma once

#include <Eigen/Core>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "planning/postop/comparison.h"
#include "planning/tunnels/plan_checks.h"

namespace arthronaut::postop {

struct AchievedPlace {
  // Of the drilled entry from the planned one: anterior, proximal and lateral, along the bone's own axes.
  Eigen::Vector3d off_mm = Eigen::Vector3d::Zero();
  landmarks::AnatomicalAxes::Origin axes_from = landmarks::AnatomicalAxes::Origin::FromScanner;
  // What the landmarks are that axes and grid follow from.
  landmarks::LandmarkState landmarks_are = landmarks::LandmarkState::Confirmed;
  struct Share {
    std::string_view name;  // "Deep to shallow", as the checks of a plan call it
    double planned_percent = 0, achieved_percent = 0;
  };
  std::vector<Share> grid = {};  // empty: the landmarks give none
  // The least bone beside either. Empty: it misses the bone; of a socket also where it is thinnest only
  // beyond the socket's end.
  std::optional<double> planned_wall_mm = {}, wall_mm = {};
  // One sigma of `wall_mm`, and what it may be: by trial, its side two sigma further out and in, the error of
  // a bone's surface counted in. Where the tunnel grazes the bone's surface, what counts as a lip of its
  // mouth and what as a breach changes with a tenth of a millimetre, and the wall leaps. Infinite: nobody
  // knows how well the tunnel is known, or one so little off has no wall.
  double wall_sigma_mm = std::numeric_limits<double>::infinity();
  double least_wall_mm = 0, most_wall_mm = 0;  // meaningless where the sigma is infinite
};

// depth_mm: how far it was drilled, from its entry; infinite: out of the bone, or nobody knows. surroundings:
// of the bone of both, with its axes and its surface. landmarks_are: those of the surroundings.
[[nodiscard]] AchievedPlace place_of(const tunnels::Tunnel& drilled, double depth_mm,
                                     const tunnels::Tunnel& plan,
                                     const tunnels::PlanSurroundings& surroundings,
                                     landmarks::LandmarkState landmarks_are);
// Whether a wall is told and how far it may be off, too.
[[nodiscard]] bool is_wall_known(const AchievedPlace& place);
// Precondition: the tunnel was found.
[[nodiscard]] AchievedPlace place_of(const AchievedTunnel& achieved, const tunnels::Tunnel& plan,
                                     const tunnels::PlanSurroundings& surroundings,
                                     landmarks::LandmarkState landmarks_are);

// "1.9 mm proximal, 0.6 mm posterior", the farthest first, what rounds to nothing left out; "in place" where
// all does. Axes that are only the scanner's, or by landmarks that nobody has looked at, are named.
[[nodiscard]] std::string off_in_words(const AchievedPlace& place);
// "deep to shallow 31.2 %, planned 28.4 %; high to low ...", and that the landmarks are proposed ones where
// they are; empty without a grid.
[[nodiscard]] std::string grid_in_words(const AchievedPlace& place);
// "1.8 mm; planned 2.6 mm"; "0.0 to 4.2 mm, it grazes the bone's surface; planned 2.6 mm" where it is known
// to no better than half a millimetre; empty where the drilled one's is not known.
[[nodiscard]] std::string wall_in_words(const AchievedPlace& place);
// "± 0.12", at least 1 of the last of so many decimals; "± not known" where it is infinite.
[[nodiscard]] std::string sigma_in_words(double sigma, int decimals);
// "27.3 mm"; "22.0 mm, a socket; beyond it a bore of 4.5 mm"; "30.5 mm, its end not seen". Precondition: the
// tunnel was found.
[[nodiscard]] std::string length_in_words(const AchievedTunnel& achieved);
// How wide it is along the wall: "8.9 to 11.6 mm, widest 2 mm from the entry"; without a place where it is no
// wider there than the errors of its widths let expect of an even bore; "9.1 mm" where all of it rounds to
// that; empty where the wall is not seen.
[[nodiscard]] std::string widths_in_words(const std::vector<Width>& widths);

}  // namespace arthronaut::postop
