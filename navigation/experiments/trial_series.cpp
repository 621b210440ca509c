#include "navigation/experiments/trial_series.h"

#include <nlohmann/json.hpp>

#include "planning/bones/mesh_file.h"
#include "planning/files/json_document.h"
#include "planning/geometry/error.h"

namespace arthronaut::experiments {

TrialSeries::TrialSeries(const geometry::TriangleMesh& mesh, const TrialSeriesOptions& options)
    : mesh_(mesh), surface_(mesh), options_(options) {
  const auto area =
      options.area_center_mm ? options.area_center_mm : find_lateral_notch_wall(mesh, surface_, options.side);
  if (!area) throw InvalidInput("this bone shows no notch: name the middle of the area to digitise");
  target_mm_ = surface_.closest_point(*area).point_mm;
}

Trial TrialSeries::make(int trial) const {
  return make_trial(mesh_, surface_, target_mm_, setting_of(options_.noise), seed_of(trial));
}

void write_trials(const std::filesystem::path& folder, const TrialSeries& series, int trial_count) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw IoError(folder.string() + ": " + error.message());
  bones::write_mesh_ply(folder / "bone.ply", series.mesh());
  for (int k = 0; k < trial_count; ++k) {
    const Trial trial = series.make(k);
    const std::string name = "trial_" + std::to_string(k);
    strokes::write_curves_file(folder / (name + ".csv"), trial.curves);
    nlohmann::ordered_json document;
    document["format"] = "arthronaut.trial";
    document["version"] = 1;
    document["marker_from_bone"] = files::to_json(trial.marker_from_bone);
    document["target_mm"] = files::to_json(series.target_mm());
    document["noise"] = to_text(series.noise());
    document["seed"] = series.seed_of(k);
    files::write_json(folder / (name + ".json"), document);
  }
}

}  // namespace arthronaut::experiments
