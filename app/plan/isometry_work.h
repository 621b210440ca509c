// The map of how much the graft's length changes over flexion, wherever on the lateral wall of the notch it
// could begin: whether there can be one, what is said of it, and its making beside the screen.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/case/plan_model.h"
#include "app/scene/scene_content.h"
#include "navigation/worker/worker.h"
#include "planning/cases/bone_doubts.h"
#include "planning/tunnels/isometry_map.h"

namespace arthronaut::plan {

// All that the map rests on; it is read by another thread. The femoral tunnel is none of it: while that is
// dragged over the map, the map stays.
struct IsometryRequest {
  std::shared_ptr<const geometry::Surface> femur;
  landmarks::AnatomicalAxes axes;
  tunnels::BoneExtents extents;
  graft::FlexionAxis axis;
  Eigen::Vector3d tibial_opening_mm = Eigen::Vector3d::Zero();

  [[nodiscard]] bool has_wall_of(const IsometryRequest& other) const;  // the same
  [[nodiscard]] bool is_same_as(const IsometryRequest& other) const;
  // Of that place of the femur's surface, with its normal; nullopt where it is none of the wall's.
  [[nodiscard]] std::optional<tunnels::LengthChange> at(const Eigen::Vector3d& point_mm,
                                                        const Eigen::Vector3d& normal) const;
};

// Either is there.
struct IsometryAsked {
  std::optional<IsometryRequest> request = {};
  std::string why_not = {};  // "the side is in doubt: ..."
};
// key: of the femur. There is a map where the check "Length over flexion" is made of the tunnel, and nothing
// that it rests on is in doubt: the side, the femur's landmarks, the tibial entry.
[[nodiscard]] IsometryAsked isometry_asked(const open_case::PlanModel& model, const tunnels::TunnelKey& key,
                                           const cases::BoneDoubts& doubts);

// What the map is of, what the hinge leaves out, and of which knee nobody confirmed the landmarks: a line
// each.
[[nodiscard]] std::vector<std::string> isometry_in_words(const open_case::PlanModel& model,
                                                         const tunnels::TunnelKey& key,
                                                         const IsometryRequest& request);

// From dark blue, where the length changes least, to yellow: to be told apart without red and green, and by
// how bright they are.
[[nodiscard]] scene::Color isometry_color(std::size_t band, std::size_t count);

struct ShownIsometry {
  IsometryRequest of;
  tunnels::IsometryMap map;
  std::vector<scene::BoneItem> items;  // the bands, lifted off the bone by as much as keeps them before it
};
[[nodiscard]] ShownIsometry shown_isometry(const IsometryRequest& of, const geometry::TriangleMesh& wall);

class IsometryWork {
 public:
  // wake: called from the working thread when there is something new.
  explicit IsometryWork(const std::function<void()>& wake);
  // Of that very request, asked for when it is not yet; null until it is there.
  [[nodiscard]] std::shared_ptr<const ShownIsometry> of(const IsometryRequest& request);

 private:
  std::optional<IsometryRequest> asked_;
  worker::Worker<IsometryRequest, ShownIsometry> worker_;
};

}  // namespace arthronaut::plan
