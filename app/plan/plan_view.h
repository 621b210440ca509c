// Plan mode: the bones in 3D, the tunnels with their handles, and the numbers. Reads the model, asks for
// changes.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "app/case/plan_edit.h"
#include "app/case/plan_model.h"
#include "app/widgets/controls.h"
#include "app/widgets/scene_pane.h"

namespace arthronaut::plan {

class PlanView {
 public:
  PlanView(std::function<void()> make_current, std::function<void(const open_case::PlanEdit&)> edit);

  // plan.* actions; they live as long as this view. `model` may change between calls, null while no case is
  // open.
  void add_actions(widgets::Actions& actions, std::function<const open_case::PlanModel*()> model);
  void draw(const widgets::Ui& ui, const widgets::Rect& area, const open_case::PlanModel& model,
            const open_case::PlanStatus& status);
  // Another case is open.
  void reset(const open_case::PlanModel& model);

 private:
  using Move = std::function<std::optional<tunnels::Tunnel>(const open_case::PlanModel&)>;
  void add_view_actions(widgets::Actions& actions, std::function<const open_case::PlanModel*()> model);
  void apply(const open_case::PlanModel& model, const std::string& what, bool continues,
             const Move& move) const;
  void look_from(const open_case::PlanModel& model, scene::View view);
  void draw_bones(const widgets::Ui& ui, const widgets::Rect& area, const open_case::PlanModel& model);
  void use_pane_input(const open_case::PlanModel& model, const widgets::PaneInput& input);
  void draw_handles(const widgets::Ui& ui, const widgets::Rect& area,
                    const open_case::PlanModel& model) const;
  [[nodiscard]] std::optional<Eigen::Vector3d> aim_handle(const open_case::PlanModel& model) const;

  enum class Handle { None, Entry, Aim };
  struct ViewState {
    bones::BoneKind bone = bones::BoneKind::Femur;
    std::optional<bones::BoneKind> only;
    bool see_through = false, places_entry = false;
    Handle dragged = Handle::None;
    bool has_dragged = false;
    std::uint64_t shown_revision = 0;
    double aspect = 1.5;
    scene::View looked_from = scene::View::Anterior;
  };

  widgets::ScenePane pane_;
  std::function<void(const open_case::PlanEdit&)> edit_;
  ViewState state_;
};

// The column of numbers, checks and buttons beside the bones.
void draw_plan_panel(const widgets::Ui& ui, const widgets::Rect& area, const open_case::PlanModel& model,
                     bones::BoneKind bone, const open_case::PlanStatus& status);

}  // namespace arthronaut::plan
