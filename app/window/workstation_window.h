// The whole window: modes, bars, the open case, and the loop that keeps the frame order.
#pragma once

#include <string_view>
#include <vector>

#include "app/planning_view/planning_view.h"
#include "app/review_view/review_view.h"
#include "app/setup_view/setup_view.h"
#include "app/theatre_view/theatre_view.h"
#include "app/widgets/graphics_window.h"
#include "app/window/case_opening.h"
#include "app/window/plan_history.h"
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
  CaseOpening case_;
  widgets::Actions actions_;
  widgets::WidgetLog log_;
  PlanHistory history_;
  sources::DeviceTurns camera_turns_;  // of Set up and Navigate
  planning_view::PlanningView planning_;
  setup_view::SetupView setup_;
  theatre_view::TheatreView theatre_;
  review_view::ReviewView review_;
  Mode mode_ = Mode::Plan;
  bool shows_keys_ = false, quits_ = false;
};

}  // namespace arthronaut::window
