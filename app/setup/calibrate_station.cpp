#include "app/setup/calibrate_station.h"

#include <GLFW/glfw3.h>

#include <algorithm>

#include "app/case/case_calibration.h"
#include "navigation/camera/camera_file.h"
#include "navigation/camera/doubted_camera_file.h"
#include "planning/cases/case.h"
#include "planning/files/fixed_number.h"
#include "planning/files/utc_clock.h"
#include "planning/geometry/error.h"

namespace arthronaut::setup {

namespace {

constexpr double kSquareStep_mm = 0.1, kLeastSquare_mm = 0.1, kMostSquare_mm = 20;

}  // namespace

void CalibrateStation::open(const std::filesystem::path& case_folder) {
  stop();
  case_folder_ = case_folder;
  form_ = {};
  read_adopted();
}

void CalibrateStation::read_adopted() {
  adopted_ = {widgets::Severity::Quiet, "Camera", "not calibrated yet"};
  const std::filesystem::path file = cases::camera_file(case_folder_);
  if (!std::filesystem::exists(file)) return;
  try {  // a file that can't be used is a state of this screen
    const camera::CalibrationRecord record = camera::read_camera_file(file);
    if (form_.scope_name.empty()) form_.scope_name = record.scope_name;
    if (form_.head_name.empty()) form_.head_name = record.head_name;
    const bool is_measured = record.provenance.origin == provenance::Origin::Measured;
    std::string words = open_case::in_words(record.provenance, files::utc_now());
    const std::vector<std::string> doubts = camera::read_camera_doubts(file);
    for (const std::string& doubt : doubts) words += "; not reliable: " + doubt;
    adopted_ = {is_measured && doubts.empty() ? widgets::Severity::Good : widgets::Severity::Caution,
                "Camera", std::move(words)};
  } catch (const std::runtime_error& error) {
    adopted_ = {widgets::Severity::Bad, "Camera", error.what()};
  }
}

void CalibrateStation::start(const FeedSource& source) {
  stop();
  if (source.is_simulated)
    form_.scope_name = camera::kSimulatedScope;
  else if (form_.scope_name == camera::kSimulatedScope)
    form_.scope_name.clear();
  kept_because_ = open_case::camera_is_kept(source.is_simulated, case_folder_);
  const bool by_itself = takes_by_itself_;
  run_ = std::make_unique<Run>(
      source, [by_itself] { return std::make_unique<CalibrateJob>(by_itself); }, wake_);
}

void CalibrateStation::stop() {
  if (run_ != nullptr) ending_.end(std::move(run_));
  status_ = {};
  display_ = {};
  adopted_result_.reset();
  seen_result_.reset();
}

void CalibrateStation::release_source() {
  if (run_ != nullptr) run_->release_source();
}

bool CalibrateStation::is_busy() const {
  const bool is_read = seen_result_ == nullptr || steady_now_s() - seen_since_s_ > kReading_s;
  return run_ != nullptr && (status_.phase == FeedPhase::Starting || status_.phase == FeedPhase::Running ||
                             status_.job.is_calibrating || !is_read);
}

// A result that stands is of the square that it was made with.
void CalibrateStation::set_square(double square_mm) {
  if (square_mm == form_.square_mm) return;
  form_.square_mm = square_mm;
  if (run_ != nullptr) run_->post([](CalibrateJob& job) { job.forget_result(); });
}

void CalibrateStation::calibrate() {
  calibration::CalibrationOptions options;
  options.square_mm = form_.square_mm;
  run_->post([options](CalibrateJob& job) { job.calibrate(options); });
}

void CalibrateStation::adopt() {
  camera::CalibrationRecord record = status_.job.summary->record;
  record.scope_name = form_.scope_name;
  record.head_name = form_.head_name;
  const bool is_simulated = run_->source().is_simulated;
  record.provenance = {is_simulated ? provenance::Origin::Simulated : provenance::Origin::Measured,
                       record.date_utc};
  try {  // a disk that is full is a state of the screen
    camera::write_camera_file(cases::camera_file(case_folder_), record);
    adopted_result_ = status_.job.summary;
    read_adopted();
  } catch (const IoError& error) {
    adopted_ = {widgets::Severity::Bad, "Camera", std::string("not saved: ") + error.what()};
  }
}

Then CalibrateStation::take_next_step() {
  switch (display_.next) {
    case CalibrateStep::Take:
      run_->post([](CalibrateJob& job) { job.take(); });
      break;
    case CalibrateStep::Calibrate:
      calibrate();
      break;
    case CalibrateStep::Adopt:
      adopt();
      break;
    case CalibrateStep::Resume:
      run_->post([](CalibrateJob& job) { job.forget_result(); });
      break;
    case CalibrateStep::Done:
      return Then::GoOn;
    case CalibrateStep::Wait:
      break;
  }
  return Then::Stay;
}

void CalibrateStation::add_actions(widgets::Actions& actions) {
  using Test = std::function<bool()>;
  const auto add = [&](const char* id, const char* label, const char* tooltip, int key, const Test& enabled,
                       const std::function<void()>& run, const widgets::Hold& hold = {}) {
    actions.add({id, label, tooltip, key, 0, false, enabled, {}, run, hold});
  };
  actions.add({"setup.camera.auto",
               "Take by itself",
               "A picture that is good and held still is taken",
               GLFW_KEY_A,
               0,
               false,
               {},
               [this] { return takes_by_itself_; },
               [this] {
                 takes_by_itself_ = !takes_by_itself_;
                 if (run_ != nullptr)
                   run_->post([on = takes_by_itself_](CalibrateJob& job) { job.set_takes_by_itself(on); });
               }});
  add(
      "setup.camera.take", "Take", "Takes the picture that is seen", GLFW_KEY_T,
      [this] { return run_ != nullptr && display_.can_take; },
      [this] { run_->post([](CalibrateJob& job) { job.take(); }); });
  add(
      "setup.camera.drop", "Drop last", "Forgets the picture taken last", GLFW_KEY_D,
      [this] { return run_ != nullptr && display_.can_drop; },
      [this] { run_->post([](CalibrateJob& job) { job.drop_last(); }); }, {"forget the last picture"});
  add(
      "setup.camera.still", "Next picture", "Leaves this picture out; of single pictures", GLFW_KEY_RIGHT,
      [this] { return run_ != nullptr && run_->source().is_stills && status_.phase == FeedPhase::Running; },
      [this] { run_->next_still(); });
  add(
      "setup.camera.calibrate", "Calibrate", "From the pictures taken", GLFW_KEY_C,
      [this] { return run_ != nullptr && display_.can_calibrate; }, [this] { calibrate(); });
  add(
      "setup.camera.adopt", "Adopt", "This case is navigated with the result", GLFW_KEY_ENTER,
      [this] { return run_ != nullptr && display_.can_adopt; }, [this] { adopt(); });
  add("setup.camera.smaller", "Square \u2212", "The board's squares are smaller", GLFW_KEY_MINUS, {},
      [this] { set_square(std::max(form_.square_mm - kSquareStep_mm, kLeastSquare_mm)); });
  add("setup.camera.larger", "Square +", "The board's squares are larger", GLFW_KEY_EQUAL, {},
      [this] { set_square(std::min(form_.square_mm + kSquareStep_mm, kMostSquare_mm)); });
  add("setup.camera.names", "Size, names", "Type the square's side and the names of scope and head",
      GLFW_KEY_N, {}, [this] { form_.wants_focus = true; });
}

std::vector<const char*> CalibrateStation::buttons() const {
  return {"setup.camera.auto",    "setup.camera.take",      "setup.camera.drop",
          "setup.camera.still",   "setup.camera.calibrate", "setup.camera.adopt",
          "setup.camera.smaller", "setup.camera.larger",    "setup.camera.names"};
}

void CalibrateStation::draw(const widgets::Ui& ui, const widgets::Rect& area) {
  if (run_ != nullptr) status_ = run_->status();
  const bool is_adopted = adopted_result_ != nullptr && adopted_result_ == status_.job.summary;
  const double now_s = steady_now_s();
  if (seen_result_ != status_.job.summary) seen_since_s_ = now_s;
  seen_result_ = status_.job.summary;
  display_ = run_ != nullptr
                 ? calibrate_display(status_, {is_adopted, kept_because_, now_s - seen_since_s_}, now_s)
                 : CalibrateDisplay{};
  if (status_.job.summary != nullptr)
    draw_result(ui, area);
  else
    draw_pictures(ui, area);
  ui.log.note_state("setup_square_mm", files::fixed(form_.square_mm, 2));
  ui.log.note_state("setup_taken", std::to_string(status_.job.taken.size()));
  ui.log.note_state("setup_band", run_ != nullptr ? display_.band.headline : "no source");
  ui.log.note_state("setup_verdict", display_.verdict.headline);
}

}  // namespace arthronaut::setup
