#include "app/setup/tool_station.h"

#include <GLFW/glfw3.h>

#include <algorithm>

#include "app/case/case_calibration.h"
#include "app/case/case_fluid.h"
#include "navigation/camera/medium.h"
#include "planning/cases/case.h"
#include "planning/files/utc_clock.h"
#include "planning/geometry/error.h"

namespace arthronaut::setup {

namespace {

std::string name_of(const ToolChoice& choice) {
  return choice.tool_name + (choice.task == ToolTask::Tip ? ": tip" : ": axis");
}

// How many come from where; what is simulated is named first.
Row row_of(const tools::ToolSet& tools) {
  if (tools.tracker)
    return {
        widgets::Severity::Caution, "Tools",
        "seen by an outside tracker" + (tools.tracker->address.empty() ? "" : ", " + tools.tracker->address)};
  const auto count = [&](provenance::Origin origin) {
    return std::count_if(tools.tools.begin(), tools.tools.end(),
                         [&](const tools::Tool& tool) { return tool.provenance.origin == origin; });
  };
  const auto simulated = count(provenance::Origin::Simulated), measured = count(provenance::Origin::Measured);
  std::string text = std::to_string(measured) + " of " + std::to_string(tools.tools.size()) + " measured";
  if (simulated > 0) text = std::to_string(simulated) + " simulated, " + text;
  return {simulated > 0  ? widgets::Severity::Caution
          : measured > 0 ? widgets::Severity::Good
                         : widgets::Severity::Quiet,
          "Tools", text};
}

}  // namespace

void ToolStation::open(const std::filesystem::path& case_folder) {
  stop();
  case_folder_ = case_folder;
  chosen_ = 0;
  refractive_index_ = camera::kSalineIndex;
  read_adopted();
}

void ToolStation::read_adopted() {
  const std::filesystem::path file = cases::tools_file(case_folder_);
  tools::ToolSet tools = tools::standard_tools();
  // The simulator's are the built-in ones; of a real scope nobody knows them.
  adopted_ = {widgets::Severity::Quiet, "Tools",
              open_case::has_real_camera(case_folder_) ? "none known: measure them, or take built-in ones (B)"
                                                       : "built-in geometry"};
  has_file_ = std::filesystem::exists(file);
  try {  // a file that can't be used is a state of this screen
    if (has_file_) {
      tools = tools::read_tools_file(file);
      adopted_ = row_of(tools);
    }
  } catch (const std::runtime_error& error) {
    adopted_ = {widgets::Severity::Bad, "Tools", error.what()};
  }
  choices_ = choices_of(tools);
  if (choices_.empty()) choices_ = choices_of(tools = tools::standard_tools());
  chosen_ %= choices_.size();
  is_measured_.clear();
  for (const ToolChoice& one : choices_) {
    const tools::NominalParts nominal = tools::nominal_parts(*tools.find_tool(one.tool_name));
    is_measured_.push_back(!(one.task == ToolTask::Tip ? nominal.tip : nominal.axis));
  }
}

std::optional<std::size_t> ToolStation::next_unmeasured() const {
  if (run_ == nullptr || !run_->source().is_live) return std::nullopt;
  for (std::size_t i = 1; i < choices_.size(); ++i)
    if (const std::size_t place = (chosen_ + i) % choices_.size(); !is_measured_[place]) return place;
  return std::nullopt;
}

// As they were designed: nobody measured them, and who is guided by them is told so.
void ToolStation::take_built_in() {
  if (std::filesystem::exists(cases::tools_file(case_folder_))) return read_adopted();  // another program's
  try {
    tools::write_tools_file(cases::tools_file(case_folder_), tools::standard_tools());
    read_adopted();
  } catch (const std::runtime_error& error) {  // a disk that is full
    adopted_ = {widgets::Severity::Bad, "Tools", std::string("not saved: ") + error.what()};
  }
}

ToolChoice ToolStation::choice() const { return choices_.empty() ? ToolChoice{"probe"} : choices_[chosen_]; }

bool ToolStation::is_of_camera_before() const {
  return run_ != nullptr && camera_sha256_ != open_case::camera_fingerprint(case_folder_);
}

void ToolStation::show() {
  if (is_of_camera_before()) stop();
}

void ToolStation::start(const FeedSource& source) {
  stop();
  camera_sha256_ = open_case::camera_fingerprint(case_folder_);
  found_origin_ = open_case::origin_by_camera(source.is_simulated, case_folder_);
  kept_because_ = open_case::tools_are_kept(found_origin_ == provenance::Origin::Simulated, case_folder_);
  run_ = std::make_unique<Run>(
      source,
      [source, folder = case_folder_, index = refractive_index_, choice = choice()] {
        if (source.is_simulated && choice.task == ToolTask::Axis)
          throw InvalidInput(
              "the simulated arthroscope shows no guide that turns: choose another source (O)");
        if (source.is_live)
          if (const std::string why = open_case::camera_is_not_for_live(folder); !why.empty())
            throw InvalidInput(why);
        pipeline::ViewTrackerOptions view;
        view.calibration = open_case::camera_of(source.is_simulated, folder);
        view.refractive_index = index;
        return std::make_unique<ToolJob>(view, open_case::tools_of(source.is_simulated, folder), choice);
      },
      wake_);
}

void ToolStation::stop() {
  if (run_ != nullptr) ending_.end(std::move(run_));
  status_ = {};
  display_ = {};
  adopted_result_.reset();
  usable_since_s_.reset();
}

void ToolStation::release_source() {
  if (run_ != nullptr) run_->release_source();
}

bool ToolStation::is_busy() const {
  const bool is_read = !usable_since_s_ || steady_now_s() - *usable_since_s_ > kReading_s;
  return run_ != nullptr &&
         (status_.phase == FeedPhase::Starting || status_.phase == FeedPhase::Running || !is_read);
}

void ToolStation::adopt() {
  const std::shared_ptr<const ToolResult> result = status_.job.result;
  if (is_of_camera_before()) {
    adopted_ = {widgets::Severity::Bad, "Tools",
                "not saved: camera.json is another one by now; start again (R) and measure through it"};
    return;
  }
  try {  // a disk that is full, a file that somebody broke: states of the screen
    const std::filesystem::path file = cases::tools_file(case_folder_);
    const tools::ToolSet known =
        std::filesystem::exists(file) ? tools::read_tools_file(file) : tools::standard_tools();
    tools::write_tools_file(
        file, with_result(known, choice().tool_name, *result, {found_origin_, files::utc_now()}));
    adopted_result_ = result;
    run_->post([result](ToolJob& job) { job.settle(result); });
    read_adopted();
  } catch (const std::runtime_error& error) {
    adopted_ = {widgets::Severity::Bad, "Tools", std::string("not saved: ") + error.what()};
  }
}

Then ToolStation::take_next_step() {
  if (display_.next == ToolStep::Done) {
    const auto next = next_unmeasured();
    if (!next) return Then::GoOn;
    stop();
    chosen_ = *next;
    return Then::StartAgain;
  }
  if (display_.next == ToolStep::Again) return Then::StartAgain;
  if (display_.next == ToolStep::Adopt) adopt();
  return Then::Stay;
}

void ToolStation::add_actions(widgets::Actions& actions) {
  using Test = std::function<bool()>;
  const auto add = [&](const char* id, const char* label, const char* tooltip, int key, const Test& enabled,
                       const std::function<void()>& run, const widgets::Hold& hold = {}) {
    actions.add({id, label, tooltip, key, 0, false, enabled, {}, run, hold});
  };
  add(
      "setup.tools.tool", "Other tool", "The next tool of tools.json; ends what runs", GLFW_KEY_TAB,
      [this] { return choices_.size() > 1; },
      [this] {
        stop();
        chosen_ = (chosen_ + 1) % choices_.size();
      },
      {"take another tool", [this] { return run_ != nullptr; }});
  add(
      "setup.tools.built_in", "Built-in tools",
      "The case's tools are the built-in ones as designed, which nobody measured (nominal)", GLFW_KEY_B,
      [this] { return !has_file_ && run_ == nullptr; }, [this] { take_built_in(); });
  actions.add({"setup.tools.medium",
               "Saline",
               "Saline while on, air while off; for the next start",
               GLFW_KEY_M,
               0,
               false,
               {},
               [this] { return refractive_index_ != camera::kAirIndex; },
               [this] {
                 refractive_index_ =
                     refractive_index_ == camera::kAirIndex ? camera::kSalineIndex : camera::kAirIndex;
               }});
  add(
      "setup.tools.clear", "Clear poses", "Forgets the poses and takes new ones", GLFW_KEY_C,
      [this] { return run_ != nullptr && status_.job.pose_count > 0; },
      [this] { run_->post([](ToolJob& job) { job.clear(); }); }, {"clear the poses"});
  add(
      "setup.tools.adopt", "Adopt", "This case is navigated with the result", GLFW_KEY_ENTER,
      [this] { return run_ != nullptr && display_.can_adopt; }, [this] { adopt(); });
}

std::vector<const char*> ToolStation::buttons() const {
  return {"setup.tools.tool", "setup.tools.built_in", "setup.tools.medium", "setup.tools.clear",
          "setup.tools.adopt"};
}

void ToolStation::draw(const widgets::Ui& ui, const widgets::Rect& area) {
  if (run_ != nullptr) status_ = run_->status();
  const bool is_adopted = adopted_result_ != nullptr && adopted_result_ == status_.job.result;
  const double now_s = steady_now_s();
  if (status_.job.result == nullptr || !status_.job.result->is_usable())
    usable_since_s_.reset();
  else if (!usable_since_s_)
    usable_since_s_ = now_s;
  const auto next = next_unmeasured();
  const ToolContext context{is_adopted, kept_because_, now_s - usable_since_s_.value_or(now_s),
                            next ? name_of(choices_[*next]) : ""};
  display_ = run_ != nullptr ? tool_display(status_, choice(), context, now_s) : ToolDisplay{};
  const float gap = ui.theme.px(12);
  widgets::Rect rest = area;
  widgets::Rect left = rest.cut_left(rest.width * 0.36F, gap);
  const widgets::Rect band = left.cut_bottom(ui.theme.px(130), gap);
  draw_picture_with_markers(ui, left);
  const Band idle{widgets::Severity::Quiet, "Nothing runs yet", "Calibrates " + name_of(choice())};
  draw_band(ui, band, run_ != nullptr ? display_.band : idle);
  widgets::Rect right = rest.cut_right(rest.width * 0.48F, gap);
  widgets::Rect middle = rest;
  const widgets::Rect markers = middle.cut_bottom(ui.theme.px(200), gap);
  draw_motion(ui, middle);
  draw_rows(ui, "setup.markers", markers, "Markers", display_.markers);
  const widgets::Rect verdict = right.cut_bottom(ui.theme.px(130), gap);
  const Band none{widgets::Severity::Quiet, "Nothing to judge yet", ""};
  draw_band(ui, verdict, display_.verdict.headline.empty() ? none : display_.verdict);
  draw_rows(ui, "setup.numbers", right, name_of(choice()), display_.numbers);
  ui.log.note_state("setup_tool", name_of(choice()));
  ui.log.note_state("setup_adopted", adopted_.text);
  ui.log.note_state("setup_band", run_ != nullptr ? display_.band.headline : "no source");
  ui.log.note_state("setup_verdict", display_.verdict.headline);
}

void ToolStation::draw_picture_with_markers(const widgets::Ui& ui, const widgets::Rect& area) {
  const widgets::PicturePlacement place =
      draw_picture(ui, area, picture_, status_.job.picture, status_.job.view, display_.is_live);
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  draw.PushClipRect(place.area().min(), place.area().max(), true);
  for (const ToolStatus::Seen& marker : status_.job.markers)
    if (marker.stands && display_.is_live) draw_marker(ui, place, marker.corners_px);
  draw.PopClipRect();
}

void ToolStation::draw_motion(const widgets::Ui& ui, const widgets::Rect& area) {
  const bool is_tip = choice().task == ToolTask::Tip;
  widgets::begin_panel(ui, "setup.motion", area, is_tip ? "Cone of the shaft" : "Turn about the axis");
  const ImVec2 at = ImGui::GetCursorScreenPos(), room = ImGui::GetContentRegionAvail();
  const widgets::Rect plot{at.x, at.y, room.x, room.y};
  ui.log.note("setup.motion", plot.min(), plot.max());
  const ToolResult none;
  const ToolResult& result = status_.job.result != nullptr ? *status_.job.result : none;
  if (is_tip)
    draw_cone(ui, plot, result.tip, tools::PivotCalibrationOptions{}.min_cone_deg);
  else
    draw_turn(ui, plot, result.axis.turn_deg, tools::SpinCalibrationOptions{}.min_turn_deg);
  widgets::end_panel();
}

}  // namespace arthronaut::setup
