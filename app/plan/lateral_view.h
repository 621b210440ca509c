// The true lateral view of the femur: a radiograph made of its surface along the line through both condyles,
// so that these are superposed, with Bernard and Hertel's grid, the norm and the tunnel on it. Where surgeons
// read the percentages; a real radiograph is always a little turned.
#pragma once

#include <vector>

#include "app/case/plan_model.h"
#include "app/scene/reslice.h"
#include "app/widgets/controls.h"
#include "app/widgets/grey_texture.h"

namespace arthronaut::plan {

class LateralView {
 public:
  void open(const open_case::PlanModel* model);  // another case
  void draw(const widgets::Ui& ui, const widgets::Rect& area);

 private:
  void draw_grid(const widgets::Ui& ui, const widgets::Rect& area) const;

  const open_case::PlanModel* model_ = nullptr;
  scene::SlicePlane plane_;
  Eigen::Vector2i size_px_{0, 0};
  widgets::GreyTexture texture_;
};

}  // namespace arthronaut::plan
