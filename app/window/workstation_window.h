// The whole window: modes, bars, the open case, and the loop that keeps the frame order.
#pragma once

#include <memory>
#include <string_view>
#include <vector>

#include "app/case/case_opening.h"
#include "app/mode/mode.h"
#include "app/widgets/graphics_window.h"
#include "app/widgets/heartbeat.h"
#include "app/window/draw_watch.h"
#include "app/window/workstation.h"

namespace arthronaut::window {

class WorkstationWindow {
 public:
  explicit WorkstationWindow(const WorkstationOptions& options);
  // Until the window closes or the frames are up.
  void run();

 private:
  void make_modes();
  void add_actions();
  void frame(double timeout_s);
  void take_opened_case();
  void dispatch_keys();
  // What the ids of the actions that work now start with.
  [[nodiscard]] std::vector<std::string_view> action_prefixes() const;
  void show(std::size_t mode);
  void draw_screen(const widgets::Ui& ui);
  void draw_top_bar(const widgets::Ui& ui, const widgets::Rect& area);
  void draw_status_bar(const widgets::Ui& ui, const widgets::Rect& area);
  void draw_waiting(const widgets::Ui& ui, const widgets::Rect& area);
  [[nodiscard]] bool should_end();  // the window was closed, and nothing runs that it would cut off
  [[nodiscard]] mode::Mode& shown() const { return *modes_[shown_]; }
  [[nodiscard]] bool modes_are_busy() const;    // in front or behind
  [[nodiscard]] bool has_running_work() const;  // likewise

  WorkstationOptions options_;
  widgets::GraphicsWindow window_;
  open_case::CaseOpening case_;
  widgets::Actions actions_;
  widgets::WidgetLog log_;
  std::vector<std::unique_ptr<mode::Mode>> modes_;  // in the order of their buttons
  std::size_t shown_ = 0;
  widgets::Heartbeat heartbeat_;
  DrawWatch watch_;
  bool shows_keys_ = false, quits_ = false;
};

}  // namespace arthronaut::window
