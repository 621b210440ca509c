// What stands on the screen while a camera is calibrated: a pure function of the run's status.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/setup/station.h"
#include "navigation/calibration/calibrate_job.h"

namespace arthronaut::setup {

using calibration::CalibrateJob;
using calibration::CalibrateStatus;

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
  std::vector<std::string> notes;    // worth knowing, no harm
  bool can_take = false, can_drop = false, can_calibrate = false, can_adopt = false;
  CalibrateStep next = CalibrateStep::Wait;
  std::string next_text;
};

using CalibrateRunStatus = RunStatus<CalibrateStatus>;

// What the station knows beside the run.
struct CalibrateContext {
  bool is_adopted = false;              // this very result stands in the case already
  std::string kept_because = "";        // why the case's camera.json may not be replaced; empty: it may
  double result_stands_s = kReading_s;  // on the screen
};

[[nodiscard]] CalibrateDisplay calibrate_display(const CalibrateRunStatus& status,
                                                 const CalibrateContext& context, double now_s);

}  // namespace arthronaut::setup
