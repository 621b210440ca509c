// The camera and the tools that the pictures of a case are tracked with: what Set up adopted, or what is
// built in. Navigate asks here too, so that both mean the same.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "navigation/camera/camera_file.h"
#include "navigation/provenance/provenance.h"
#include "navigation/tools/tool_set.h"

namespace arthronaut::open_case {

// Pictures of a real scope are tracked with the case's camera.json; those of the simulated arthroscope with
// its own camera, unless the case has adopted a calibration of it. Throws InvalidInput or IoError.
[[nodiscard]] camera::Calibration camera_of(bool is_simulated, const std::filesystem::path& case_folder);
// The same, with what else is known of it.
[[nodiscard]] camera::CalibrationRecord camera_record_of(bool is_simulated,
                                                         const std::filesystem::path& case_folder);
// The case's tools.json, or the standard tools where it has none. What the simulated arthroscope shows are
// the standard tools: a tools.json that stands beside a real scope's camera.json is not of them. Throws
// InvalidInput or IoError.
[[nodiscard]] tools::ToolSet tools_of(bool is_simulated, const std::filesystem::path& case_folder);
// Where the numbers come from: of camera_of() and of each tool of tools_of(). What is built in is nominal,
// but for the simulated arthroscope's own camera, which is simulated. Throws as those.
struct NamedProvenance {
  std::string name;  // of the tool
  provenance::Provenance provenance;
  tools::NominalParts nominal = {};
};
struct CaseProvenance {
  provenance::Provenance camera;
  std::vector<NamedProvenance> tools;
};
[[nodiscard]] CaseProvenance provenance_of(bool is_simulated, const std::filesystem::path& case_folder);
// How old something is says what its date does, in fewer letters.
enum class Dates { Told, AsAge };
// For the screen, at this time (ISO 8601): "measured 2026-11-21", from the next day on "measured 2026-11-21,
// 3 days old"; "nominal"; "simulated, 3 days old"; AsAge: "measured today", "measured, 3 days old". A
// measurement without a date says that it has none.
[[nodiscard]] std::string in_words(const provenance::Provenance& provenance, const std::string& now_utc,
                                   Dates dates = Dates::Told);
// All of it for the screen: "camera measured 2026-11-21; probe measured 2026-11-21; nominal: femoral guide";
// "camera built in; tools nominal"; AsAge: "not measured" in the place of "nominal". Throws as those.
[[nodiscard]] std::string calibration_in_words(bool is_simulated, const std::filesystem::path& case_folder,
                                               const std::string& now_utc, Dates dates = Dates::Told);

// The case has the calibration of a real scope: its camera.json is not of the simulator. One that can't be
// read counts as real; it is not replaced by something simulated.
[[nodiscard]] bool has_real_camera(const std::filesystem::path& case_folder);
// Of what is found in pictures by means of the case's camera: simulated as soon as one of both is.
[[nodiscard]] provenance::Origin origin_by_camera(bool is_simulated,
                                                  const std::filesystem::path& case_folder);

// Why what was found with simulated pictures, or by means of a simulated camera, may not replace the files of
// this case: those are of a real scope or tool. Empty when it may.
[[nodiscard]] std::string camera_is_kept(bool is_simulated, const std::filesystem::path& case_folder);
[[nodiscard]] std::string tools_are_kept(bool is_simulated, const std::filesystem::path& case_folder);

// Why the pictures of a live camera can't be measured with this case's camera.json: it is of the simulator.
// Empty when they can, or when there is none (then camera_of() throws).
[[nodiscard]] std::string camera_is_not_for_live(const std::filesystem::path& case_folder);
// The same of tools.json: names the first tool that was calibrated with the simulator.
[[nodiscard]] std::string tools_are_not_for_live(const std::filesystem::path& case_folder);

}  // namespace arthronaut::open_case
