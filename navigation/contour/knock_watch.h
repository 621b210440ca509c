// A bone that was knocked: what is seen of it no longer looks as it did (agreement.h), and where that is
// found again further off (knock_search.h), twice at the same place in pictures of different moments, it is
// told like a drift. Where it is not found, the doubt remains and says so.
#pragma once

#include <cstdint>

#include "navigation/contour/agreement.h"
#include "navigation/contour/knock_search.h"

namespace arthronaut::contour {

struct KnockOptions {
  AgreementOptions agreement;
  double searches_below_share = 0.5;  // of pieces that are alike
  // What a search has to find to be believed: correlation by piece that was looked for, and how many pieces
  // it leads by over the bone in its place, and how many times the best place apart from it.
  double least_correlation = 0.3, lead_pieces = 3, over_elsewhere = 1.4;
  double nearest_mm = 1.2;     // across the line of sight; what is nearer the drift test tells
  double same_place_mm = 1.0;  // between two finds
};

struct KnockVerdict {
  bool is_otherwise = false;  // the bone does not look as it did
  bool is_found = false;      // and lies elsewhere
  double knock_mm = 0;        // with is_found: about how far
  bool is_looking = false;    // the first search since it began to look otherwise is not through
  double seen_mm = 0;         // how far off the last search believed to see it; 0: nowhere
};

// Allocates nothing after the construction and reserve_for(). Deterministic.
class KnockWatch {
 public:
  explicit KnockWatch(std::size_t place_count, const KnockOptions& options = {});

  void reserve_for(const Eigen::Vector2i& image_size_px) { search_.reserve_for(image_size_px); }
  void clear();
  // A frame: each piece that was compared, judge() once, and search() with its picture.
  void add(std::size_t index, const ShiftMap& map, bool learns) { agreement_.add(index, map, learns); }
  const KnockVerdict& judge(double elapsed_s);
  void search(const VisibleBone& visible, const SurfaceMemory& memory, const camera::GrayView& luma,
              const camera::CameraModel& camera, const geometry::RigidTransform& camera_from_bone);
  [[nodiscard]] const KnockVerdict& verdict() const { return verdict_; }
  [[nodiscard]] const AgreementVerdict& agreement() const { return agreement_.verdict(); }
  [[nodiscard]] const KnockFound& last_found() const { return search_.found(); }
  [[nodiscard]] int search_count() const { return search_count_; }  // that came to their end

 private:
  [[nodiscard]] bool is_wanted() const;
  [[nodiscard]] bool is_believable(const KnockFound& found) const;

  KnockOptions options_;
  Agreement agreement_;
  KnockSearch search_;
  int search_count_ = 0;
  bool found_before_ = false, has_looked_ = false;
  Eigen::Vector3d before_in_bone_mm_ = Eigen::Vector3d::Zero();
  KnockVerdict verdict_;
};

}  // namespace arthronaut::contour
