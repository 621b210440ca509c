#include "app/case/exercise_case.h"

#include "app/case/case_calibration.h"
#include "navigation/recording/case_sessions.h"

namespace arthronaut::open_case {

std::string refusal_to_train(const std::filesystem::path& case_folder) {
  if (case_folder.empty()) return "";
  std::string why;
  try {
    why = recording::real_session(case_folder);
    if (why.empty() && has_real_camera(case_folder)) why = "its camera.json is of a real scope";
  } catch (const std::filesystem::filesystem_error& error) {
    why = std::string("nobody can tell what is in it: ") + error.what();
  }
  return why.empty() ? "" : "nothing is practised in this case: " + why + "; take the built-in knee";
}

}  // namespace arthronaut::open_case
