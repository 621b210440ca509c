#include "app/case/case_calibration.h"

#include <algorithm>
#include <cmath>

#include "navigation/camera/camera_file.h"
#include "navigation/camera/doubted_camera_file.h"
#include "navigation/simulator/simulated_operation.h"
#include "planning/cases/case.h"
#include "planning/files/local_time.h"
#include "planning/geometry/error.h"

namespace arthronaut::open_case {

namespace {

namespace fs = std::filesystem;

// Whether the case's camera.json is of the simulated arthroscope. A file that can't be read is not.
bool has_simulated_camera(const fs::path& case_folder) {
  try {
    return camera::read_camera_file(cases::camera_file(case_folder)).provenance.origin ==
           provenance::Origin::Simulated;
  } catch (const std::runtime_error&) {  // absent or broken: the one who uses it will say so
    return false;
  }
}

// Whether tools.json is what these pictures are tracked with.
bool uses_tools_file(bool is_simulated, const fs::path& case_folder) {
  if (!fs::exists(cases::tools_file(case_folder))) return false;
  return !is_simulated || !fs::exists(cases::camera_file(case_folder)) || has_simulated_camera(case_folder);
}

// " (end nominal)": what of a tool that was measured was not.
std::string but_not(const tools::NominalParts& nominal) {
  std::string parts;
  for (const auto& [is_nominal, part] :
       {std::pair(nominal.tip, "tip"), std::pair(nominal.axis, "axis"), std::pair(nominal.end, "end")})
    if (is_nominal) parts += (parts.empty() ? " (" : ", ") + std::string(part);
  return parts.empty() ? "" : parts + " nominal)";
}

}  // namespace

camera::Calibration camera_of(bool is_simulated, const fs::path& case_folder) {
  return camera_record_of(is_simulated, case_folder).calibration;
}

camera::CalibrationRecord camera_record_of(bool is_simulated, const fs::path& case_folder) {
  if (is_simulated && !has_simulated_camera(case_folder)) {
    camera::CalibrationRecord built_in;
    built_in.calibration = simulator::standard_camera();
    built_in.scope_name = camera::kSimulatedScope;
    built_in.provenance = {provenance::Origin::Simulated, ""};
    return built_in;
  }
  const fs::path file = cases::camera_file(case_folder);
  if (!fs::exists(file)) throw InvalidInput("the case has no camera.json: calibrate the camera first (F4)");
  return camera::read_camera_file(file);
}

tools::ToolSet tools_of(bool is_simulated, const fs::path& case_folder) {
  if (!uses_tools_file(is_simulated, case_folder)) return tools::standard_tools();
  tools::ToolSet tools = tools::read_tools_file(cases::tools_file(case_folder));
  // No outside tracker sees what is simulated.
  return is_simulated && tools.tracker ? tools::standard_tools() : tools;
}

CaseProvenance provenance_of(bool is_simulated, const fs::path& case_folder) {
  CaseProvenance all;
  all.camera = {provenance::Origin::Simulated, ""};
  if (!is_simulated || has_simulated_camera(case_folder)) {
    const fs::path file = cases::camera_file(case_folder);
    if (!fs::exists(file)) throw InvalidInput("the case has no camera.json: calibrate the camera first (F4)");
    all.camera = camera::read_camera_file(file).provenance;
  }
  for (const tools::Tool& tool : tools_of(is_simulated, case_folder).tools)
    all.tools.push_back({tool.name, tool.provenance, tool.nominal});
  return all;
}

std::string in_words(const provenance::Provenance& provenance, const std::string& now_utc, Dates dates) {
  using provenance::Origin;
  const std::string words(provenance::to_text(provenance.origin));
  if (provenance.origin == Origin::Nominal) return words;
  if (provenance.calibrated_utc.empty()) return words + ", date not known";
  const bool is_dated = provenance.origin == Origin::Measured;
  const std::string dated = is_dated ? words + " " + files::local_day(provenance.calibrated_utc) : words;
  // By the calendar: what was measured yesterday evening is a day old this morning.
  const auto days =
      provenance::days_between(files::local_day(provenance.calibrated_utc), files::local_day(now_utc));
  if (!days) return dated;
  const bool tells_date = is_dated && dates == Dates::Told;
  const std::string& how = tells_date ? dated : words;
  if (*days < 0) return how + ", date lies ahead: is the clock right?";
  if (*days == 0) return tells_date ? how : how + " today";
  return how + ", " + std::to_string(std::lround(*days)) + (*days == 1 ? " day old" : " days old");
}

std::string calibration_in_words(bool is_simulated, const fs::path& case_folder, const std::string& now_utc,
                                 Dates dates) {
  const CaseProvenance all = provenance_of(is_simulated, case_folder);
  const bool is_built_in =
      all.camera.origin == provenance::Origin::Simulated && all.camera.calibrated_utc.empty();
  const bool is_any_calibrated = std::ranges::any_of(all.tools, [](const NamedProvenance& tool) {
    return tool.provenance.origin != provenance::Origin::Nominal;
  });
  std::string words = is_built_in ? "camera built in" : "camera " + in_words(all.camera, now_utc, dates),
              nominal;
  if (!is_built_in)
    for (const std::string& doubt : camera::read_camera_doubts(cases::camera_file(case_folder)))
      words += ", NOT RELIABLE: " + doubt;
  const std::string unmeasured = dates == Dates::AsAge ? "not measured" : "nominal";
  if (!is_any_calibrated) return words + "; tools " + unmeasured;
  // Those of which the same is to be said stand together.
  std::vector<std::pair<std::string, std::string>> calibrated;  // in words, their names
  const auto add = [](std::string& names, const std::string& name) {
    names += (names.empty() ? "" : ", ") + name;
  };
  for (const NamedProvenance& tool : all.tools) {
    if (tool.provenance.origin == provenance::Origin::Nominal) {
      add(nominal, tool.name);
      continue;
    }
    const std::string how = in_words(tool.provenance, now_utc, dates);
    auto same = std::ranges::find(calibrated, how, &std::pair<std::string, std::string>::first);
    if (same == calibrated.end()) same = calibrated.insert(calibrated.end(), {how, ""});
    add(same->second, tool.name + but_not(tool.nominal));
  }
  // In short all of them are "tools" where the same is to be said of all.
  const bool are_alike = dates == Dates::AsAge && calibrated.size() == 1 && nominal.empty() &&
                         calibrated.front().second.find('(') == std::string::npos;
  for (const auto& [how, names] : calibrated) words += "; " + (are_alike ? "tools" : names) + " " + how;
  return nominal.empty() ? words : words + "; " + unmeasured + ": " + nominal;
}

bool has_real_camera(const fs::path& case_folder) {
  std::error_code ignored;
  return fs::exists(cases::camera_file(case_folder), ignored) && !has_simulated_camera(case_folder);
}

provenance::Origin origin_by_camera(bool is_simulated, const fs::path& case_folder) {
  const auto origin = [](bool is_real) {
    return is_real ? provenance::Origin::Measured : provenance::Origin::Simulated;
  };
  return provenance::found_with(origin(!is_simulated), origin(has_real_camera(case_folder)));
}

std::string camera_is_kept(bool is_simulated, const fs::path& case_folder) {
  return is_simulated && has_real_camera(case_folder)
             ? "this case has the calibration of a real scope; a simulated one does not replace it"
             : "";
}

std::string tools_are_kept(bool is_simulated, const fs::path& case_folder) {
  if (!is_simulated) return "";
  if (has_real_camera(case_folder)) return "this case has a real scope; what is simulated is no tool of it";
  const bool has_own = fs::exists(cases::tools_file(case_folder)) && !has_simulated_camera(case_folder);
  return has_own ? "this case has its own tools.json; what is simulated does not replace it" : "";
}

std::string camera_is_not_for_live(const fs::path& case_folder) {
  return has_simulated_camera(case_folder)
             ? "camera.json is of the simulated arthroscope: calibrate the real one first (F4)"
             : "";
}

std::string tools_are_not_for_live(const fs::path& case_folder) {
  const fs::path file = cases::tools_file(case_folder);
  if (!fs::exists(file)) return "";
  for (const tools::Tool& tool : tools::read_tools_file(file).tools)
    if (tool.provenance.origin == provenance::Origin::Simulated)
      return tool.name + ": was calibrated with the simulated arthroscope; calibrate the real tool (F4)";
  return "";
}

}  // namespace arthronaut::open_case
