#include "navigation/calibration/fluid_file.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "navigation/camera/medium.h"
#include "planning/files/json_document.h"
#include "planning/geometry/error.h"

namespace arthronaut::calibration {

namespace {

constexpr std::string_view kFormat = "arthronaut.fluid";
constexpr int kVersion = 1;

double read_medium(const files::JsonObject& root) {
  try {
    return camera::refractive_index_from_text(root.text("medium"));
  } catch (const InvalidInput&) {
    root.fail("medium", "must be air, water, saline or a refractive index in quotes");
  }
}

}  // namespace

FluidRecord record_of(const FluidCheckSummary& summary, double refractive_index) {
  FluidRecord record;
  record.refractive_index = refractive_index;
  record.is_trusted = summary.is_trusted();
  record.reasons = summary.reasons;
  record.best_index = summary.best_index;
  record.index_sigma = summary.index_sigma;
  record.frame_count = summary.frame_count;
  for (const FluidCheckSummary::Row& row : summary.rows)
    if (row.hypothesis == FluidHypothesis::FlatPort) {
      record.median_mm = row.median_mm;
      record.median_deg = row.median_deg;
    }
  return record;
}

FluidRecord read_fluid_file(const std::filesystem::path& file) {
  const files::JsonObject root = files::read_json(file, kFormat, kVersion);
  FluidRecord record;
  record.refractive_index = read_medium(root);
  record.is_trusted = root.boolean("trusted");
  record.reasons = root.texts("reasons");
  if (record.is_trusted != record.reasons.empty())
    root.fail("reasons", "must be empty when the verdict is trusted, and say why when it is not");
  record.best_index = root.number("best_index");
  record.index_sigma = root.number("index_sigma");
  record.median_mm = root.number("median_mm");
  record.median_deg = root.number("median_deg");
  const std::int64_t frames = root.integer("frame_count");
  if (frames < 0) root.fail("frame_count", "must not be negative");
  record.frame_count = static_cast<std::size_t>(frames);
  record.source = root.text("source");
  record.provenance = provenance::read_provenance(root, provenance::Origin::Measured);
  record.camera_sha256 = root.text("camera_sha256");
  return record;
}

void write_fluid_file(const std::filesystem::path& file, const FluidRecord& record) {
  nlohmann::ordered_json json = {
      {"format", kFormat},
      {"version", kVersion},
      {"medium", camera::medium_to_text(record.refractive_index)},
      {"trusted", record.is_trusted},
      {"reasons", record.reasons},
      {"best_index", record.best_index},
      {"index_sigma", record.index_sigma},
      {"median_mm", record.median_mm},
      {"median_deg", record.median_deg},
      {"frame_count", record.frame_count},
      {"source", record.source},
      {"origin", provenance::to_text(record.provenance.origin)},
      {"camera_sha256", record.camera_sha256},
  };
  if (!record.provenance.calibrated_utc.empty()) json["calibrated_utc"] = record.provenance.calibrated_utc;
  files::write_json(file, json);
}

}  // namespace arthronaut::calibration
