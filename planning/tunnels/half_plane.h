// One half plane through a tunnel's axis: the bone's outline in it, and the least bone beside the tunnel
// there. Inner header of tunnels; what lip and wall are stands in tunnel_wall.h.
#pragma once

#include <array>
#include <limits>
#include <vector>

#include "planning/tunnels/axis_view.h"
#include "planning/tunnels/breach.h"

namespace arthronaut::tunnels {

// By how much a surface is of a mouth's own face, at either end of a cut and linear in between: of the same
// face and facing the drill, where both are positive.
struct LipEnds {
  std::array<double, 2> same{}, facing{};
};

// A face's cut with a half plane: stations and distances from the axis, from low station to high.
struct Cut {
  double from_mm = 0, to_mm = 0, from_radius_mm = 0, to_radius_mm = 0;
  bool comes_out = false;  // straight away from the axis
  LipEnds entry_lip{}, exit_lip{};
  const AxisTriangle* of = nullptr;
  [[nodiscard]] double radius_at(double station) const {
    const double run = to_mm - from_mm;
    if (run <= 0) return std::min(from_radius_mm, to_radius_mm);
    return from_radius_mm + (to_radius_mm - from_radius_mm) * (station - from_mm) / run;
  }
};

struct Thinnest {
  double radius_mm = std::numeric_limits<double>::infinity(), station_mm = 0;
  const AxisTriangle* of = nullptr;  // null on a rim between two lips
  void take(double radius, double station, const AxisTriangle* triangle) {
    if (radius < radius_mm) *this = {radius, station, triangle};
  }
};

// What bone ends at beside the tunnel's side, from one station to the next: outwards of a side that lies in
// bone, towards the axis of one that does not.
struct Stretch {
  double from_mm = 0, to_mm = 0;
  bool in_bone = false;
  const Cut* end = nullptr;  // null: nothing within reach
  [[nodiscard]] double length_mm() const { return to_mm - from_mm; }
  // In its middle; it does not change along a stretch.
  [[nodiscard]] bool is_lip(const LipEnds& lip) const {
    const double run = end->to_mm - end->from_mm;
    const double t = run > 0 ? (0.5 * (from_mm + to_mm) - end->from_mm) / run : 0.5;
    return lip.same[0] + t * (lip.same[1] - lip.same[0]) > 0 &&
           lip.facing[0] + t * (lip.facing[1] - lip.facing[0]) > 0;
  }
};

class HalfPlane {
 public:
  HalfPlane(double length_mm, double radius_mm, double low_mm, double high_mm)
      : length_mm_(length_mm), radius_mm_(radius_mm), low_mm_(low_mm), high_mm_(high_mm) {}

  void clear() { cuts_.clear(); }
  void add(const Cut& cut) { cuts_.push_back(cut); }
  [[nodiscard]] Thinnest thinnest();
  // Of what thinnest() looked at last: where the tunnel's side lies outside the bone, lips left out.
  [[nodiscard]] const std::vector<DepthRange>& outside() const { return outside_; }
  // Of the same: from where the mouth's lip is over to where that of the exit begins; no wall counts before
  // or after. Both ends the same where one lip runs into the other.
  [[nodiscard]] const DepthRange& between_lips() const { return between_lips_; }

 private:
  void find_stations();
  void find_stretches();
  [[nodiscard]] Stretch stretch_at(double from, double to) const;
  void keep_from_mouth_to_mouth();
  void add_outside(const Stretch& stretch);
  template <typename Iterator, typename LipOf>
  [[nodiscard]] static Iterator beyond_lip(Iterator from, Iterator to, LipOf lip_of);

  double length_mm_, radius_mm_, low_mm_, high_mm_;
  std::vector<Cut> cuts_;
  std::vector<const Cut*> open_;
  std::vector<double> stations_;
  std::vector<Stretch> stretches_;
  std::vector<DepthRange> outside_;
  DepthRange between_lips_;
};

}  // namespace arthronaut::tunnels
