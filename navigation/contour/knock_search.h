// Where the bone went that was knocked further than the drift test compares: what was kept of its surface is
// looked for in one small picture, at all displacements up to 8 mm. The work is done bit by bit over several
// frames, always on the picture that it was begun with.
//
// Along the line of sight a displacement shows by little but its size, so the steps there are long.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "navigation/camera/camera_model.h"
#include "navigation/camera/frame.h"
#include "navigation/contour/surface_memory.h"
#include "navigation/contour/visible_bone.h"

namespace arthronaut::contour {

struct KnockFound {
  // The displacement that fits best, in the bone's frame; of those that fit all but as well, the smallest.
  Eigen::Vector3d offset_in_bone_mm = Eigen::Vector3d::Zero();
  Eigen::Vector3d ray_in_bone = Eigen::Vector3d::UnitZ();  // unit: the line of sight then
  // Correlations, summed over pieces: at the best displacement, within 1 mm of none, and at the best that
  // lies apart from both.
  double best = 0, in_place = 0, elsewhere = 0;
  int pieces = 0;  // that were looked for
};

// Allocates nothing after reserve_for(). Deterministic: the work of a frame is counted, not timed.
class KnockSearch {
 public:
  KnockSearch();

  // Pictures of up to that size will come; without it a search may allocate.
  void reserve_for(const Eigen::Vector2i& image_size_px);
  // Pieces of what is seen by the registered pose. A search that is under way is given up.
  void begin(const VisibleBone& visible, const SurfaceMemory& memory, const camera::GrayView& luma,
             const camera::CameraModel& camera, const geometry::RigidTransform& camera_from_bone);
  [[nodiscard]] bool is_under_way() const { return next_ < pieces_.size() * kLayers; }
  // A share of the work. Returns whether it was the last: found() is of it then.
  bool advance();
  [[nodiscard]] const KnockFound& found() const { return found_; }
  void clear();

 private:
  static constexpr int kReach = 20;  // steps across the line of sight, to each side
  static constexpr int kLayers = 5;  // along it
  static constexpr int kRow = 2 * kReach + 1;
  static constexpr int kSide = 5;  // samples of a piece to a side
  struct Wanted {
    Eigen::Vector3d in_camera_mm = Eigen::Vector3d::Zero();
    Eigen::Vector3d u_in_camera = Eigen::Vector3d::UnitX(), v_in_camera = Eigen::Vector3d::UnitY();
    std::array<float, kSide * kSide> samples{};  // mean 0, norm 1
  };
  struct Small {  // the picture, by cells of some pixels: their mean
    int width = 0, height = 0, cell_px = 1;
    std::vector<float> luma;
    std::vector<std::uint32_t> sums;  // of a row of cells
  };

  void shrink(const camera::GrayView& luma, int cell_px);
  void look_for(const Wanted& piece, int layer);
  void conclude();
  [[nodiscard]] Eigen::Vector3d displacement_in_camera(int x, int y, int layer) const;

  std::vector<Wanted> pieces_;
  Small small_;
  camera::CameraModel camera_;
  Eigen::Matrix3d across_;  // columns: two directions across the line of sight, and that
  Eigen::Matrix3d bone_from_camera_;
  std::vector<float> score_;  // by layer, y, x
  std::size_t next_ = 0;
  KnockFound found_;
};

}  // namespace arthronaut::contour
