// Plan mode: the bones in 3D, the tunnels with their handles, and the numbers. Reads the model; every change
// goes through the history, which saves it.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "app/case/plan_history.h"
#include "app/case/plan_model.h"
#include "app/mode/mode.h"
#include "app/plan/bone_pane.h"

namespace arthronaut::plan {

class PlanView : public mode::Mode {
 public:
  explicit PlanView(std::function<void()> make_current);

  [[nodiscard]] mode::ModeTitle title() const override;
  [[nodiscard]] std::vector<std::string_view> action_prefixes() const override { return {"plan."}; }
  void add_actions(widgets::Actions& actions) override;
  void case_opened(const mode::OpenCase& opened) override;
  void leave() override { history_.settle_now(); }
  void tick(double now_s) override;
  void draw(const widgets::Ui& ui, const widgets::Rect& area) override;
  [[nodiscard]] bool is_busy() const override { return history_.is_moving(); }

 private:
  // plan_actions.cpp
  void add_view_actions(widgets::Actions& actions);
  void add_history_actions(widgets::Actions& actions);
  void add_tunnel_actions(widgets::Actions& actions);
  void add_placing_actions(widgets::Actions& actions);

  // The tunnel of the bone that is planned becomes this one; nothing where there is none.
  void change(const std::string& what, bool continues, const std::optional<tunnels::Tunnel>& tunnel);
  void look_from(scene::ViewDirection view);
  void draw_bones(const widgets::Ui& ui, const widgets::Rect& area);
  void draw_conflict(const widgets::Ui& ui, const widgets::Rect& area) const;
  void show_content();
  [[nodiscard]] std::vector<PaneMark> marks() const;
  void follow(const PaneEvent& event);
  void place_entry(const scene::SceneRay& ray);
  [[nodiscard]] std::optional<Eigen::Vector3d> aim_handle() const;

  struct ViewState {
    bones::BoneKind bone = bones::BoneKind::Femur;
    bool places_entry = false;
    bool has_dragged = false;
    std::string hint = {};  // why a click did nothing; until the next one
    std::uint64_t shown_revision = 0;
  };

  open_case::PlanModel* model_ = nullptr;  // null until a case is open
  open_case::PlanHistory history_;
  BonePane bones_;
  ViewState state_;
};

// The column of numbers, checks and buttons beside the bones.
void draw_plan_panel(const widgets::Ui& ui, const widgets::Rect& area, const open_case::PlanModel& model,
                     bones::BoneKind bone, const open_case::PlanStatus& status);

}  // namespace arthronaut::plan
