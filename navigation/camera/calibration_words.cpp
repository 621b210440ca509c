#include "navigation/camera/calibration_words.h"

#include "navigation/camera/medium.h"
#include "planning/files/format.h"
#include "planning/files/utc_clock.h"

namespace arthronaut::camera {

std::string scope_in_words(const CalibrationRecord& record) {
  if (record.scope_name.empty() && record.head_name.empty()) return "not recorded";
  if (record.scope_name.empty()) return record.head_name;
  return record.scope_name + (record.head_name.empty() ? "" : ", " + record.head_name);
}

std::string in_words(const CalibrationRecord& record) {
  const bool has_scope = !record.scope_name.empty() || !record.head_name.empty();
  return (has_scope ? scope_in_words(record) : "scope not recorded") + ", calibrated " +
         (record.date_utc.empty() ? "" : files::utc_in_words(record.date_utc) + " ") + "in " +
         medium_to_text(record.calibration.refractive_index) +
         (record.date_utc.empty() ? ", date not recorded" : "") +
         (record.rms_px >= 0 ? files::format(", RMS %.2f px", record.rms_px) : ", RMS not recorded");
}

}  // namespace arthronaut::camera
