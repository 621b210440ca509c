// Taking calibration pictures of what a source shows, and calibrating from them, without threads: what Set up
// does with a scope and Training with the simulated one.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "navigation/calibration/capture_guide.h"

namespace arthronaut::calibration {

struct CalibrateStatus {
  camera::FramePtr picture;                     // that the guide looked at last
  std::shared_ptr<const CaptureAdvice> advice;  // of this very picture; null before the first
  std::vector<std::string> taken;               // names
  std::vector<double> taken_angles_deg;         // mark angles of the pictures taken
  bool takes_by_itself = true;
  std::string note;        // why the last wish was not granted
  bool took_this = false;  // this picture is the one taken last
  bool is_calibrating = false;
  std::shared_ptr<const CalibrationSummary> summary;  // null: not calibrated from these pictures
  camera::FramePtr residuals;                         // the plot; null without a usable summary
};

class CalibrateJob {
 public:
  using Status = CalibrateStatus;

  explicit CalibrateJob(bool takes_by_itself) : takes_by_itself_(takes_by_itself) {}

  // A picture may come again: then it was held still.
  void look(const camera::FramePtr& frame);
  bool work();  // the calibration that was asked for
  [[nodiscard]] bool wants_next_still() const;
  [[nodiscard]] Status status() const;

  void set_takes_by_itself(bool on) { takes_by_itself_ = on; }
  // The picture last looked at; a bad one is not taken, and the note says why.
  void take();
  void drop_last();
  void forget_result();                               // back to taking pictures
  void calibrate(const CalibrationOptions& options);  // done in work()

 private:
  CaptureGuide guide_;
  std::vector<std::uint8_t> gray_;
  camera::FramePtr picture_;
  int looks_at_this_ = 0, good_looks_ = 0;
  bool takes_by_itself_, took_this_ = false, is_calibrating_ = false;
  std::string note_;
  CalibrationOptions options_;
  std::shared_ptr<const CalibrationSummary> summary_;
  camera::FramePtr residuals_;
};

}  // namespace arthronaut::calibration
