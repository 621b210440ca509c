// What stands on the screen while a camera is calibrated: a pure function of the run's status.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/setup_view/calibrate_job.h"
#include "app/setup_view/station.h"

namespace arthronaut::setup_view {

enum class CalibrateStep {
  Wait,
  Take,       // the picture that is seen
  Calibrate,  // from those taken
  Adopt,
  Resume,  // taking pictures, the result is refused
  Done,
};

struct CalibrateDisplay {
  bool has_picture = false;
  bool is_live = false;              // the picture is of now
  Band band;                         // what is wanted, and why this picture is not taken
  std::vector<Row> quality;          // of this picture, each beside its limit
  std::vector<Row> result;           // numbers with their one-sigma; empty without a usable result
  Band verdict;                      // of the result; empty headline: there is none
  std::vector<std::string> reasons;  // against it, all of them
  bool can_take = false, can_drop = false, can_calibrate = false, can_adopt = false;
  CalibrateStep next = CalibrateStep::Wait;
  std::string next_text;
};

using CalibrateRunStatus = RunStatus<CalibrateStatus>;

// is_adopted: this very result stands in the case already.
[[nodiscard]] CalibrateDisplay calibrate_display(const CalibrateRunStatus& status, bool is_adopted,
                                                 double now_s);

// How far the boards were from the lens, along the optical axis; the median over the pictures.
[[nodiscard]] double working_distance_mm(const calibration::CalibrationSummary& summary);

}  // namespace arthronaut::setup_view
