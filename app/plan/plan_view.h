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
#include "app/widgets/scene_pane.h"

namespace arthronaut::plan {

class PlanView : public mode::Mode {
 public:
  explicit PlanView(std::function<void()> make_current);

  [[nodiscard]] mode::ModeTitle title() const override;
  [[nodiscard]] std::vector<std::string_view> action_prefixes() const override { return {"plan."}; }
  void add_actions(widgets::Actions& actions) override;
  void case_opened(const mode::OpenCase& opened) override;
  void leave() override { history_.settle_now(); }
  void tick(double now_s) override { history_.settle(now_s); }
  void draw(const widgets::Ui& ui, const widgets::Rect& area) override;
  [[nodiscard]] bool is_busy() const override { return history_.is_moving(); }

 private:
  void add_view_actions(widgets::Actions& actions);
  void add_history_actions(widgets::Actions& actions);
  void add_tunnel_actions(widgets::Actions& actions);
  // The tunnel of the bone that is planned becomes this one; nothing where there is none.
  void change(const std::string& what, bool continues, const std::optional<tunnels::Tunnel>& tunnel);
  void look_from(scene::ViewDirection view);
  void draw_bones(const widgets::Ui& ui, const widgets::Rect& area);
  void use_pane_input(const widgets::PaneInput& input);
  void draw_handles(const widgets::Ui& ui, const widgets::Rect& area) const;
  [[nodiscard]] std::optional<Eigen::Vector3d> aim_handle() const;

  enum class Handle { None, Entry, Aim };
  struct ViewState {
    bones::BoneKind bone = bones::BoneKind::Femur;
    std::optional<bones::BoneKind> only;
    bool see_through = false, places_entry = false;
    Handle dragged = Handle::None;
    bool has_dragged = false;
    std::uint64_t shown_revision = 0;
    double aspect = 1.5;
    scene::ViewDirection looked_from = scene::ViewDirection::Anterior;
  };

  open_case::PlanModel* model_ = nullptr;  // null until a case is open
  open_case::PlanHistory history_;
  widgets::ScenePane pane_;
  ViewState state_;
};

// The column of numbers, checks and buttons beside the bones.
void draw_plan_panel(const widgets::Ui& ui, const widgets::Rect& area, const open_case::PlanModel& model,
                     bones::BoneKind bone, const open_case::PlanStatus& status);

}  // namespace arthronaut::plan
