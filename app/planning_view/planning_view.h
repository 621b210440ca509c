// Plan mode: the bones in 3D, the tunnels with their handles, and the numbers. Reads the model, asks for
// changes.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "app/plan_model/plan_model.h"
#include "app/widgets/controls.h"
#include "app/widgets/scene_pane.h"

namespace arthronaut::planning_view {

// A change that the surgeon made; the workstation carries it out, keeps it for undo and saves it.
struct PlanEdit {
  bones::BoneKind bone = bones::BoneKind::Femur;
  std::optional<tunnels::Tunnel> tunnel;  // empty: remove it
  std::string what;                       // "Aim the femoral tunnel"
  bool continues = false;                 // belongs to the edit before it: one drag is one step back
};

// What the plan mode shows beside the model.
struct PlanStatus {
  std::string saved;  // "Saved 11:04:22", or what went wrong
  bool save_failed = false;
  std::string undo_what, redo_what;  // empty: nothing to undo, to redo
};

class PlanningView {
 public:
  PlanningView(std::function<void()> make_current, std::function<void(const PlanEdit&)> edit);

  // plan.* actions; they live as long as this view. `model` may change between calls, null while no case is
  // open.
  void add_actions(widgets::Actions& actions, std::function<const plan_model::PlanModel*()> model);
  void draw(const widgets::Ui& ui, const widgets::Rect& area, const plan_model::PlanModel& model,
            const PlanStatus& status);
  // Another case is open.
  void reset(const plan_model::PlanModel& model);

 private:
  using Move = std::function<std::optional<tunnels::Tunnel>(const plan_model::PlanModel&)>;
  void add_view_actions(widgets::Actions& actions, std::function<const plan_model::PlanModel*()> model);
  void apply(const plan_model::PlanModel& model, const std::string& what, bool continues,
             const Move& move) const;
  void look_from(const plan_model::PlanModel& model, scene::View view);
  void draw_bones(const widgets::Ui& ui, const widgets::Rect& area, const plan_model::PlanModel& model);
  void use_pane_input(const plan_model::PlanModel& model, const widgets::PaneInput& input);
  void draw_handles(const widgets::Ui& ui, const widgets::Rect& area,
                    const plan_model::PlanModel& model) const;
  [[nodiscard]] std::optional<Eigen::Vector3d> aim_handle(const plan_model::PlanModel& model) const;

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
  std::function<void(const PlanEdit&)> edit_;
  ViewState state_;
};

// The column of numbers, checks and buttons beside the bones.
void draw_plan_panel(const widgets::Ui& ui, const widgets::Rect& area, const plan_model::PlanModel& model,
                     bones::BoneKind bone, const PlanStatus& status);

}  // namespace arthronaut::planning_view
