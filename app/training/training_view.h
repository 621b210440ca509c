// Training: exercises on the simulator, driven by mouse, keyboard or gamepad, on the theatre's own screen,
// and what each was worth. An exercise runs as an operation does, and its record is a session of the open
// case; but it is a simulation wherever it is seen, nothing later rests on it, and none begins in a case that
// is somebody's (app/case/exercise_case.h). What else runs in the theatre is neither asked, ended nor wiped
// from here: an exercise that was replaced there is over, and said to be.
//
// The calibration of a camera is no operation: it takes nothing of the theatre's, runs on a thread of its own
// (training::BoardRun), and leaves no session.
//
// Pages: the exercises -> one that runs, on the theatre's screen -> its score -> the exercises.
#pragma once

#include <condition_variable>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "app/mode/mode.h"
#include "app/training/hand_devices.h"
#include "navigation/theatre/live_operation.h"
#include "navigation/training/board_run.h"
#include "navigation/training/exercise_run.h"
#include "navigation/training/score_file.h"
#include "navigation/worker/worker.h"

namespace arthronaut::training_mode {

// The theatre's screen, which this mode borrows while an exercise runs. The window puts the two together:
// modes do not know each other.
struct Theatre {
  mode::Mode* screen = nullptr;  // not null
  // Why no exercise on this bone can begin; empty: it can.
  std::function<std::string(bones::BoneKind bone)> refusal;
  // Begins with nothing known of what was done there before.
  std::function<void(const mode::OpenCase& opened)> begin_anew;
  // next_step: what the exercise asks of its trainee now; empty: what the operation asks.
  std::function<void(bones::BoneKind bone, theatre::TheatreSource source,
                     std::function<std::string()> next_step)>
      start;
  std::function<theatre::LiveStatePtr()> live;              // never null
  std::function<const operation::OperationSetup*()> setup;  // of the operation that was started; null: none
  std::function<void(operation::Command command)> ask;
  std::function<void()> end;
};

// Draws the taking of calibration pictures as Set up shows it, which the window hands over likewise; left
// free for the keys: so many pixels below the lens's dial, the place that is returned.
using DrawBoard = std::function<widgets::Rect(const widgets::Ui& ui, const widgets::Rect& area,
                                              const calibration::CalibrateStatus& status, float free_px)>;

// What the hand pushes now: written by the window, read by the simulator's thread.
class HandInbox {
 public:
  void set(const simulator::HandInput& input);
  void press(simulator::Press press);  // with the next picture that none was pressed for before
  // The simulator waits where it is, and its clock with it, until that is taken back or the end.
  void hold_up(bool on);
  void end();
  [[nodiscard]] simulator::Hand hand(const std::shared_ptr<HandInbox>& self) const;

 private:
  mutable std::mutex mutex_;
  mutable std::condition_variable goes_on_;
  simulator::HandInput input_;
  std::deque<simulator::Press> presses_;
  bool is_over_ = false, is_held_up_ = false;
};

enum class Page { List, Running, Score };

// A calibration as the window sees it.
struct BoardShown {
  calibration::CalibrateStatus job;
  training::ExerciseFacts facts;
  bool is_over = false;
};
using BoardWork = worker::Worker<int, BoardShown>;

class TrainingView : public mode::Mode {
 public:
  // scores: the file that the user's scores are kept in.
  TrainingView(Theatre theatre, DrawBoard draw_board, std::filesystem::path scores);

  [[nodiscard]] mode::ModeTitle title() const override;
  [[nodiscard]] bool works_read_only() const override { return false; }
  void add_actions(widgets::Actions& actions) override;
  [[nodiscard]] std::vector<std::string_view> action_prefixes() const override;
  [[nodiscard]] std::vector<mode::HeldKeys> held_keys() const override {
    return page_ == Page::Running ? keys_of_the_hands() : std::vector<mode::HeldKeys>();
  }
  void case_opened(const mode::OpenCase& opened) override;
  void enter() override;                 // reads the scores again
  void leave() override;                 // lets go of everything; a calibration is over
  void cover(bool is_covered) override;  // holds the exercise up
  void tick(double now_s) override;
  void draw(const widgets::Ui& ui, const widgets::Rect& area) override;
  [[nodiscard]] std::optional<widgets::Rect> header_in(const widgets::Ui& ui,
                                                       const widgets::Rect& window) const override;
  [[nodiscard]] bool is_busy() const override { return page_ == Page::Running; }
  [[nodiscard]] bool has_running_work() const override { return page_ == Page::Running; }
  [[nodiscard]] std::optional<sources::SourceKind> source_kind() const override;
  [[nodiscard]] std::string notice() const override { return notice_; }

 private:
  struct Run {
    training::ExerciseSetup setup;
    operation::SourceSetup source;  // what the theatre was given
    std::shared_ptr<training::ExerciseWatch> watch;
    std::shared_ptr<HandInbox> inbox;
    simulator::Held held = simulator::Held::Probe;
    bool is_prepared = false, is_ended = false;
    std::unique_ptr<BoardWork> board = nullptr;  // of a calibration, which is not the theatre's
  };
  void start();
  void start_board();
  void tick_board(double now_s);
  void add_board_actions(widgets::Actions& actions);
  [[nodiscard]] bool is_with_board() const { return run_ && run_->board != nullptr; }
  void prepare(const theatre::LiveState& live);
  void done();
  void stop(bool is_done);
  [[nodiscard]] bool is_another(const theatre::LiveState& live) const;  // precondition: run_
  void drop();
  [[nodiscard]] std::string refusal() const;  // why nothing can begin; empty: it can
  void take_score(const theatre::LiveState& live);
  void keep_score(const training::ExerciseFacts& facts, const std::string& knee, const std::string& session,
                  const std::string& failure);
  void push(double now_s);
  void read_scores();
  [[nodiscard]] std::uint64_t next_seed() const;
  [[nodiscard]] const training::Exercise& chosen() const { return training::exercises()[chosen_]; }
  [[nodiscard]] widgets::Rect strip_of(const widgets::Ui& ui, widgets::Rect& area) const;

  void draw_list(const widgets::Ui& ui, const widgets::Rect& area);
  void draw_history(const widgets::Ui& ui, const widgets::Rect& area) const;
  void draw_strip(const widgets::Ui& ui, const widgets::Rect& area) const;
  void draw_board(const widgets::Ui& ui, const widgets::Rect& area) const;
  void draw_score(const widgets::Ui& ui, const widgets::Rect& area);

  Theatre theatre_;
  DrawBoard draw_board_;
  std::filesystem::path scores_file_;
  std::optional<mode::OpenCase> opened_;
  std::string case_refusal_;  // by what the case holds
  Page page_ = Page::List;
  std::size_t chosen_ = 0;
  training::Level level_ = training::Level::Easy;
  std::vector<training::Score> scores_;
  std::optional<Run> run_;
  std::optional<training::Score> score_;  // of the exercise that was done last
  HandDevices devices_;
  std::string notice_;
  double last_push_s_ = 0;
  bool is_shown_ = false;
};

}  // namespace arthronaut::training_mode
