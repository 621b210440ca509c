// The whole window: modes, bars, the open case, and the loop that keeps the frame order.
#pragma once

#include <string_view>
#include <vector>

#include "app/case/case_opening.h"
#include "app/case/plan_history.h"
#include "app/navigate/navigate_view.h"
#include "app/plan/plan_view.h"
#include "app/review/review_view.h"
#include "app/setup/setup_view.h"
#include "app/widgets/graphics_window.h"
#include "app/window/workstation.h"

namespace arthronaut::window {

enum class Mode { Plan, SetUp, Navigate, Review };

class WorkstationWindow {
 public:
  explicit WorkstationWindow(const WorkstationOptions& options);
  // Until the window closes or the frames are up.
  void run();

 private:
  void add_actions();
  void frame(double timeout_s);
  void take_opened_case();
  void dispatch_keys();
  // What the ids of the actions that work now start with.
  [[nodiscard]] std::vector<std::string_view> action_prefixes() const;
  void go_to(Mode mode);
  void draw_screen(const widgets::Ui& ui);
  void draw_top_bar(const widgets::Ui& ui, const widgets::Rect& area);
  void draw_status_bar(const widgets::Ui& ui, const widgets::Rect& area);
  void draw_waiting(const widgets::Ui& ui, const widgets::Rect& area);
  [[nodiscard]] bool pictures_come() const;  // in the mode that is shown, or recorded behind it
  [[nodiscard]] bool is_busy() const;

  WorkstationOptions options_;
  widgets::GraphicsWindow window_;
  open_case::CaseOpening case_;
  widgets::Actions actions_;
  widgets::WidgetLog log_;
  open_case::PlanHistory history_;
  sources::DeviceTurns camera_turns_;  // of Set up and Navigate
  plan::PlanView planning_;
  setup::SetupView setup_;
  navigate::NavigateView navigate_;
  review::ReviewView review_;
  Mode mode_ = Mode::Plan;
  bool shows_keys_ = false, quits_ = false;
};

}  // namespace arthronaut::window
