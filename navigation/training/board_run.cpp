#include "navigation/training/board_run.h"

#include <cmath>
#include <limits>

#include "navigation/camera/camera_model.h"

namespace arthronaut::training {

namespace {

using calibration::CalibrationSummary;
using simulator::Press;

// Drawing a board that fills the view, and looking for its corners, takes 0.2 s of processor time.
constexpr int kBoardFramesPerSecond = 10;

simulator::SimulationOptions board_simulation(const ExerciseSetup& setup) {
  simulator::SimulationOptions options;
  options.camera = simulator::standard_camera();
  options.seed = setup.seed;
  options.frames_per_second = kBoardFramesPerSecond;
  return options;
}

simulator::HandOptions board_hand(const ExerciseSetup& setup, const simulator::Hand& hand, bool in_real_time,
                                  const std::shared_ptr<simulator::HandLog>& log) {
  simulator::HandOptions options;
  options.hand = hand;
  options.held = simulator::Held::Board;
  options.faults = faults_of(setup.exercise, setup.level);
  options.picture_share = kPictureShare;
  options.in_real_time = in_real_time;
  options.log = log;
  return options;
}

}  // namespace

BoardRun::BoardRun(const ExerciseSetup& setup, const simulator::Hand& hand, bool in_real_time)
    : board_(board_simulation(setup), board_hand(setup, hand, in_real_time, log_)),
      job_(/*takes_by_itself=*/false) {}

bool BoardRun::step() {
  if (job_.work()) judge_camera();
  if (facts_.is_done) return false;
  const camera::FramePtr picture = board_.next();
  if (picture == nullptr) return false;
  job_.look(picture);
  const simulator::HandTruth truth = *log_->newest();
  facts_.time_s = truth.time_s;
  ++facts_.frames;
  press(truth.input.press);
  return true;
}

void BoardRun::press(Press press) {
  if (press == Press::Picture) {
    const calibration::CalibrateStatus before = job_.status();
    job_.take();
    if (job_.status().taken.size() > before.taken.size())
      facts_.coverage.push_back(before.advice->quality.coverage);
    else
      ++facts_.refused_pictures;
  } else if (press == Press::DropPicture) {
    job_.drop_last();
    if (!facts_.coverage.empty()) facts_.coverage.pop_back();
  } else if (press == Press::Finish) {
    facts_.is_done = true;
    calibration::CalibrationOptions options;
    options.square_mm = simulator::SimulationOptions().square_mm;
    job_.calibrate(options);
  }
}

// A camera that the program refuses guides nobody, however near it may be.
void BoardRun::judge_camera() {
  const CalibrationSummary& summary = *job_.status().summary;
  if (summary.outcome == CalibrationSummary::Outcome::Ok)
    facts_.camera_error_px = error_over_view_px(summary.record.calibration, board_.camera());
  else
    facts_.camera_trouble = summary.reasons.empty() ? "it was refused" : summary.reasons.front();
}

double error_over_view_px(const camera::Calibration& found, const camera::Calibration& truth) {
  constexpr int kTurns = 8, kCells = 24;
  double sum_px2 = 0;
  long count = 0;
  for (int i = 0; i < kTurns; ++i) {
    const double mark_deg = 360.0 * i / kTurns;
    const double lens_rad = truth.lens_angle_rad(mark_deg);
    const camera::CameraModel true_camera(truth, lens_rad, truth.refractive_index);
    const camera::CameraModel found_camera(found, found.lens_angle_rad(mark_deg), truth.refractive_index);
    const Eigen::Vector2d center = truth.turned(truth.boundary.center_px, lens_rad);
    for (int y = -kCells; y <= kCells; ++y)
      for (int x = -kCells; x <= kCells; ++x) {
        if (x * x + y * y > kCells * kCells) continue;
        const Eigen::Vector2d pixel = center + truth.boundary.radius_px / kCells * Eigen::Vector2d(x, y);
        const auto ray = true_camera.ray(pixel);
        if (!ray) continue;  // nothing is seen there
        const auto seen = found_camera.project(*ray);
        if (!seen) return std::numeric_limits<double>::infinity();
        sum_px2 += (*seen - pixel).squaredNorm();
        ++count;
      }
  }
  return count > 0 ? std::sqrt(sum_px2 / static_cast<double>(count)) : 0;
}

}  // namespace arthronaut::training
