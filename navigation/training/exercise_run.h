// An exercise from its first picture to its score, without a window: somebody's hand, or a trainee made of
// numbers, in the operation as it is; and what the window needs to run one with the hand at its keys.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "navigation/theatre/navigate_source.h"
#include "navigation/theatre/operation_run.h"
#include "navigation/training/exercise_facts.h"
#include "navigation/training/score.h"

namespace arthronaut::training {

// Each way, of the standard scope's 1920 x 1080: 960 x 540 pictures.
inline constexpr double kPictureShare = 0.5;

struct ExerciseSetup {
  Exercise exercise;
  Level level = Level::Easy;
  phantom::PhantomKnee knee;
  tunnels::Tunnel plan;
  std::uint64_t seed = 1;
  double plan_length_mm = 0;  // inside bone; 0: it is measured
};
// An exercise that runs, watched: every frame's state beside its truth. Shared by the thread that takes the
// frames and whoever shows it; every member may be called from any thread.
class ExerciseWatch {
 public:
  explicit ExerciseWatch(const ExerciseSetup& setup);
  // Of each frame, in order.
  void add(const operation::OperationState& state);
  void finish();  // the trainee says that it is done
  // The state is of this exercise's own source, which is a simulation; false before its first frame.
  [[nodiscard]] bool is_of(const operation::OperationState& state) const;
  [[nodiscard]] bool has_begun() const;  // a frame came
  [[nodiscard]] ExerciseFacts facts() const;
  [[nodiscard]] const std::shared_ptr<simulator::HandLog>& log() const { return log_; }

 private:
  mutable std::mutex mutex_;
  Examiner examiner_;
  std::shared_ptr<const operation::SourceSetup> source_;  // of its frames; null before the first
  std::shared_ptr<simulator::HandLog> log_ = std::make_shared<simulator::HandLog>();
};

// Of the built-in knee of that seed, with its anatomical plan.
[[nodiscard]] ExerciseSetup standard_setup(const Exercise& exercise, Level level, std::uint64_t seed);

// The source, driven by `hand`; what was true goes to the watch's log. Its pictures are of the standard scope
// and tools, in saline, and it is a simulation wherever it is shown or kept.
[[nodiscard]] theatre::TheatreSource exercise_source(const ExerciseSetup& setup, const simulator::Hand& hand,
                                                     const std::shared_ptr<ExerciseWatch>& watch,
                                                     bool in_real_time);

// Where the bone lies, known beforehand, for what begins there (Aim): the truth of the log's first frame.
[[nodiscard]] registration::RegistrationSummary known_registration(const simulator::HandTruth& truth);
[[nodiscard]] bool begins_registered(const Exercise& exercise);
// What a press asks of the operation; none for those that are not its commands. depth_mm: how deep the
// drill is, which the surgeon reads off its stop before he says that the tunnel is drilled.
[[nodiscard]] std::vector<operation::Command> commands_of(simulator::Press press, double depth_mm);

struct ExerciseOutcome {
  ExerciseFacts facts;
  Score score;
  std::vector<simulator::HandTruth> frames;
};
// Deterministic for a setup and a hand that is. `on_frame` may be empty. Throws InvalidInput where the knee
// offers no place for the scope, or where the calibration of a camera is to be recorded, which is no
// operation (board_run.h); IoError when the record cannot be begun.
[[nodiscard]] ExerciseOutcome run_exercise(const ExerciseSetup& setup, const simulator::Hand& hand,
                                           const theatre::RecordOptions& record = {},
                                           const std::function<void(long frames)>& on_frame = {});

}  // namespace arthronaut::training
