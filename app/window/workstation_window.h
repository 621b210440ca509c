// The whole window: modes, bars, the open case, and the loop that keeps the frame order.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "app/case/case_opening.h"
#include "app/mode/mode.h"
#include "app/paint/paint_view.h"
#include "app/screen_copy/screen_copies.h"
#include "app/start/start_view.h"
#include "app/widgets/graphics_window.h"
#include "app/widgets/heartbeat.h"
#include "app/widgets/slow_screen.h"
#include "app/window/draw_watch.h"
#include "app/window/frame_fault.h"
#include "app/window/room.h"
#include "app/window/untaken_key.h"
#include "app/window/workstation.h"
#include "navigation/worker/letting_go.h"

namespace arthronaut::plan {
class PlanView;
}
namespace arthronaut::review {
class ReviewView;
}

namespace arthronaut::window {

class WorkstationWindow {
 public:
  explicit WorkstationWindow(const WorkstationOptions& options);
  // Until the window closes or the frames are up.
  void run();

 private:
  void make_modes();
  void add_actions();
  void add_screen_actions();
  void end_frame(double now_s);
  // A part of a frame's work or its drawing that throws is broken off there, says why, and the rest follows.
  // Returns whether something cut its wait short.
  bool frame(double timeout_s);
  void work();                                      // what is done in a frame before it is drawn
  bool guarded(const std::function<void()>& part);  // false: it threw
  // Empty: the built-in case. The one that is open stays open until the other one is.
  void open(const std::filesystem::path& folder);
  void take_opened_case();
  [[nodiscard]] bool can_stop_opening() const;
  // Another case than the open one, which is nobody's on the screen meanwhile.
  [[nodiscard]] bool opens_another() const { return opening_ != nullptr && lender_ != case_.get(); }
  void draw_opening(const widgets::Ui& ui, const widgets::Rect& area) const;
  void let_go(std::unique_ptr<open_case::CaseOpening> closed);
  void take_dropped();
  // Markups that were moved in 3D Slicer: chosen among the folders, as dropped on Plan.
  void add_markups_action();
  void take_chosen_markups();
  void compare_chosen();  // images after the operation, in Review
  void close_start();
  void leave_shown();  // whatever is in front
  // The painting of the open case's bones.
  void show_paint();
  void close_paint();
  void reopen();  // the open case, whose bones or side are others now
  // Of the open case; what came of it. Throws InvalidInput where it may not change now, or cannot.
  std::vector<std::string> say_side(bones::Side side);
  void take_over_when_free();
  // What a crash cut off is offered as soon as it is found, in whatever mode the program opened.
  void offer_cut_off();
  void dispatch_keys();
  // The same while the list of keys covers everything: whatever is pressed closes it, and does nothing that
  // nobody sees.
  void dispatch_to_key_list();
  // What the ids of the actions that work now start with.
  [[nodiscard]] std::vector<std::string_view> action_prefixes() const;
  void show(std::size_t mode);
  void draw_screen(const widgets::Ui& ui);
  // "Live in Navigate" where pictures of now come that this screen does not show; else the program's name.
  [[nodiscard]] std::string name_or_live_mode() const;
  void draw_top_bar(const widgets::Ui& ui, const widgets::Rect& area);
  // The same in one place, of a mode that has the whole window.
  void draw_header(const widgets::Ui& ui, const widgets::Rect& area);
  void draw_status_bar(const widgets::Ui& ui, const widgets::Rect& area);
  void draw_fault(const widgets::Ui& ui) const;  // over whatever was drawn before it
  [[nodiscard]] open_case::PlanModel* model() const { return case_ != nullptr ? case_->model() : nullptr; }
  // A case of images alone is painted in, and no mode is of use there.
  [[nodiscard]] bool is_unpainted() const { return case_ != nullptr && case_->unpainted() != nullptr; }
  [[nodiscard]] bool shows_start() const { return shows_start_ || (model() == nullptr && !is_unpainted()); }
  [[nodiscard]] bool shows_paint() const { return !shows_start() && (shows_paint_ || is_unpainted()); }
  [[nodiscard]] bool should_end();  // the window was closed, and nothing runs that it would cut off
  // What the lower bar says of the case, and whether that is a warning.
  [[nodiscard]] std::pair<std::string, bool> status_words();
  [[nodiscard]] mode::Mode& shown() const { return *modes_[shown_]; }
  [[nodiscard]] bool modes_are_busy() const;    // in front or behind
  [[nodiscard]] bool has_running_work() const;  // likewise, and on the start
  [[nodiscard]] bool works_elsewhere() const;   // than on the start

  WorkstationOptions options_;
  Room room_;
  widgets::GraphicsWindow window_;
  worker::LettingGo letting_go_;  // of cases that were closed: they may still have landmarks in the making
  // The open case, and the one that is being opened in its place; null where there is none.
  std::unique_ptr<open_case::CaseOpening> case_, opening_;
  // The last case with bones, which the modes know until the next one with bones; null while that is case_.
  std::unique_ptr<open_case::CaseOpening> known_to_modes_;
  open_case::CaseOpening* lender_ = nullptr;  // one of these, whose lock opening_ has
  double looked_for_lock_s_ = 0;              // of a case that another program had
  std::string failure_;  // why the last one could not be opened, until something else is shown; else empty
  widgets::Actions actions_;
  widgets::WidgetLog log_;
  std::vector<std::unique_ptr<mode::Mode>> modes_;  // in the order of their buttons
  plan::PlanView* plan_ = nullptr;                  // two of them
  review::ReviewView* review_ = nullptr;
  std::size_t shown_ = 0;
  widgets::Heartbeat heartbeat_;
  widgets::SlowScreen slow_;
  DrawWatch watch_;
  FrameFault fault_;
  UntakenKey untaken_;
  screen_copy::ScreenCopies copies_;
  start::StartView start_;
  std::optional<start::AfterOperation> after_operation_;  // until its case is open
  paint::PaintView paint_;
  bool shows_keys_ = false, shows_start_ = false, shows_paint_ = false, reopens_ = false, quits_ = false;
  bool looks_for_cut_off_ = false;  // in the case that was opened last, until somebody chose a mode
};

}  // namespace arthronaut::window
