// The grey across a bore's wall, as the mean all around and along it: one level inside, one beyond, and
// between them perhaps a dense rim, of bone that the drill pressed together or that healed. What a rim
// thinner than the scanner's blur looks like, a wall further in looks like too. Inner header of postop.
#pragma once

#include <vector>

namespace arthronaut::postop {

// A scanner's blur; the most of a wall without a rim.
inline constexpr double kLeastSeenBlur_mm = 0.2, kMostSeenBlur_mm = 1.3;

struct WallPoint {
  double off_mm;  // outwards
  double hu;      // mean
  double count;   // voxels it is the mean of
};

struct WallProfile {
  double wall_mm = 0;             // where the wall is
  double rim_mm = 0, rim_hu = 0;  // 0: no rim
  double blur_mm = 0.5;           // sigma of the scanner's, voxel included
  // By which a wall without a rim would look most like this, in marrow that may change evenly away from it;
  // 0: not looked for.
  double plain_blur_mm = 0;
  // One sigma of `wall_mm`, by that rims of other thicknesses, or none, explain the same as well or nearly.
  double wall_sigma_mm = 0;
  // Thickness of a layer, of a density between those on its sides, that explains the points clearly better
  // than all of the above, and the inner side of which is more than 0.15 mm within what was taken for the
  // wall; 0: none. Which of its sides was drilled the picture does not tell.
  double layer_mm = 0;

  [[nodiscard]] bool has_rim() const { return rim_mm > 0; }
  // With a rim both or neither, the blur within a tenth, and with a rim the wall within 0.05 mm, a third of
  // what is asked of a diameter on each side. Without a rim nothing follows from where the profile has the
  // wall.
  [[nodiscard]] bool is_like(const WallProfile& other) const;
};

// The three levels' shares of the grey `off_mm` outwards of the wall, and their slopes there.
struct WallGrey {
  double inside, rim, beyond;
  double inside_slope, rim_slope, beyond_slope;  // 1/mm, outwards
};
[[nodiscard]] WallGrey wall_grey(double off_mm, double rim_mm, double blur_mm);

// Explained with a rim where that explains the points clearly better (Schwarz's criterion, the noise from
// what is left unexplained), else without one. Of rims that explain them about as well, the one that has the
// wall where all of them have it in the mean. A rim is 0.3 to 2 mm thick, denser than what is inside and
// beyond, by more than twice `noise_hu`, and no denser than cortex; a fainter one may be grain, and only
// makes the wall uncertain. `noise_hu`: of one voxel, with the bone's grain; `shared`: how many of them share
// it, so that the variance of a mean is so much more. Fewer than 10 points explain nothing: no rim, and
// `wall_sigma_mm` is infinite.
[[nodiscard]] WallProfile explain_wall(const std::vector<WallPoint>& points, double noise_hu, double shared);

}  // namespace arthronaut::postop
