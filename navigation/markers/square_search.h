// Finds dark squares on a brighter margin in the whole frame, nothing known: dark regions of the frame at a
// quarter of its size, whose outline is a quadrilateral once it is undistorted. One corner, or a bite out of
// a side, may be covered.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "navigation/camera/camera_model.h"
#include "navigation/camera/frame.h"
#include "navigation/markers/planar_pose.h"

namespace arthronaut::markers {

struct FoundSquare {
  Corners corners_px;  // clockwise in the image, any of them first; good to about 2 px
  Corners tangent;     // the same, undistorted
  double longest_side_px = 0;
  // Something with these corners stands in its place.
  [[nodiscard]] bool is_at(const Corners& others_px) const {
    Eigen::Vector2d apart = Eigen::Vector2d::Zero();
    for (int i = 0; i < 4; ++i) apart += 0.25 * (corners_px[i] - others_px[i]);
    return apart.norm() < 0.5 * longest_side_px;
  }
};

// What counts as dark. Deep: less than usual, for where something half as dark, as blood, lies across the
// margin and joins the square to what is beside it. Faint: more, for where a veil, as smoke, takes the
// contrast.
enum class Contrast { Usual, Deep, Faint };

// The points of an outline while its sides are sought: those that are of one by now, and where the others
// are.
struct OutlinePoints {
  std::vector<char> is_used;
  std::vector<double> xs, ys;
};

// Keeps its memory from call to call; a frame of the same size allocates nothing.
class SquareSearch {
 public:
  [[nodiscard]] std::span<const FoundSquare> find(const camera::GrayView& frame,
                                                  const camera::CameraModel& camera) {
    look_at(frame, camera);
    return find(camera);
  }
  // In two steps: makes the frame smaller for what is asked next; and finds the squares in it.
  void look_at(const camera::GrayView& frame, const camera::CameraModel& camera);
  [[nodiscard]] std::span<const FoundSquare> find(const camera::CameraModel& camera,
                                                  Contrast contrast = Contrast::Usual);
  // In place of find(), or after it: all that it finds, and squares of which a part is hidden. White pixels
  // are left out of the means, since highlights raise what is thought bright; and of each dark region the
  // straight parts of the outline are sought one by one, of which four make a square, whatever lies between
  // them; or three and the ends of the outer two. Where something is white, two regions may be one square,
  // and two sides that meet make one, too. So many of them at a time (kSquaresAtATime): what is left is found
  // by the next calls, from where this one stopped.
  [[nodiscard]] std::span<const FoundSquare> find_covered(const camera::CameraModel& camera);
  // Squares on which highlights lie: dark regions count as one where something white, with the pixel about
  // it, joins them, and their sides are sought as find_covered() does. As many at a time; few, and cheap.
  [[nodiscard]] std::span<const FoundSquare> find_across_highlights(const camera::CameraModel& camera);
  void start_over() { covered_ = {}; }  // another source: from the top again

  // The frame that was looked at last, made smaller: pixel (x, y) shows frame pixels from left + times * x
  // and top + times * y on. Valid until the next call.
  struct SmallPicture {
    camera::GrayView view;
    int left = 0, top = 0, times = 1;
  };
  [[nodiscard]] SmallPicture small_picture() const {
    return {{small_.data(), width_, height_, width_}, left_, top_, shrink_};
  }
  // A pixel of it from here on tells nothing: at least half of what it shows is saturated.
  static constexpr int kWhite = 235;
  // Something in the box about the square, or hardly beside it, is saturated in that frame.
  [[nodiscard]] bool has_highlight(const FoundSquare& square) const;

 private:
  struct Region {
    int left, right, top, bottom, area;
    bool has_white = false;
  };
  // For small pictures of up to this size.
  void reserve(int width, int height);
  // Dark regions that may be of a square.
  void find_regions(Contrast contrast, bool across_white = false);
  void mark_white_pixels();
  [[nodiscard]] bool may_be_square(const Region& region, int least_filled) const;
  void sum_rows(bool without_white);
  void mark_dark_pixels(int radius, int percent);
  void label_regions();
  bool outline_square(int label, const Region& region, const camera::CameraModel& camera,
                      FoundSquare& square);
  // Adds the region's to the outline.
  void trace_outline(int label, const Region& region, const camera::CameraModel& camera);
  // Those of a region's straight parts, and the one that its hull makes.
  void add_squares_of(std::size_t label, const camera::CameraModel& camera);
  // The likeliest squares out of the straight parts of the outline: of four sides, or of three of which the
  // ends show where the last one is.
  void combine_sides(const camera::CameraModel& camera);
  // The same of any two dark regions that are near each other.
  void combine_pieces(const camera::CameraModel& camera);
  // Whether this call has done its part; if not, it looks at one outline more.
  bool is_done_or_takes_outline();
  bool measure_sides(const camera::CameraModel& camera, const std::array<Eigen::Vector2d, 4>& quad,
                     FoundSquare& square) const;
  void take_hull();
  bool straighten_sides(std::array<Eigen::Vector2d, 4>& quad) const;

  int shrink_ = 4;
  int left_ = 0, top_ = 0;      // of the shrunk picture's first pixel, in frame pixels
  int width_ = 0, height_ = 0;  // of the shrunk picture
  std::vector<std::uint8_t> small_;
  std::vector<std::uint16_t> column_sums_;  // of the frame's rows that make one of small_
  std::vector<std::uint32_t> sums_;         // integral image of small_, one row and column larger
  enum class Sums { None, OfAll, WithoutWhite } sums_are_ = Sums::None;
  std::vector<std::uint8_t> dark_, was_dark_;  // was_dark_: before white was marked, too
  int white_pixels_ = 0;
  std::vector<int> labels_;
  // How label_regions() puts them together: of dark pixels side by side, from the first on to before the end;
  // and of each label the one that it belongs to.
  struct Run {
    int row, first, end, label;
  };
  struct {
    std::vector<Run> runs;
    std::vector<int> parents;
  } joined_;
  std::vector<Region> regions_;
  std::vector<int> first_, last_;  // extremes of a region's rows or columns
  std::vector<Eigen::Vector2d> outline_, hull_;
  OutlinePoints points_;
  std::vector<FoundSquare> squares_;
  // Where the search for covered squares goes on: at this region, or at this pair of pieces.
  struct {
    std::size_t next = 0;
    bool is_at_pieces = false;
    std::size_t next_across = 0;  // and the one across highlights, at this region
    int outlines = 0;             // that this call has looked at
  } covered_;
};

}  // namespace arthronaut::markers
