#include "app/window/workstation_window.h"

#include <GLFW/glfw3.h>

#include <algorithm>

#include "app/window/key_list.h"
#include "planning/geometry/error.h"

namespace arthronaut::window {

namespace {

using widgets::GraphicsWindow;

constexpr double kIdleWait_s = 0.2, kBusyWait_s = 0.05;
// After input ImGui needs a few frames until hovering, pressing and layout have settled.
constexpr int kFramesAfterInput = 4;
constexpr const char* kNotice = "Research software, not a medical device";

const char* name_of(Mode mode) {
  switch (mode) {
    case Mode::Plan:
      return "plan";
    case Mode::SetUp:
      return "set up";
    case Mode::Navigate:
      return "navigate";
    case Mode::Review:
      return "review";
  }
  return "";
}

}  // namespace

WorkstationWindow::WorkstationWindow(const WorkstationOptions& options)
    : options_(options),
      window_("Arthronaut"),
      case_(options.case_folder, [] { GraphicsWindow::wake(); }),
      log_(options.list_widgets),
      planning_([this] { window_.make_current(); },
                [this](const open_case::PlanEdit& edit) { history_.apply(edit, GraphicsWindow::now_s()); }),
      setup_([] { GraphicsWindow::wake(); }, [this] { go_to(Mode::Navigate); }, camera_turns_),
      navigate_([this] { window_.make_current(); }, [] { GraphicsWindow::wake(); }, camera_turns_),
      review_([this] { window_.make_current(); }, [] { GraphicsWindow::wake(); }) {
  add_actions();
}

void WorkstationWindow::add_actions() {
  const auto is_open = [this] { return case_.model() != nullptr; };
  const auto mode_action = [&](const char* id, const char* label, const char* tooltip, int key, Mode mode) {
    actions_.add({id, label, tooltip, key, 0, false, is_open, [this, mode] { return mode_ == mode; },
                  [this, mode] { go_to(mode); }});
  };
  mode_action("mode.plan", "Plan", "Place the tunnels", GLFW_KEY_F1, Mode::Plan);
  // F4 although it stands second: F2 and F3 are in the users' fingers.
  mode_action("mode.setup", "Set up", "Camera, tools and fluid, before the operation", GLFW_KEY_F4,
              Mode::SetUp);
  mode_action("mode.navigate", "Navigate", "In theatre", GLFW_KEY_F2, Mode::Navigate);
  mode_action("mode.review", "Review", "What happened", GLFW_KEY_F3, Mode::Review);
  actions_.add({"app.keys",
                "Keys",
                "Every key of this mode",
                GLFW_KEY_F10,
                0,
                false,
                {},
                [this] { return shows_keys_; },
                [this] { shows_keys_ = !shows_keys_; }});
  actions_.add(
      {"app.quit", "Quit", "Everything is saved", GLFW_KEY_Q, GLFW_MOD_CONTROL, false, {}, {}, [this] {
         quits_ = true;
       }});
  actions_.add({"plan.undo",
                "Undo",
                "Takes the last change of the plan back",
                GLFW_KEY_Z,
                GLFW_MOD_CONTROL,
                true,
                [this] { return history_.can_undo(); },
                {},
                [this] { history_.undo(); }});
  actions_.add({"plan.redo",
                "Redo",
                "Does it again",
                GLFW_KEY_Y,
                GLFW_MOD_CONTROL,
                true,
                [this] { return history_.can_redo(); },
                {},
                [this] { history_.redo(); }});
  planning_.add_actions(actions_, [this]() -> const open_case::PlanModel* { return case_.model(); });
  setup_.add_actions(actions_);
  navigate_.add_actions(actions_);
  review_.add_actions(actions_);
}

void WorkstationWindow::run() {
  int settle = 30;  // frames to draw without waiting
  for (long count = 0;
       !quits_ && !window_.should_close() && (options_.frames == 0 || count < options_.frames); ++count) {
    const double timeout = settle > 0 ? 0 : is_busy() ? kBusyWait_s : kIdleWait_s;
    const double started = GraphicsWindow::now_s();
    frame(timeout);
    const bool woken = timeout > 0 && GraphicsWindow::now_s() - started < timeout;
    settle = woken && !pictures_come() ? kFramesAfterInput : std::max(settle - 1, 0);
  }
  history_.settle_now();
}

// What a station of Set up last knew of its run is of when it was last drawn.
bool WorkstationWindow::pictures_come() const {
  return (mode_ == Mode::SetUp && setup_.is_busy()) || navigate_.is_busy();
}

bool WorkstationWindow::is_busy() const {
  return case_.is_busy() || pictures_come() || review_.is_busy() || history_.is_moving();
}

// poll -> queues and actions -> UI (with the scenes that are dirty) -> draw -> swap
void WorkstationWindow::frame(double timeout_s) {
  window_.begin_frame(timeout_s);
  take_opened_case();
  dispatch_keys();
  history_.settle(GraphicsWindow::now_s());
  const widgets::Ui ui{window_.theme(), actions_, log_, GraphicsWindow::now_s()};
  draw_screen(ui);
  window_.end_frame();
  log_.end_frame();
}

void WorkstationWindow::take_opened_case() {
  if (!case_.take()) return;
  history_.open(case_.model(), case_.folder());
  planning_.reset(*case_.model());
  setup_.open(case_.folder());
  navigate_.open(case_.model(), case_.folder());
  review_.open(case_.model(), case_.folder());
}

void WorkstationWindow::dispatch_keys() {
  for (const widgets::KeyPress& press : window_.keys()) {
    if (shows_keys_ && press.key == GLFW_KEY_ESCAPE) {
      shows_keys_ = false;
      continue;
    }
    actions_.press(press, action_prefixes());
    // What is typed after the key that opens a text field is meant for the field.
    if (mode_ == Mode::SetUp && setup_.awaits_text()) window_.await_text_field();
  }
}

std::vector<std::string_view> WorkstationWindow::action_prefixes() const {
  std::vector<std::string_view> prefixes{"app.", "mode."};
  switch (mode_) {
    case Mode::Plan:
      prefixes.push_back("plan.");
      break;
    case Mode::SetUp:
      for (const std::string_view prefix : setup_.action_prefixes()) prefixes.push_back(prefix);
      break;
    case Mode::Navigate:
      prefixes.push_back("navigate.");
      break;
    case Mode::Review:
      prefixes.push_back("review.");
      break;
  }
  return prefixes;
}

void WorkstationWindow::go_to(Mode mode) {
  if (mode_ == Mode::SetUp && mode != Mode::SetUp) setup_.leave();
  mode_ = mode;
  if (mode == Mode::SetUp) setup_.enter();
  if (mode == Mode::Navigate) navigate_.enter();
  if (mode == Mode::Review) review_.refresh();
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
  else if (mode_ == Mode::Plan)
    planning_.draw(ui, inner, *case_.model(), history_.status());
  else if (mode_ == Mode::SetUp)
    setup_.draw(ui, inner);
  else if (mode_ == Mode::Navigate)
    navigate_.draw(ui, inner);
  else
    review_.draw(ui, inner);
  if (shows_keys_) draw_key_list(ui, action_prefixes());
  ImGui::PopFont();
  ImGui::End();
  log_.note_state("mode", name_of(mode_));
  log_.note_state("case", case_.model() != nullptr ? "open" : case_.failure().empty() ? "opening" : "failed");
}

void WorkstationWindow::draw_top_bar(const widgets::Ui& ui, const widgets::Rect& area) {
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  draw.AddRectFilled(area.min(), area.max(), widgets::kPanel);
  draw.AddLine({area.x, area.y + area.height}, area.max(), widgets::kPanelEdge);
  const float middle = area.y + area.height / 2;
  const ImFont* title = ui.theme.title;
  draw.AddText(title, title->FontSize, {area.x + ui.theme.px(20), middle - title->FontSize / 2},
               widgets::kText, "Arthronaut");
  const float width = ui.theme.px(190), height = ui.theme.px(50);
  float x = area.x + ui.theme.px(230);
  for (const char* id : {"mode.plan", "mode.setup", "mode.navigate", "mode.review"}) {
    ImGui::SetCursorScreenPos({x, middle - height / 2});
    widgets::action_button(ui, id, width, height);
    x += width + ui.theme.px(10);
  }
  if (case_.model() != nullptr) {
    const cases::Case& knee = case_.model()->knee();
    const std::string text = knee.name + "  \u2013  " + std::string(bones::to_text(knee.side)) + " knee";
    const float wide = ui.theme.strong->CalcTextSizeA(ui.theme.strong->FontSize, 1e9F, 0, text.c_str()).x;
    draw.AddText(ui.theme.strong, ui.theme.strong->FontSize,
                 {area.x + area.width - wide - ui.theme.px(360), middle - ui.theme.strong->FontSize / 2},
                 widgets::kText, text.c_str());
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
  const std::string notice = !case_.failure().empty()  ? case_.failure()
                             : mode_ == Mode::Navigate ? navigate_.notice()
                             : mode_ == Mode::Review   ? review_.notice()
                                                       : std::string();
  const std::string text = !notice.empty()            ? notice
                           : case_.model() != nullptr ? case_.folder().string()
                                                      : std::string();
  const float wide = font->CalcTextSizeA(font->FontSize, 1e9F, 0, text.c_str()).x;
  draw.AddText(font, font->FontSize, {area.x + area.width - wide - ui.theme.px(20), y},
               notice.empty() ? widgets::kQuietText : widgets::kCaution, text.c_str());
}

void WorkstationWindow::draw_waiting(const widgets::Ui& ui, const widgets::Rect& area) {
  widgets::text_centered(
      ui, area, ui.theme.title, case_.failure().empty() ? widgets::kText : widgets::kBad,
      case_.failure().empty() ? "Opening the case" : "The case cannot be opened: " + case_.failure());
}

}  // namespace arthronaut::window
