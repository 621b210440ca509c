// What a joint shows beside bone and tools, as options: soft tissue that sways in the fluid, motes adrift in
// it, the instrument of the other hand. None of it carries a marker, and the truth of a scene is the same
// with it as without; it hides what it lies in front of, as it would. Deterministic by seed and time.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "navigation/simulator/instruments.h"
#include "planning/geometry/surface.h"

namespace arthronaut::simulator {

struct SurroundingsOptions {
  bool soft_tissue = false;  // fronds of synovium on the bone, a fold of the fat pad before the lens
  bool motes = false;        // 0.05 to 0.18 mm, carried by the flow
  bool other_hand = false;   // a shaver that works some 8 mm beside the planned entry
  [[nodiscard]] bool any() const { return soft_tissue || motes || other_hand; }
};

// "soft tissue", "motes", "other hand": those that are there.
[[nodiscard]] std::vector<std::string_view> words_of(const SurroundingsOptions& options);

// Where they are to be, in the bone's frame (LPS, mm).
struct SurroundedPlace {
  Eigen::Vector3d worked_at_mm;               // the planned entry: nothing grows on it
  Eigen::Vector3d kept_free_mm;               // the world marker: nor there
  geometry::RigidTransform bone_from_camera;  // from where the place is seen, about
};

class Surroundings {
 public:
  Surroundings() = default;  // nothing
  Surroundings(const SurroundingsOptions& options, const geometry::Surface& bone,
               const SurroundedPlace& place, std::uint64_t seed);
  // As they are at that time, added to what is in the scene.
  void add(double time_s, const geometry::RigidTransform& camera_from_bone, Solids& solids) const;

 private:
  struct Frond {  // rooted on the bone or in the fold; sways about its root
    Eigen::Vector3d root_mm, direction, sway;
    double length_mm = 0, radius_mm = 0, period_s = 1, phase = 0;
    Skin skin;
  };
  struct Mote {
    Eigen::Vector3d start_mm;  // in the box, from its corner
    Eigen::Vector3d speed_mm_s;
    double radius_mm = 0;
  };
  struct Shaver {
    Eigen::Vector3d portal_mm, tip_mm, side, up;
    double phase = 0;
  };
  void grow(const geometry::Surface& bone, const SurroundedPlace& place, std::uint64_t seed);
  void strew(const SurroundedPlace& place, std::uint64_t seed);
  void bring_shaver(const geometry::Surface& bone, const SurroundedPlace& place, std::uint64_t seed);

  std::vector<Frond> fronds_;
  std::vector<Mote> motes_;
  Eigen::Vector3d box_middle_mm_ = Eigen::Vector3d::Zero();
  std::vector<Shaver> shavers_;  // one or none
};

}  // namespace arthronaut::simulator
