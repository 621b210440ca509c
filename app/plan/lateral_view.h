// The lateral view of a bone: a radiograph made of its surface. Of the femur along the line through both
// condyles, so that these are superposed, with Bernard and Hertel's grid, the norm and the tunnel on it; of
// the tibia along its plateau, with the line on which Amis and Jakob measure from front to back. Where
// surgeons read the percentages; a real radiograph is always a little turned.
#pragma once

#include <string>
#include <vector>

#include "app/case/plan_model.h"
#include "app/scene/reslice.h"
#include "app/widgets/controls.h"
#include "app/widgets/grey_texture.h"

namespace arthronaut::plan {

class LateralView {
 public:
  void open(const open_case::PlanModel* model);  // another case
  struct Shown {
    bones::BoneKind bone = bones::BoneKind::Femur;  // none: this is said
    bool landmarks = false;
    std::string landmark = {};  // that is worked on: named in the picture
  };
  void draw(const widgets::Ui& ui, const widgets::Rect& area, const Shown& shown);

 private:
  [[nodiscard]] ImVec2 at(const widgets::Rect& area, const Eigen::Vector3d& point_mm) const;
  void draw_femoral_grid(const widgets::Ui& ui, const widgets::Rect& area) const;
  // Returns where its numbers stand, as corners: no other word is put there.
  std::vector<ImVec4> draw_tibial_line(const widgets::Ui& ui, const widgets::Rect& area) const;
  void draw_landmarks(const widgets::Ui& ui, const widgets::Rect& area, const Shown& shown) const;
  // The circles of the tunnels' entries, as corners.
  [[nodiscard]] std::vector<ImVec4> entries_on_screen(const widgets::Rect& area, bones::BoneKind bone) const;
  // Returns what is said of their entries.
  std::string draw_tunnels(const widgets::Ui& ui, const widgets::Rect& area, bones::BoneKind bone) const;
  void show_percents(const widgets::Ui& ui, const widgets::Rect& area, bones::BoneKind bone) const;

  const open_case::PlanModel* model_ = nullptr;
  scene::SlicePlane plane_;
  Eigen::Vector2i size_px_{0, 0};
  bones::BoneKind bone_ = bones::BoneKind::Femur;  // of the texture
  widgets::GreyTexture texture_;
};

}  // namespace arthronaut::plan
