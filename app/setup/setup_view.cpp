#include "app/setup/setup_view.h"

#include <GLFW/glfw3.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <utility>

#include "app/setup/calibrate_station.h"
#include "app/setup/fluid_station.h"
#include "app/setup/tool_station.h"
#include "navigation/sources/camera_modes.h"
#include "planning/geometry/error.h"

namespace arthronaut::setup {

SetupView::SetupView(const std::function<void()>& wake, std::function<void()> go_on,
                     const sources::DeviceTurns& turns, Streams streams)
    : go_on_(std::move(go_on)), turns_(turns), streams_(std::move(streams)) {
  steps_.push_back({Purpose::Camera, "setup.show_camera", "setup.camera.",
                    std::make_unique<CalibrateStation>(wake, ending_)});
  steps_.push_back(
      {Purpose::Tools, "setup.show_tools", "setup.tools.", std::make_unique<ToolStation>(wake, ending_)});
  steps_.push_back(
      {Purpose::Fluid, "setup.show_fluid", "setup.fluid.", std::make_unique<FluidStation>(wake, ending_)});
}

SetupView::~SetupView() = default;

mode::ModeTitle SetupView::title() const {
  // F4 although it stands second: F2 and F3 are in the users' fingers.
  return {"set up", "mode.setup", "Set up", "Camera, tools and fluid, before the operation", GLFW_KEY_F4};
}

void SetupView::case_opened(const mode::OpenCase& opened) {
  close_gallery();
  case_folder_ = opened.folder;
  typed_ = {};
  is_read_ = false;
  for (Step& one : steps_) {
    one.station->stop();
    one.source = {};
  }
  shown_ = 0;
}

void SetupView::enter() {
  is_shown_ = true;
  if (!is_read_)
    for (Step& one : steps_) one.station->open(case_folder_);
  is_read_ = true;
  find_sources();
}

void SetupView::leave() {
  is_shown_ = false;
  close_gallery();
  for (Step& one : steps_) one.station->release_source();
}

bool SetupView::awaits_text() const { return typed_.wants_focus || step().station->awaits_text(); }

// What a station last knew of its run is of when it was last drawn.
bool SetupView::is_busy() const { return is_shown_ && (shows_gallery_ || step().station->is_busy()); }

bool SetupView::has_running_work() const {
  return std::any_of(steps_.begin(), steps_.end(), [](const Step& one) { return one.station->has_run(); });
}

std::optional<sources::SourceKind> SetupView::source_kind() const {
  if (!step().station->has_run()) return std::nullopt;
  return step().started_kind;
}

void SetupView::show(std::size_t index) {
  close_gallery();
  if (index != shown_) step().station->release_source();
  shown_ = index;
  for (Step& one : steps_) one.station->show();
  find_sources();
}

void SetupView::find_sources() {
  std::vector<std::filesystem::path> named = typed_.paths;
  for (const std::string& address : streams_.known())
    if (std::find(named.begin(), named.end(), address) == named.end()) named.emplace_back(address);
  step().source.offer(sources_for(step().purpose, case_folder_, turns_, named));
}

void SetupView::choose_source() {
  step().station->stop();
  find_sources();
  step().source.choose_next();
}

void SetupView::start() {
  close_gallery();
  const FeedSource* source = step().source.chosen();
  if (source == nullptr) return;
  step().started_kind = source->is_simulated ? sources::SourceKind::Simulation
                        : source->is_live    ? sources::SourceKind::Live
                                             : sources::SourceKind::Recording;
  step().unproved_stream =
      sources::is_stream_address(source->path.string()) ? source->path.string() : std::string();
  step().station->start(*source);
}

// A mistyped address would push one that works out of the five that are kept.
void SetupView::note_stream() {
  if (step().unproved_stream.empty() || !step().station->gives_pictures()) return;
  streams_.note(std::exchange(step().unproved_stream, {}));
}

void SetupView::take_next_step() {
  if (!step().station->has_run()) return start();
  const Then then = step().station->take_next_step();
  if (then == Then::StartAgain) return start();
  if (then == Then::Stay) return;
  if (shown_ + 1 < steps_.size()) return show(shown_ + 1);
  go_on_();
}

std::string SetupView::next_step() const {
  if (step().station->has_run()) return step().station->next_step();
  const FeedSource* source = step().source.chosen();
  return source != nullptr ? "start " + source->name : "choose another source (O), or type one (P)";
}

// A path that was typed becomes the chosen source; one that leads nowhere is an error that stays until
// another source is chosen.
void SetupView::take_typed_path() {
  typed_.is_open = false;
  close_gallery();
  typed_.text = sources::with_small_scheme(typed_.text);
  std::filesystem::path path = typed_.text;
  const bool is_stream = sources::is_stream_address(typed_.text);
  if (!is_stream && !path.has_filename()) path = path.parent_path();  // "pictures/"
  if (const std::string why = is_stream ? sources::why_no_stream(typed_.text) : ""; !why.empty())
    return step().source.refuse(sources::shown_address(typed_.text) + ": " + why);
  step().station->stop();
  if (sources::is_camera_address(typed_.text)) {
    try {
      (void)sources::read_camera_address(typed_.text);
    } catch (const InvalidInput& refused) {  // what was typed is answered where sources are chosen
      return step().source.refuse(refused.what());
    }
  }
  typed_.paths.push_back(path);
  find_sources();
  if (!step().source.choose_path(path)) typed_.paths.pop_back();
}

void SetupView::add_actions(widgets::Actions& actions) {
  const auto show_action = [&](std::size_t index, const char* label, const char* tooltip, int key) {
    actions.add({steps_.at(index).action,
                 label,
                 tooltip,
                 key,
                 0,
                 false,
                 {},
                 [this, index] { return shown_ == index; },
                 [this, index] { show(index); }});
  };
  show_action(0, "Camera", "Pictures of a checkerboard become camera.json", GLFW_KEY_1);
  show_action(1, "Tools", "The probe's tip and the guides' axes, into tools.json", GLFW_KEY_2);
  show_action(2, "Fluid check", "Whether the camera measures rightly in the fluid", GLFW_KEY_3);
  const auto add = [&](const char* id, const char* label, const char* tooltip, int key,
                       const std::function<void()>& run, const widgets::Hold& hold = {}) {
    actions.add({id, label, tooltip, key, 0, false, {}, {}, run, hold});
  };
  const auto has_run = [this] { return step().station->has_run(); };
  add("setup.next", "Next step", "Starts, takes, calibrates, adopts: whatever comes next", GLFW_KEY_SPACE,
      [this] { take_next_step(); });
  add("setup.source", "Other source",
      "Cameras, pictures, videos in turn; the simulator where there is no real scope", GLFW_KEY_O,
      [this] { choose_source(); }, {"take another source", has_run});
  actions.add({"setup.gallery",
               "All sources",
               "All that is on offer, with what each shows now; a click takes one",
               GLFW_KEY_L,
               0,
               false,
               {},
               [this] { return shows_gallery_; },
               [this] { shows_gallery_ ? close_gallery() : show_gallery(); },
               {"end the source and choose another", has_run}});
  add("setup.path", "Type a source",
      "The path of a video or of a folder of pictures, the address of a camera or of a stream, or: simulator",
      GLFW_KEY_P, [this] { typed_.is_open = typed_.wants_focus = true; }, {"take another source", has_run});
  add("setup.again", "Start again", "From the first picture; what was adopted stays", GLFW_KEY_R,
      [this] { start(); }, {"start again", has_run});
  actions.add({"setup.stop",
               "Stop",
               "Ends the source and forgets what was not adopted",
               GLFW_KEY_ESCAPE,
               0,
               false,
               has_run,
               {},
               [this] { step().station->stop(); },
               {"stop"}});
  for (Step& one : steps_) one.station->add_actions(actions);
}

std::vector<std::string_view> SetupView::action_prefixes() const {
  return {"setup.next",  "setup.source", "setup.gallery", "setup.path",
          "setup.again", "setup.stop",   "setup.show_",   step().prefix};
}

void SetupView::draw(const widgets::Ui& ui, const widgets::Rect& area) {
  const float gap = ui.theme.px(12);
  widgets::Rect rest = area;
  draw_heading(ui, rest.cut_top(ui.theme.px(88), gap));
  const widgets::Rect controls = rest.cut_bottom(ui.theme.px(100), gap);
  shows_gallery_ ? draw_gallery(ui, rest) : step().station->draw(ui, rest);
  note_stream();
  draw_controls(ui, controls);
  ui.log.note_state("setup_step", std::string(step().action).substr(std::string("setup.show_").size()));
  const FeedSource* source = step().source.chosen();
  ui.log.note_state("setup_source", source != nullptr ? source->name : step().source.problem());
  ui.log.note_state("setup_next", next_step());
  ui.log.note_state("setup_adopted", step().station->adopted().text);
}

// The steps with what the case has of each; beside them what comes next, and the source.
void SetupView::draw_heading(const widgets::Ui& ui, const widgets::Rect& area) {
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  const float gap = ui.theme.px(10), width = ui.theme.px(300), height = ui.theme.px(50);
  widgets::Rect rest = area;
  for (const Step& one : steps_) {
    const widgets::Rect place = rest.cut_left(width, gap);
    ImGui::SetCursorScreenPos(place.min());
    widgets::action_button(ui, one.action, width, height);
    const Row row = one.station->adopted();
    const float y = place.y + height + ui.theme.px(8);
    widgets::draw_sign(draw, {place.x + ui.theme.px(12), y + ui.theme.px(13)}, ui.theme.px(9), row.severity);
    draw.PushClipRect({place.x, place.y}, {place.x + place.width, place.y + place.height}, true);
    draw.AddText(ui.theme.body, ui.theme.body->FontSize, {place.x + ui.theme.px(30), y}, widgets::kQuietText,
                 row.text.c_str());
    draw.PopClipRect();
  }
  const float left = rest.x + ui.theme.px(10);
  const std::string next = "Next: " + next_step();
  draw.PushClipRect(rest.min(), rest.max(), true);
  draw.AddText(ui.theme.title, ui.theme.title->FontSize, {left, rest.y + ui.theme.px(4)}, widgets::kAccent,
               next.c_str());
  const float y = rest.y + height + ui.theme.px(8);
  if (typed_.is_open) {
    draw.PopClipRect();
    return draw_path_field(ui, {left, y - ui.theme.px(8), rest.x + rest.width - left, ui.theme.px(40)});
  }
  const bool is_chosen = step().source.chosen() != nullptr;
  const std::string source = is_chosen ? "Source: " + step().source.text() : step().source.problem();
  draw.AddText(ui.theme.body, ui.theme.body->FontSize, {left, y},
               is_chosen ? widgets::kQuietText : widgets::kCaution, source.c_str());
  draw.PopClipRect();
}

void SetupView::draw_path_field(const widgets::Ui& ui, const widgets::Rect& area) {
  ImGui::SetCursorScreenPos(area.min());
  ImGui::SetNextItemWidth(area.width);
  if (typed_.wants_focus) ImGui::SetKeyboardFocusHere();
  const bool is_entered = ImGui::InputTextWithHint(
      "##path", "path of a video or of a folder, /dev/video0, rtsp://HOST/PATH, udp://@:PORT; then Enter",
      &typed_.text, ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_AutoSelectAll);
  ui.log.note("setup.path_field", ImGui::GetItemRectMin(), ImGui::GetItemRectMax());
  if (is_entered) return take_typed_path();
  if (!typed_.wants_focus && ImGui::IsItemDeactivated()) typed_.is_open = false;
  typed_.wants_focus = false;
}

void SetupView::draw_controls(const widgets::Ui& ui, const widgets::Rect& area) {
  std::vector<const char*> ids{"setup.next", "setup.source", "setup.gallery",
                               "setup.path", "setup.again",  "setup.stop"};
  for (const char* id : step().station->buttons()) ids.push_back(id);
  const std::size_t columns = (ids.size() + 1) / 2;
  const float gap = ui.theme.px(10), height = (area.height - gap) / 2;
  const float width = (area.width - gap * static_cast<float>(columns - 1)) / static_cast<float>(columns);
  for (std::size_t i = 0; i < ids.size(); ++i) {
    ImGui::SetCursorScreenPos({area.x + static_cast<float>(i % columns) * (width + gap),
                               area.y + static_cast<float>(i / columns) * (height + gap)});
    widgets::action_button(ui, ids[i], width, height);
  }
}

}  // namespace arthronaut::setup
