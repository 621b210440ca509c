// Whether the error that the screen predicts is the error there is. Whole operations without pictures, on the
// phantom: a scripted surgeon draws with a probe whose tip is not where the file says, through a camera that
// is not quite the one that was calibrated; the strokes are registered as in theatre, and a guide whose axis
// is off is led to the plan. What navigation then says is compared with what is true.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <vector>

namespace arthronaut::experiments {

// Half of the operations have each; every fourth has both.
enum class Setup { Careful, PoorTools, PoorCamera, PoorBoth };
[[nodiscard]] const char* to_text(Setup setup);

struct PredictedErrorOptions {
  int operation_count = 100;
  std::uint64_t seed = 1;
  double corner_sigma_px = 0.15;  // error of each corner of a marker, each coordinate, each frame
};

struct OperationError {
  Setup setup = Setup::Careful;
  bool is_reliable = false;  // by the registration's own verdict
  // Length of the error of the offset across the plan; angle between the guide's axis as said and as it is.
  double offset_mm = 0, angle_deg = 0;
  double predicted_offset_mm = 0, predicted_angle_deg = 0;
  // The same prediction without what tools and camera add.
  double plain_offset_mm = 0, plain_angle_deg = 0;
  // Of the tip as it touches the bone in the last frame of the strokes, in the world's frame.
  double tip_mm = 0, predicted_tip_mm = 0;
};

// Medians of error over prediction.
struct ErrorRatios {
  int count = 0;
  double offset = 0, angle = 0, tip = 0, plain_offset = 0, plain_angle = 0;
  double median_offset_mm = 0, median_angle_deg = 0;  // of the errors
  // The share of operations whose error is above twice the prediction.
  double offset_above_two = 0, angle_above_two = 0;
};

struct PredictedErrorResult {
  std::vector<OperationError> operations;
  [[nodiscard]] ErrorRatios all() const;
  [[nodiscard]] ErrorRatios of(Setup setup) const;
};

// Deterministic for a seed. Throws InvalidInput when an option is not above 0. An operation whose strokes
// give no pose at all counts as infinitely wrong.
[[nodiscard]] PredictedErrorResult run_predicted_error(const PredictedErrorOptions& options,
                                                       const std::function<void(int)>& progress = {});

// One row an operation. Atomic; IoError.
void write_predicted_error_table(const std::filesystem::path& file, const PredictedErrorResult& result);

}  // namespace arthronaut::experiments
