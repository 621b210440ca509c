// The paper's first experiment: two markers on a ruler, seen in fluid while the lens turns. Their relative
// pose is known, so that its error shows what following the lens, and the fluid's model, are worth.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "navigation/calibration/ruler.h"
#include "navigation/camera/camera_model.h"
#include "navigation/sources/frame_source.h"

namespace arthronaut::experiments {

struct RulerInFluid {
  calibration::Ruler ruler;
  double refractive_index = 1.3345;  // of the fluid it was seen in
};
// A file of format "arthronaut-acceptance.ruler": {"markers": [a, b], "size_mm", "marker<a>_from_marker<b>",
// "medium"}. Throws IoError or InvalidInput.
[[nodiscard]] RulerInFluid read_ruler_file(const std::filesystem::path& file);

// How the camera is taken to behave.
enum class LensMode {
  Following,     // intrinsics follow the lens, exact port
  NotFollowing,  // intrinsics stay where they were calibrated
  FocalRule,     // intrinsics follow the lens, fluid by the paper's rule: focal length times index
};
inline constexpr std::array kLensModes{LensMode::Following, LensMode::NotFollowing, LensMode::FocalRule};
[[nodiscard]] std::string_view to_text(LensMode mode);

struct RulerError {
  double translation_mm = 0;
  double rotation_deg = 0;
};

struct LensRotationFrame {
  std::int64_t index = 0;
  std::optional<double> lens_angle_deg;             // as measured, empty while the mark is not known
  std::array<std::optional<RulerError>, 3> errors;  // by LensMode; empty: not both markers had a pose
};

struct LensModeSummary {
  int frame_count = 0;  // with both markers
  double median_mm = 0, p95_mm = 0, median_deg = 0, p95_deg = 0;
};

struct LensRotationResult {
  std::vector<LensRotationFrame> frames;
  std::array<LensModeSummary, 3> modes;  // by LensMode
  double rotation_deg = 0;               // from the least to the greatest lens angle
};

// Progress: called with the number of frames done. Throws what the source throws, InvalidInput for a camera
// that is not of the frames' size.
[[nodiscard]] LensRotationResult run_lens_rotation(sources::FrameSource& source,
                                                   const camera::Calibration& camera,
                                                   const RulerInFluid& seen,
                                                   const std::function<void(int)>& progress = {});

// The simulator's own: a camera calibrated from the simulator's stills, then `frame_count` frames of its
// ruler.
struct SimulatedLensRotation {
  camera::Calibration calibrated;
  camera::Calibration truth;
  LensRotationResult result;
};
[[nodiscard]] SimulatedLensRotation simulate_lens_rotation(int frame_count, std::uint64_t seed,
                                                           const std::function<void(int)>& progress = {});

// The paper's plot: errors over frames, the lens's rotation under them. And the figures behind it. Atomic;
// IoError.
void write_lens_rotation_plot(const std::filesystem::path& file, const LensRotationResult& result,
                              const std::string& title);
void write_lens_rotation_table(const std::filesystem::path& file, const LensRotationResult& result);

}  // namespace arthronaut::experiments
