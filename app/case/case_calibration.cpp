#include "app/case/case_calibration.h"

#include <algorithm>

#include "navigation/camera/camera_file.h"
#include "navigation/simulator/simulated_operation.h"
#include "planning/cases/case.h"
#include "planning/geometry/error.h"

namespace arthronaut::open_case {

namespace {

namespace fs = std::filesystem;

// Whether the case's camera.json is of the simulated arthroscope. A file that can't be read is not.
bool has_simulated_camera(const fs::path& case_folder) {
  try {
    return camera::read_camera_file(cases::camera_file(case_folder)).scope_name == kSimulatedScope;
  } catch (const std::runtime_error&) {  // absent or broken: the one who uses it will say so
    return false;
  }
}

// Whether tools.json is what these pictures are tracked with.
bool uses_tools_file(bool is_simulated, const fs::path& case_folder) {
  if (!fs::exists(cases::tools_file(case_folder))) return false;
  return !is_simulated || !fs::exists(cases::camera_file(case_folder)) || has_simulated_camera(case_folder);
}

}  // namespace

camera::Calibration camera_of(bool is_simulated, const fs::path& case_folder) {
  if (is_simulated && !has_simulated_camera(case_folder)) return simulator::standard_camera();
  const fs::path file = cases::camera_file(case_folder);
  if (!fs::exists(file)) throw InvalidInput("the case has no camera.json: calibrate the camera first (F4)");
  return camera::read_camera_file(file).calibration;
}

tools::ToolSet tools_of(bool is_simulated, const fs::path& case_folder) {
  return uses_tools_file(is_simulated, case_folder) ? tools::read_tools_file(cases::tools_file(case_folder))
                                                    : tools::standard_tools();
}

std::string calibration_in_words(bool is_simulated, const fs::path& case_folder) {
  std::string words = "built-in camera";
  if (!is_simulated || has_simulated_camera(case_folder)) {
    const std::string date = camera::read_camera_file(cases::camera_file(case_folder)).date_utc;
    words = "camera of " + (date.empty() ? std::string("camera.json") : date.substr(0, 10));
  }
  if (!uses_tools_file(is_simulated, case_folder)) return words + ", built-in tools";
  const tools::ToolSet tools = tools_of(is_simulated, case_folder);
  const auto calibrated = std::count_if(tools.tools.begin(), tools.tools.end(),
                                        [](const tools::Tool& tool) { return tool.residual_mm.has_value(); });
  return words + ", " + std::to_string(calibrated) + " of " + std::to_string(tools.tools.size()) +
         " tools calibrated";
}

std::string camera_is_kept(bool is_simulated, const fs::path& case_folder) {
  const bool may_be_replaced =
      !is_simulated || !fs::exists(cases::camera_file(case_folder)) || has_simulated_camera(case_folder);
  return may_be_replaced
             ? ""
             : "this case has the calibration of a real scope; a simulated one does not replace it";
}

std::string tools_are_kept(bool is_simulated, const fs::path& case_folder) {
  const bool may_be_replaced =
      !is_simulated || !fs::exists(cases::tools_file(case_folder)) || has_simulated_camera(case_folder);
  return may_be_replaced ? "" : "this case has its own tools.json; what is simulated does not replace it";
}

}  // namespace arthronaut::open_case
