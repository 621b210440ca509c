// Whether what is seen fits the bone where it is said to be, or better a bone that lies up to 1.75 mm off. It
// holds one score for each of many displacements at once, in the bone's frame, and forgets within a second:
// no start value, no local optimum, and what the picture cannot tell apart (along the line of sight, along a
// straight edge) stays a tie, which is no drift.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "navigation/contour/edge_search.h"
#include "navigation/contour/surface_memory.h"

namespace arthronaut::contour {

// A picture counts for no longer than this, however long after the one before it comes: in between nobody
// looked.
inline constexpr double kLongestGap_s = 0.2;

struct DriftTestOptions {
  double memory_s = 0.5;
  double null_radius_mm = 0.4;   // about the reference: the registration's own error, and the search's
  double drift_radius_mm = 0.7;  // from the reference on it is a drift
  // By how much the best drift leads before it counts, in pieces of outline or surface that speak for it, and
  // as a share of what speaks for the null.
  double lead_pieces = 0.3, lead_share = 0.03;
  // And what it comes to by piece, of 1: below it nothing fits, under blood or smoke, and what leads is
  // chance.
  double fits_share = 0.12;
  // By how much a drift would have to lead for its direction to count as checked: by more, so that a view
  // that is going is not called checked to its last.
  double seen_pieces = 0.6, seen_share = 0.15;
  double holds_s = 0.3;  // that it leads without a break
  // Of all directions, a drift by 1 mm: the share that would be told, below which nothing is checked.
  double least_share_seen = 0.2;
};

struct DriftVerdict {
  bool is_checked = false;   // enough is seen to tell a drift in some directions
  bool has_drifted = false;  // told, now
  double share_seen = 0;     // of directions in which a drift by 1 mm would be told
  double lead = 0;           // of the best drift over the null
  Eigen::Vector3d offset_in_bone_mm = Eigen::Vector3d::Zero();  // the best displacement there is
  double from_reference_mm = 0;                                 // its distance
};

// Allocates nothing after the construction. Deterministic.
class DriftTest {
 public:
  explicit DriftTest(const DriftTestOptions& options = {});

  // A frame: what is seen in it, then judge() once, `elapsed_s` after the frame before.
  void add(const EdgeProfile& profile);
  void add(const ShiftMap& map);
  const DriftVerdict& judge(double elapsed_s);
  [[nodiscard]] const DriftVerdict& verdict() const { return verdict_; }
  void clear();
  // Displacements are from here on; zero at first.
  void set_reference(const Eigen::Vector3d& in_bone_mm);
  // The displacement that fits best of those within 1 mm of none; of those that fit all but as well, the
  // smallest.
  [[nodiscard]] Eigen::Vector3d best_near_mm() const;

 private:
  enum class Kind : std::uint8_t { Null, Between, Drift };
  void classify();
  [[nodiscard]] Eigen::Vector3d nearest_of_best(Kind kind, float best) const;
  [[nodiscard]] double share_seen(float best, double needed) const;

  DriftTestOptions options_;
  std::vector<Eigen::Vector3f> displacements_;
  std::vector<float> frame_, score_;
  // The grid that displacements lie on: place of each, which lies at a place, and the steps within the null.
  std::vector<int> cells_, about_;
  std::vector<std::int32_t> at_cell_;
  std::vector<Kind> kinds_;
  std::vector<std::uint8_t> at_1_mm_;  // from the reference, about
  Eigen::Vector3d reference_ = Eigen::Vector3d::Zero();
  int frame_pieces_ = 0;
  double pieces_ = 0;  // in the memory, of a frame
  double weight_ = 0, led_for_s_ = 0;
  DriftVerdict verdict_;
};

}  // namespace arthronaut::contour
