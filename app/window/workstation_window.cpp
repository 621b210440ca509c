#include "app/window/workstation_window.h"

#include <GLFW/glfw3.h>
#include <imgui_internal.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "app/plan/plan_view.h"
#include "app/review/review_view.h"
#include "app/widgets/hold_hint.h"
#include "app/widgets/key_clashes.h"
#include "app/widgets/source_banner.h"
#include "app/window/key_list.h"

namespace arthronaut::window {

namespace {

using widgets::GraphicsWindow;

constexpr double kIdleWait_s = 0.2, kBusyWait_s = 0.05, kHeldWait_s = 0.02,
                 kCopiedWait_s = 0.5 / screen_copy::ScreenCopies::kRate;
// After input ImGui needs a few frames until hovering, pressing and layout have settled.
constexpr int kFramesAfterInput = 4;

}  // namespace

WorkstationWindow::WorkstationWindow(const WorkstationOptions& options)
    : options_(options),
      window_("Arthronaut", room_.screen_diagonal_mm()),
      log_(options.list_widgets),
      watch_([](const std::string& what) { spdlog::warn(what); }, std::chrono::milliseconds(500)),
      copies_(room_.screen_stream(), [] { GraphicsWindow::wake(); }),
      start_([this](const std::filesystem::path& folder) { open(folder); }, [] { GraphicsWindow::wake(); },
             [this] { window_.make_current(); }),
      paint_({.make_current = [this] { window_.make_current(); },
              .wake = [] { GraphicsWindow::wake(); },
              .leave = [this] { close_paint(); },
              .bones_made = [this] { reopens_ = true; }}) {
  make_modes();
  add_actions();
  room_.listen([] { GraphicsWindow::wake_by_hand(); });
  start_.enter({});
  if (options.built_in)
    open({});
  else if (!options.case_folder.empty())
    start_.take(options.case_folder);
}

void WorkstationWindow::run() {
  int settle = 30;  // frames to draw without waiting
  for (long count = 0; !quits_ && !should_end() && (options_.frames == 0 || count < options_.frames);
       ++count) {
    const double timeout = settle > 0           ? 0
                           : actions_.is_held() ? kHeldWait_s
                           : copies_.is_busy()  ? kCopiedWait_s
                           : modes_are_busy() || start_.is_busy() || paint_.is_busy() || opening_ != nullptr
                               ? kBusyWait_s
                               : kIdleWait_s;
    const bool woken = frame(timeout);
    settle = woken && !modes_are_busy() ? kFramesAfterInput : std::max(settle - 1, 0);
  }
  shown().leave();
  start_.leave();
  paint_.leave();
  // What still runs is asked to end and waited for, which nobody needs to look at.
  window_.make_current();
  glfwHideWindow(glfwGetCurrentContext());
}

bool WorkstationWindow::should_end() {
  if (!window_.should_close()) return false;
  if (!has_running_work()) return true;
  window_.keep_open();
  actions_.remind("app.quit");
  return false;
}

bool WorkstationWindow::modes_are_busy() const {
  return std::any_of(modes_.begin(), modes_.end(), [](const auto& mode) { return mode->is_busy(); });
}

bool WorkstationWindow::has_running_work() const { return start_.has_running_work() || works_elsewhere(); }

bool WorkstationWindow::works_elsewhere() const {
  return paint_.has_running_work() ||
         std::any_of(modes_.begin(), modes_.end(), [](const auto& mode) { return mode->has_running_work(); });
}

// poll -> queues and actions -> UI (with the scenes that are dirty) -> draw -> swap
bool WorkstationWindow::frame(double timeout_s) {
  const bool woken = window_.begin_frame(timeout_s);
  const double begun_s = GraphicsWindow::now_s();
  {
    const widgets::WidgetLog::Timed timed(log_, "work_ms");
    work();
  }
  const widgets::Ui ui{window_.theme(), actions_, log_, GraphicsWindow::now_s(),
                       window_.draws_by_processor()};
  heartbeat_.beat(ui.now_s, has_running_work());
  watch_.frame_drawn(has_running_work());
  try {
    const widgets::WidgetLog::Timed timed(log_, "build_ms");
    draw_screen(ui);
  } catch (const std::runtime_error& error) {
    fault_.note(error.what(), ui.now_s);
    // Ends what was begun, but for fonts, over which it would end the program.
    while (ImGui::GetCurrentContext()->FontStack.Size > 0) ImGui::PopFont();
    ImGui::ErrorCheckEndFrameRecover(nullptr);
    draw_fault(ui);
  }
  guarded([&] { actions_.advance(ui.now_s); });  // after the buttons: what was let go in this frame is known
  end_frame(ui.now_s);
  const double took_s = GraphicsWindow::now_s() - begun_s;
  slow_.drawn(took_s, !shows_start() && !shows_paint() && shown().has_running_work());
  log_.add("frame_ms", 1000 * took_s);
  log_.end_frame();
  return woken;
}

bool WorkstationWindow::guarded(const std::function<void()>& part) {
  try {
    part();
    return true;
  } catch (const std::runtime_error& error) {
    fault_.note(error.what(), GraphicsWindow::now_s());
    return false;
  }
}

void WorkstationWindow::work() {
  // First, and whatever fails: what a held key does is not done by a hand that has let go.
  for (const int key : window_.released_keys()) {
    actions_.release(key);
    actions_.release(room_.meaning_of(key));
  }
  guarded([this] {
    take_dropped();
    start_.tick();
    take_opened_case();
    take_over_when_free();
  });
  guarded([this] {
    dispatch_keys();
    if (shows_start_ && start_.wants_to_close()) close_start();
    take_chosen_markups();
    compare_chosen();
  });
  if (!shows_start() && !shows_paint()) guarded([this] { shown().cover(shows_keys_); });
  for (const auto& mode : modes_) guarded([&] { mode->tick(GraphicsWindow::now_s()); });
  guarded([this] { offer_cut_off(); });
  guarded([this] {
    paint_.tick(GraphicsWindow::now_s());
    if (std::exchange(reopens_, false)) reopen();
  });
}

void WorkstationWindow::leave_shown() {
  if (shows_start()) return;
  if (shows_paint())
    paint_.leave();
  else
    shown().leave();
}

void WorkstationWindow::show_paint() {
  if (model() == nullptr) return;
  shown().leave();
  shows_paint_ = true;
  paint_.open(model()->knee(), case_->folder(), case_->is_read_only());
}

void WorkstationWindow::close_paint() {
  paint_.leave();
  shows_paint_ = false;
  if (model() != nullptr) return shown().enter();
  shows_start_ = true;  // nothing else can be done with a case without bones
  start_.enter(case_->folder());
}

void WorkstationWindow::dispatch_to_key_list() {
  room_.drop_pedals(actions_, [this] { shows_keys_ = false; });
  for (const widgets::KeyPress& press : window_.keys()) {
    log_.add("keys", 1);
    // F10 itself closes it, and quitting is quitting.
    if (actions_.press(press, {"app."}) || press.is_repeat) continue;
    if (!widgets::key_name(press.key, press.mods).empty()) shows_keys_ = false;
  }
}

void WorkstationWindow::dispatch_keys() {
  if (shows_keys_) return dispatch_to_key_list();
  // Elsewhere than in theatre and in Set up a key means what it is called.
  const auto prefixes = action_prefixes();
  const bool has_pedals = std::find(prefixes.begin(), prefixes.end(), "navigate.") != prefixes.end() ||
                          std::find(prefixes.begin(), prefixes.end(), "setup.next") != prefixes.end();
  // In theatre what a pedal cannot do is said beside the step; of the window's own keys nothing is said
  // there.
  const auto is_of_window = [this](const widgets::KeyPress& press) {
    return std::ranges::any_of(actions_.all(), [&](const widgets::Action& action) {
      return action.key == press.key && action.mods == press.mods &&
             (action.id.starts_with("app.") || action.id.starts_with("mode."));
    });
  };
  room_.press_pedals(actions_, action_prefixes(), ImGui::GetIO().WantTextInput);
  for (widgets::KeyPress press : window_.keys()) {
    log_.add("keys", 1);
    if (has_pedals && press.mods == 0) press.key = room_.meaning_of(press.key);
    if (actions_.press(press, action_prefixes()))
      untaken_.forget();
    else if (!has_pedals || opening_ != nullptr || is_of_window(press))
      untaken_.note(press, actions_, action_prefixes(), opening_ != nullptr, GraphicsWindow::now_s());
    // What is typed after the key that opens a text field is meant for the field.
    const bool awaits_text = shows_start()   ? start_.awaits_text()
                             : shows_paint() ? false
                                             : shown().awaits_text();
    if (awaits_text) window_.await_text_field();
  }
  untaken_.look_again(actions_, opening_ != nullptr, GraphicsWindow::now_s());
  if (ImGui::GetIO().WantTextInput) actions_.let_go();
}

std::vector<std::string_view> WorkstationWindow::action_prefixes() const {
  std::vector<std::string_view> prefixes{"app.", "mode."};
  if (shows_start()) {
    if (opening_ == nullptr) prefixes.push_back("start.");
    return prefixes;
  }
  if (shows_paint()) {
    if (opening_ == nullptr) prefixes.push_back("paint.");
    return prefixes;
  }
  for (const std::string_view prefix : shown().action_prefixes()) prefixes.push_back(prefix);
  return prefixes;
}

void WorkstationWindow::show(std::size_t mode) {
  looks_for_cut_off_ = false;
  actions_.let_go();
  start_.leave();
  shows_start_ = false;
  failure_.clear();
  if (std::exchange(shows_paint_, false)) paint_.leave();
  if (mode != shown_) shown().leave();
  shown_ = mode;
  shown().enter();
}

void WorkstationWindow::close_start() {
  if (!std::exchange(shows_start_, false)) return;
  failure_.clear();
  start_.leave();
  if (!shows_paint()) shown().enter();
}

void WorkstationWindow::draw_screen(const widgets::Ui& ui) {
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos({0, 0});
  ImGui::SetNextWindowSize(size);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, 0);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0, 0});
  // No background: the frame was cleared to its colour, and to blend all of it once more costs milliseconds
  // where the processor draws.
  ImGui::Begin("workstation", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoBackground | ImGuiWindowFlags_NoMove |
                   ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoBringToFrontOnFocus |
                   ImGuiWindowFlags_NoScrollWithMouse);
  ImGui::PopStyleVar(2);
  ImGui::PushFont(ui.theme.body);
  widgets::Rect area{0, 0, size.x, size.y};
  const bool shows_mode = opening_ == nullptr && !shows_start() && !shows_paint();
  const widgets::Rect whole = area.inset(ui.theme.px(12));
  const auto header = shows_mode ? shown().header_in(ui, whole) : std::nullopt;
  if (!header) {
    draw_top_bar(ui, area.cut_top(ui.theme.px(72)));
    draw_status_bar(ui, area.cut_bottom(ui.theme.px(40)));
  }
  widgets::Rect inner = area.inset(ui.theme.px(12));
  if (!failure_.empty() && shows_start()) {
    const widgets::Rect line = inner.cut_top(ui.theme.px(44));
    ImGui::SetCursorScreenPos(line.min());
    widgets::status_row(ui, widgets::Severity::Bad, "Not opened", failure_);
  }
  if (opening_ != nullptr)
    draw_opening(ui, inner);
  else if (shows_start())
    start_.draw(ui, inner);
  else if (shows_paint())
    paint_.draw(ui, inner);
  else {
    shown().draw(ui, inner);
    if (header) draw_header(ui, *header);
  }
  if (shows_keys_) {
    const auto held = shows_start() || shows_paint() ? std::vector<mode::HeldKeys>() : shown().held_keys();
    if (draw_key_list(ui, key_rows(actions_, action_prefixes(), held))) shows_keys_ = false;
  }
  const auto kind = shows_start() || shows_paint() ? std::nullopt : shown().source_kind();
  if (kind) widgets::draw_source_frame(ui, {0, 0, size.x, size.y}, *kind, shown().pictures_are_of_now());
  widgets::draw_hold_hint(ui, {0, 0, size.x, size.y}, header);
  ImGui::PopFont();
  ImGui::End();
  if (!kind) log_.note_state("source_kind", "none");
  log_.note_state("key_list", shows_keys_ ? "shown" : "none");
  log_.note_state("room", room_.trouble());
  log_.note_state("foot_switch", room_.devices());
  log_.note_state("standstill", heartbeat_.words());
  log_.note_state("slow_screen", slow_.words());
  log_.note_state("screen_copy", copies_.words(ui.now_s));
  log_.note_state("untaken_key", untaken_.words(ui.now_s));
  log_.note_state("frame_fault", fault_.words(ui.now_s));
  log_.note_state("mode", shown().title().name);
  if (options_.list_widgets)
    for (const std::string& clash : widgets::key_clashes(actions_, action_prefixes()))
      log_.note_state("key_clash", clash);
  log_.note_state("access", case_ != nullptr && case_->is_read_only() ? "read-only" : "own");
  log_.note_state("folder", case_ != nullptr ? case_->folder().string() : "");
  log_.note_state("screen", shows_start() ? "start" : shows_paint() ? "paint" : "mode");
  log_.note_state("case", opening_ != nullptr ? "opening"
                          : !failure_.empty() ? "failed"
                          : case_ != nullptr  ? "open"
                                              : "none");
}

}  // namespace arthronaut::window
