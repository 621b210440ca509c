#include "app/setup/fluid_station.h"

#include <GLFW/glfw3.h>

#include <utility>

#include "app/case/case_calibration.h"
#include "app/library/daily_check.h"
#include "app/library/workstation_library.h"
#include "navigation/camera/medium.h"
#include "planning/cases/case.h"
#include "planning/files/local_time.h"
#include "planning/files/utc_clock.h"
#include "planning/geometry/error.h"

namespace arthronaut::setup {

void FluidStation::open(const std::filesystem::path& case_folder) {
  stop();
  case_folder_ = case_folder;
  refractive_index_ = camera::kSalineIndex;
  read_standing();
}

void FluidStation::read_standing() {
  using open_case::FluidStanding;
  const bool is_simulated = !open_case::has_real_camera(case_folder_);
  const open_case::FluidState state =
      open_case::fluid_state(case_folder_, refractive_index_, is_simulated, files::utc_now());
  standing_ = state.text;
  checked_ = {widgets::Severity::Caution, "Fluid", state.text};
  if (state.standing == FluidStanding::Unreadable) checked_.severity = widgets::Severity::Bad;
  if (state.standing != FluidStanding::Trusted && state.standing != FluidStanding::Refused) return;
  const std::string medium = camera::medium_to_text(refractive_index_);
  const bool is_measured = state.last->provenance.origin == provenance::Origin::Measured;
  const std::string date =
      is_measured ? files::local_day(state.last->provenance.calibrated_utc) : "simulated";
  checked_.text = (state.is_trusted() ? medium + " fits, " : "refused in " + medium + ", ") + date;
  checked_.severity = !state.is_trusted() ? widgets::Severity::Bad
                      : is_measured       ? widgets::Severity::Good
                                          : widgets::Severity::Caution;
}

void FluidStation::keep_verdict() {
  const std::shared_ptr<const calibration::FluidCheckSummary>& summary = status_.job.summary;
  if (summary == nullptr || summary == kept_) return;
  kept_ = summary;
  const FeedSource& source = run_->source();
  std::string why_not;
  try {  // a disk that is full is a state of the screen
    calibration::FluidRecord record = calibration::record_of(*summary, status_.job.refractive_index);
    record.camera_sha256 = status_.job.camera_sha256;
    why_not = open_case::keep_fluid_verdict(case_folder_, std::move(record), source.is_simulated, source.name,
                                            files::utc_now());
    read_standing();
    if (!why_not.empty()) checked_ = {widgets::Severity::Caution, "Fluid", "not kept: " + why_not};
  } catch (const InvalidInput& error) {
    checked_ = {widgets::Severity::Caution, "Fluid", std::string("not kept: ") + error.what()};
  } catch (const IoError& error) {
    checked_ = {widgets::Severity::Bad, "Fluid", std::string("not saved: ") + error.what()};
  }
  if (source.is_simulated) return;
  if (!why_not.empty()) {
    daily_check_ = {widgets::Severity::Caution, "Daily check", "not kept: " + why_not};
    return;
  }
  // The same look is the day's check of accuracy, also where the verdict could not be written.
  const workstation_library::DailyKeeping daily =
      workstation_library::keep_daily_check(workstation_library::data_folder(), *summary,
                                            {.refractive_index = status_.job.refractive_index,
                                             .camera_file = cases::camera_file(case_folder_),
                                             .source = source.name},
                                            source.is_live);
  daily_check_ = {daily.is_kept ? widgets::Severity::Good : widgets::Severity::Caution, "Daily check",
                  daily.text};
}

void FluidStation::show() {
  // What was found through the camera before says nothing of the one of now.
  if (run_ != nullptr && camera_sha256_ != open_case::camera_fingerprint(case_folder_)) stop();
  read_standing();
}

void FluidStation::start(const FeedSource& source) {
  stop();
  camera_sha256_ = open_case::camera_fingerprint(case_folder_);
  run_ = std::make_unique<Run>(
      source,
      [source, folder = case_folder_, index = refractive_index_, camera_sha256 = camera_sha256_] {
        if (source.is_live)
          if (const std::string why = open_case::camera_is_not_for_live(folder); !why.empty())
            throw InvalidInput(why);
        calibration::RulerSightingsOptions options;
        options.calibration = open_case::camera_of(source.is_simulated, folder);
        options.refractive_index = index;
        return std::make_unique<FluidJob>(options, camera_sha256);
      },
      wake_);
}

void FluidStation::stop() {
  if (run_ != nullptr) ending_.end(std::move(run_));
  status_ = {};
  display_ = {};
  daily_check_ = {};
}

void FluidStation::release_source() {
  if (run_ != nullptr) run_->release_source();
}

bool FluidStation::is_busy() const {
  return run_ != nullptr && (status_.phase == FeedPhase::Starting || status_.phase == FeedPhase::Running ||
                             status_.job.is_checking);
}

Then FluidStation::take_next_step() {
  if (display_.next == FluidStep::Done) return Then::GoOn;
  if (display_.next == FluidStep::Again) return Then::StartAgain;
  if (display_.next == FluidStep::Check) run_->post([](FluidJob& job) { job.check(); });
  return Then::Stay;
}

void FluidStation::add_actions(widgets::Actions& actions) {
  actions.add({"setup.fluid.medium",
               "Other medium",
               "What the ruler is said to be in: saline, water, air in turn",
               GLFW_KEY_M,
               0,
               false,
               {},
               {},
               [this] {
                 stop();
                 refractive_index_ = refractive_index_ == camera::kSalineIndex  ? camera::kWaterIndex
                                     : refractive_index_ == camera::kWaterIndex ? camera::kAirIndex
                                                                                : camera::kSalineIndex;
                 read_standing();
               },
               {"change the medium", [this] { return run_ != nullptr; }}});
  actions.add({"setup.fluid.clear",
               "Check anew",
               "Forgets the pictures and counts new ones",
               GLFW_KEY_C,
               0,
               false,
               [this] { return run_ != nullptr && status_.phase == FeedPhase::Running; },
               {},
               [this] { run_->post([](FluidJob& job) { job.clear(); }); },
               {"count anew"}});
}

std::vector<const char*> FluidStation::buttons() const { return {"setup.fluid.medium", "setup.fluid.clear"}; }

void FluidStation::draw(const widgets::Ui& ui, const widgets::Rect& area) {
  if (run_ != nullptr) status_ = run_->status();
  display_ = run_ != nullptr ? fluid_display(status_, steady_now_s()) : FluidDisplay{};
  const std::string medium = camera::medium_to_text(refractive_index_);
  keep_verdict();
  const float gap = ui.theme.px(12);
  widgets::Rect rest = area;
  widgets::Rect left = rest.cut_left(rest.width * 0.36F, gap);
  const widgets::Rect band = left.cut_bottom(ui.theme.px(130), gap);
  draw_picture_with_ruler(ui, left);
  const Band idle{widgets::Severity::Quiet, "Nothing runs yet",
                  "The ruler with two markers (5 and 6, 10 mm apart) in " + medium};
  draw_band(ui, band, run_ != nullptr ? display_.band : idle);
  const widgets::Rect verdict = rest.cut_bottom(ui.theme.px(130), gap);
  const Band none{checked_.severity, "Said to be in " + medium, standing_};
  draw_band(ui, verdict, display_.verdict.headline.empty() ? none : display_.verdict);
  draw_models(ui, rest.cut_top(rest.height * 0.5F, gap));
  std::vector<Row> rows = display_.numbers;
  for (const std::string& reason : display_.reasons)
    rows.push_back({widgets::Severity::Bad, "Reason", reason});
  if (display_.verdict.headline.empty()) daily_check_ = {};
  if (!daily_check_.name.empty()) rows.push_back(daily_check_);
  draw_rows(ui, "setup.numbers", rest, display_.reasons.empty() ? "Numbers" : "Why not", rows);
  ui.log.note_state("setup_band", run_ != nullptr ? display_.band.headline : "no source");
  ui.log.note_state("setup_verdict", display_.verdict.headline);
  ui.log.note_state("setup_daily_check", daily_check_.text);
}

void FluidStation::draw_picture_with_ruler(const widgets::Ui& ui, const widgets::Rect& area) {
  const FluidStatus& job = status_.job;
  const widgets::PicturePlacement place =
      draw_picture(ui, area, picture_, job.picture, job.view, display_.is_live);
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  draw.PushClipRect(place.area().min(), place.area().max(), true);
  if (display_.is_live && job.summary == nullptr)
    for (const markers::MarkerObservation& marker : job.look.markers)
      if (marker.is_tracked()) draw_marker(ui, place, marker.corners_px);
  draw.PopClipRect();
  // How much of the five seconds has been seen.
  const float height = ui.theme.px(10), width = area.width * static_cast<float>(display_.progress);
  draw.AddRectFilled({area.x, area.y + area.height - height}, {area.x + width, area.y + area.height},
                     widgets::kAccent);
}

void FluidStation::draw_models(const widgets::Ui& ui, const widgets::Rect& area) {
  widgets::begin_panel(ui, "setup.models", area, "Which model of the fluid fits, best first");
  ui.log.note("setup.models", area.min(), area.max());
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  const ImVec2 at = ImGui::GetCursorScreenPos(), room = ImGui::GetContentRegionAvail();
  const float line = ui.theme.px(48);
  const std::array<float, 4> columns{at.x + ui.theme.px(34), at.x + room.x * 0.34F, at.x + room.x * 0.53F,
                                     at.x + room.x * 0.77F};
  const auto cell = [&](ImFont* font, std::size_t column, float y, ImU32 color, const std::string& text) {
    draw.AddText(font, font->FontSize, {columns.at(column), y}, color, text.c_str());
  };
  float y = at.y;
  const std::array<const char*, 4> head{"Model", "Corners miss", "Ruler wrong by, median", "95 %"};
  for (std::size_t i = 0; i < head.size(); ++i) cell(ui.theme.strong, i, y, widgets::kQuietText, head[i]);
  for (const FluidDisplay::Model& model : display_.models) {
    y += line;
    widgets::draw_sign(draw, {at.x + ui.theme.px(12), y + ui.theme.px(13)}, ui.theme.px(10), model.severity);
    cell(ui.theme.strong, 0, y, widgets::kText, model.name);
    cell(ui.theme.body, 1, y, widgets::kText, model.corners);
    cell(ui.theme.body, 2, y, widgets::kText, model.median);
    cell(ui.theme.body, 3, y, widgets::kText, model.worst);
  }
  if (display_.models.empty())
    cell(ui.theme.body, 0, y + line, widgets::kQuietText, "after five seconds of the ruler");
  widgets::end_panel();
}

}  // namespace arthronaut::setup
