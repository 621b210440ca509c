#include "app/window/workstation_window.h"

#include <GLFW/glfw3.h>
#include <spdlog/spdlog.h>

#include <algorithm>

#include "app/navigate/navigate_view.h"
#include "app/plan/plan_view.h"
#include "app/review/review_view.h"
#include "app/setup/setup_view.h"
#include "app/widgets/hold_hint.h"
#include "app/widgets/source_banner.h"
#include "app/window/key_list.h"
#include "planning/geometry/error.h"

namespace arthronaut::window {

namespace {

using widgets::GraphicsWindow;

constexpr double kIdleWait_s = 0.2, kBusyWait_s = 0.05, kHeldWait_s = 0.02;
// After input ImGui needs a few frames until hovering, pressing and layout have settled.
constexpr int kFramesAfterInput = 4;
constexpr const char* kNotice = "Research software, not a medical device";

}  // namespace

WorkstationWindow::WorkstationWindow(const WorkstationOptions& options)
    : options_(options),
      window_("Arthronaut"),
      case_(options.case_folder, [] { GraphicsWindow::wake(); }),
      log_(options.list_widgets),
      watch_([](const std::string& what) { spdlog::warn(what); }, std::chrono::milliseconds(500)) {
  make_modes();
  add_actions();
}

void WorkstationWindow::make_modes() {
  const auto make_current = [this] { window_.make_current(); };
  const auto wake = [] { GraphicsWindow::wake(); };
  const sources::DeviceTurns camera_turns;  // Set up and Navigate open one camera after the other
  constexpr std::size_t kNavigate = 2;
  modes_.push_back(std::make_unique<plan::PlanView>(make_current));
  modes_.push_back(std::make_unique<setup::SetupView>(
      wake, [this] { show(kNavigate); }, camera_turns));
  modes_.push_back(std::make_unique<navigate::NavigateView>(make_current, wake, camera_turns));
  modes_.push_back(std::make_unique<review::ReviewView>(make_current, wake));
}

void WorkstationWindow::add_actions() {
  const auto is_open = [this] { return case_.model() != nullptr; };
  for (std::size_t i = 0; i < modes_.size(); ++i) {
    const mode::ModeTitle title = modes_[i]->title();
    actions_.add(
        {std::string(title.action), std::string(title.label), std::string(title.tooltip), title.key, 0, false,
         [this, is_open, i] { return is_open() && (!case_.is_read_only() || modes_[i]->works_read_only()); },
         [this, i] { return shown_ == i; }, [this, i] { show(i); }});
  }
  actions_.add({"app.keys",
                "Keys",
                "Every key of this mode",
                GLFW_KEY_F10,
                0,
                false,
                {},
                [this] { return shows_keys_; },
                [this] { shows_keys_ = !shows_keys_; }});
  actions_.add({"app.quit",
                "Quit",
                "Everything is saved",
                GLFW_KEY_Q,
                GLFW_MOD_CONTROL,
                false,
                {},
                {},
                [this] { quits_ = true; },
                {"quit", [this] { return has_running_work(); }}});
  for (const auto& mode : modes_) mode->add_actions(actions_);
}

void WorkstationWindow::run() {
  int settle = 30;  // frames to draw without waiting
  for (long count = 0; !quits_ && !should_end() && (options_.frames == 0 || count < options_.frames);
       ++count) {
    const double timeout = settle > 0                            ? 0
                           : actions_.is_held()                  ? kHeldWait_s
                           : modes_are_busy() || case_.is_busy() ? kBusyWait_s
                                                                 : kIdleWait_s;
    const double started = GraphicsWindow::now_s();
    frame(timeout);
    const bool woken = timeout > 0 && GraphicsWindow::now_s() - started < timeout;
    settle = woken && !modes_are_busy() ? kFramesAfterInput : std::max(settle - 1, 0);
  }
  shown().leave();
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

bool WorkstationWindow::has_running_work() const {
  return std::any_of(modes_.begin(), modes_.end(), [](const auto& mode) { return mode->has_running_work(); });
}

// poll -> queues and actions -> UI (with the scenes that are dirty) -> draw -> swap
void WorkstationWindow::frame(double timeout_s) {
  window_.begin_frame(timeout_s);
  take_opened_case();
  dispatch_keys();
  for (const auto& mode : modes_) mode->tick(GraphicsWindow::now_s());
  const widgets::Ui ui{window_.theme(), actions_, log_, GraphicsWindow::now_s()};
  heartbeat_.beat(ui.now_s, has_running_work());
  watch_.frame_drawn(has_running_work());
  draw_screen(ui);
  actions_.advance(ui.now_s);  // after the buttons: what was let go in this frame is known
  window_.end_frame();
  log_.end_frame();
}

void WorkstationWindow::take_opened_case() {
  if (!case_.take()) return;
  for (const auto& mode : modes_)
    mode->case_opened({case_.model(), case_.folder(), case_.read_only_reason()});
  shown().enter();
}

void WorkstationWindow::dispatch_keys() {
  for (const int key : window_.released_keys()) actions_.release(key);
  for (const widgets::KeyPress& press : window_.keys()) {
    if (shows_keys_ && press.key == GLFW_KEY_ESCAPE) {
      shows_keys_ = false;
      continue;
    }
    actions_.press(press, action_prefixes());
    // What is typed after the key that opens a text field is meant for the field.
    if (shown().awaits_text()) window_.await_text_field();
  }
  if (ImGui::GetIO().WantTextInput) actions_.let_go();
}

std::vector<std::string_view> WorkstationWindow::action_prefixes() const {
  std::vector<std::string_view> prefixes{"app.", "mode."};
  for (const std::string_view prefix : shown().action_prefixes()) prefixes.push_back(prefix);
  return prefixes;
}

void WorkstationWindow::show(std::size_t mode) {
  actions_.let_go();
  if (mode != shown_) shown().leave();
  shown_ = mode;
  shown().enter();
}

void WorkstationWindow::draw_screen(const widgets::Ui& ui) {
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos({0, 0});
  ImGui::SetNextWindowSize(size);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, 0);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0, 0});
  ImGui::Begin("workstation", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                   ImGuiWindowFlags_NoBringToFrontOnFocus | ImGuiWindowFlags_NoScrollWithMouse);
  ImGui::PopStyleVar(2);
  ImGui::PushFont(ui.theme.body);
  widgets::Rect area{0, 0, size.x, size.y};
  draw_top_bar(ui, area.cut_top(ui.theme.px(72)));
  draw_status_bar(ui, area.cut_bottom(ui.theme.px(40)));
  widgets::Rect inner = area.inset(ui.theme.px(12));
  if (case_.model() == nullptr)
    draw_waiting(ui, inner);
  else
    shown().draw(ui, inner);
  if (shows_keys_) draw_key_list(ui, action_prefixes());
  const auto kind = shown().source_kind();
  if (kind) widgets::draw_source_frame(ui, {0, 0, size.x, size.y}, *kind);
  widgets::draw_hold_hint(ui, {0, 0, size.x, size.y});
  ImGui::PopFont();
  ImGui::End();
  if (!kind) log_.note_state("source_kind", "none");
  log_.note_state("standstill", heartbeat_.words());
  log_.note_state("mode", shown().title().name);
  log_.note_state("access", case_.is_read_only() ? "read-only" : "own");
  log_.note_state("case", case_.model() != nullptr ? "open" : case_.failure().empty() ? "opening" : "failed");
}

void WorkstationWindow::draw_top_bar(const widgets::Ui& ui, const widgets::Rect& area) {
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  draw.AddRectFilled(area.min(), area.max(), widgets::kPanel);
  draw.AddLine({area.x, area.y + area.height}, area.max(), widgets::kPanelEdge);
  const float middle = area.y + area.height / 2;
  const ImFont* title = ui.theme.title;
  const float width = ui.theme.px(172), height = ui.theme.px(50);
  const widgets::Rect heart{area.x + ui.theme.px(14), middle - height / 2, height, height};
  widgets::draw_heartbeat(ui, heart, heartbeat_);
  // The same place in all modes: where the pictures come from, or else whose screen this is.
  const widgets::Rect name{heart.x + heart.width + ui.theme.px(10), middle - ui.theme.px(29),
                           ui.theme.px(330), ui.theme.px(58)};
  if (const auto kind = shown().source_kind())
    widgets::draw_source_word(ui, name, *kind);
  else
    draw.AddText(title, title->FontSize, {name.x, middle - title->FontSize / 2}, widgets::kText,
                 "Arthronaut");
  float x = name.x + name.width + ui.theme.px(12);
  for (const auto& mode : modes_) {
    ImGui::SetCursorScreenPos({x, middle - height / 2});
    widgets::action_button(ui, mode->title().action, width, height);
    x += width + ui.theme.px(10);
  }
  if (case_.model() != nullptr) {
    const cases::Case& knee = case_.model()->knee();
    const std::string text = knee.name + "  \u2013  " + std::string(bones::to_text(knee.side)) + " knee";
    // Whose knee it is stands over the name of the case.
    const std::string patient = case_.identity() ? case_.identity()->in_words() : "";
    const float right = area.x + area.width - ui.theme.px(360);
    const auto line = [&](const ImFont* font, float y, ImU32 color, const std::string& words) {
      const float wide = font->CalcTextSizeA(font->FontSize, 1e9F, 0, words.c_str()).x;
      draw.AddText(font, font->FontSize, {right - wide, y}, color, words.c_str());
    };
    const float row = ui.theme.strong->FontSize;
    if (!patient.empty()) line(ui.theme.strong, middle - row, widgets::kText, patient);
    line(ui.theme.strong, patient.empty() ? middle - row / 2 : middle,
         patient.empty() ? widgets::kText : widgets::kQuietText, text);
  }
  const float small = ui.theme.px(156);
  ImGui::SetCursorScreenPos({area.x + area.width - 2 * small - ui.theme.px(22), middle - height / 2});
  widgets::action_button(ui, "app.keys", small, height);
  ImGui::SetCursorScreenPos({area.x + area.width - small - ui.theme.px(12), middle - height / 2});
  widgets::action_button(ui, "app.quit", small, height);
}

void WorkstationWindow::draw_status_bar(const widgets::Ui& ui, const widgets::Rect& area) {
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  draw.AddRectFilled(area.min(), area.max(), widgets::kPanel);
  const ImFont* font = ui.theme.body;
  const float y = area.y + (area.height - font->FontSize) / 2;
  draw.AddText(font, font->FontSize, {area.x + ui.theme.px(20), y}, widgets::kQuietText, kNotice);
  const std::string standstill = heartbeat_.words();
  const std::string notice = !case_.failure().empty() ? case_.failure()
                             : !standstill.empty()    ? standstill
                                                      : shown().notice();
  const std::string access =
      case_.is_read_only() ? "READ-ONLY: the case " + case_.read_only_reason() : case_.notice();
  const std::string text = !notice.empty()            ? notice
                           : !access.empty()          ? access
                           : case_.model() != nullptr ? case_.folder().string()
                                                      : std::string();
  const float wide = font->CalcTextSizeA(font->FontSize, 1e9F, 0, text.c_str()).x;
  draw.AddText(font, font->FontSize, {area.x + area.width - wide - ui.theme.px(20), y},
               notice.empty() && access.empty() ? widgets::kQuietText : widgets::kCaution, text.c_str());
}

void WorkstationWindow::draw_waiting(const widgets::Ui& ui, const widgets::Rect& area) {
  widgets::text_centered(
      ui, area, ui.theme.title, case_.failure().empty() ? widgets::kText : widgets::kBad,
      case_.failure().empty() ? "Opening the case" : "The case cannot be opened: " + case_.failure());
}

}  // namespace arthronaut::window
