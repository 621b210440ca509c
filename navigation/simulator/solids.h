// The hard things in front of the simulated lens: printed plates (markers, screw heads, rulers, the
// checkerboard) and round rods. All are met exactly, ray by ray, in the camera frame (mm), so that their
// edges lie where the camera model puts them.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "navigation/simulator/picture_kernel.h"
#include "planning/geometry/rigid_transform.h"

namespace arthronaut::simulator {

// How a surface answers light; colours are linear, blue green red.
struct Skin {
  Eigen::Vector3f albedo_bgr{0.5f, 0.5f, 0.5f};
  float specular = 0;       // strength of the highlight
  int gloss_doublings = 5;  // the highlight's exponent is 2 to this power
};

struct SolidHit {
  double depth_mm = 0;  // along the camera's z axis
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
  int region = 0;  // differs between parts of a solid that look different
};

struct Look {
  Skin skin;
  bool is_print = false;  // of a printed face, whose edges are measured
};

struct Ball {
  Eigen::Vector3d center_mm;
  double radius_mm = 0;
};

class Solid {
 public:
  virtual ~Solid() = default;
  // Where the ray `depth * direction` (direction.z == 1) enters the solid in front of the camera. False: it
  // misses.
  [[nodiscard]] virtual bool hit(const Eigen::Vector3d& direction, SolidHit& hit) const = 0;
  // The same for many rays at once, in single precision (0.001 px): what is nearer than what they met so far,
  // and less than yields_mm behind the bone, is taken for met. Parts are first_part + region; see
  // picture_kernel.h.
  virtual void meet(const RayRow& rays, int count, int first_part, const MetRow& met) const = 0;
  // By region, kRegions at most.
  [[nodiscard]] virtual std::vector<Look> looks() const = 0;
  // How far behind the bone's surface the solid is still drawn: what a surgeon clears out of the way by
  // bending the knee.
  double yields_mm = 0;
  // Balls in the camera frame that cover the solid; none: it may be anywhere in the picture.
  [[nodiscard]] virtual std::vector<Ball> cover() const = 0;
};

// A printed square of count x count cells, its black border included; row 0 is the marker's top.
struct MarkerCells {
  int count = 0;
  std::vector<bool> is_white;  // row by row; at most 16 x 16
  bool operator==(const MarkerCells&) const = default;
};
// The whole printed square of DICT_4X4_50, its black border included. id in 0..49.
[[nodiscard]] MarkerCells marker_cells(int id);

struct PrintedMarker {
  Eigen::Vector2d center_mm = Eigen::Vector2d::Zero();  // on the plate
  double size_mm = 4;
  MarkerCells cells;
};

// A flat plate whose printed face is z = 0 of its own frame, z towards the viewer, with thickness behind it.
struct PlateShape {
  Eigen::Vector2d half_size_mm{3, 3};
  bool is_round = false;  // a disc of radius half_size_mm.x()
  double thickness_mm = 0.8;
  std::vector<PrintedMarker> markers;
  double tick_spacing_mm = 0;  // > 0: a ruler with ticks along its upper edge
};
[[nodiscard]] std::unique_ptr<Solid> make_plate(const geometry::RigidTransform& camera_from_plate,
                                                const PlateShape& shape);

// A checkerboard without end in z = 0.
[[nodiscard]] std::unique_ptr<Solid> make_checkerboard(const geometry::RigidTransform& camera_from_board,
                                                       double square_mm);

// A rod with round ends; both end points lie radius_mm inside its ends.
[[nodiscard]] std::unique_ptr<Solid> make_rod(const Eigen::Vector3d& from_mm, const Eigen::Vector3d& to_mm,
                                              double radius_mm, const Skin& skin);
[[nodiscard]] Skin steel();

}  // namespace arthronaut::simulator
