// The first case: a short way through plan mode on the built-in knee, one thing after the other. Each step is
// done when the plan, the view or the case is so, not when a button was pressed; what is so already is
// passed. It can be left at any time and taken up again, and it never asks for an answer.
//
// How far it came is kept with the user's data, as the recent cases are.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>

#include "planning/bones/bone.h"
#include "planning/tunnels/tunnel.h"

namespace arthronaut::plan {

enum class TourStep { Look, Landmarks, DefaultPlan, Move, Checks, TakeBack, Keep, Theatre };
inline constexpr int kTourStepCount = 8;

// What plan mode is like, as far as the tour asks.
struct TourFacts {
  Eigen::Vector3d view_direction = Eigen::Vector3d::UnitY();  // of the camera, unit
  // The bone whose landmarks are shown in the panel, or whose checks are; neither where the panel shows else.
  std::optional<bones::BoneKind> landmarks_shown, checks_shown;
  // Bones of which a landmark that grids follow from is a proposal.
  std::set<bones::BoneKind> unconfirmed;
  std::map<bones::BoneKind, tunnels::Tunnel> tunnels;
  // As the default would be now; those bones that have one.
  std::map<bones::BoneKind, tunnels::Tunnel> defaults;
  std::set<bones::BoneKind> wrong;  // with a check that says so
  bool can_redo = false, is_saved = true;
  std::size_t kept_versions = 0;
};

struct TourCard {
  std::string title, text;  // "Turn the knee", what to do and with which key
  int number = 0;           // of kTourStepCount, from 1; 0: the offer
};

class Tour {
 public:
  // file: where it is kept; see tour_file(). One that cannot be read is none.
  explicit Tour(std::filesystem::path file);

  // Another case: the tour is of the built-in knee alone, and waits while another one is open.
  void case_opened(bool is_built_in);
  void begin();              // from where it was left, from the start after its end
  void begin_when_opened();  // the built-in knee, as the next case
  void leave();              // the offer, too: it is then not made again
  void plan_mode_left();     // the last step leads out of it, and is then done
  // Once a frame: goes on when the step is done.
  void follow(const TourFacts& facts);

  [[nodiscard]] bool is_possible() const { return is_built_in_; }
  [[nodiscard]] bool is_running() const { return is_built_in_ && state_ == State::Running; }
  [[nodiscard]] bool is_offered() const { return is_built_in_ && state_ == State::Offered; }
  [[nodiscard]] TourStep step() const { return step_; }
  // What the tour needs to know now: the default plan costs a moment.
  [[nodiscard]] bool wants_defaults() const { return is_running() && step_ == TourStep::DefaultPlan; }
  // Nothing where it neither runs nor is offered.
  [[nodiscard]] std::optional<TourCard> card() const;

 private:
  enum class State { Offered, Running, Left, Done };
  void go_to(TourStep step);
  void see(const TourFacts& facts);
  [[nodiscard]] bool is_done(const TourFacts& facts) const;
  void load();
  void save() const noexcept;

  std::filesystem::path file_;
  State state_ = State::Offered;
  TourStep step_ = TourStep::Look;
  bool is_built_in_ = false, begins_when_opened_ = false;
  std::optional<TourFacts> at_begin_;                       // of the step
  std::set<bones::BoneKind> landmarks_seen_, checks_seen_;  // in this step
};

// Beside the built-in case: $XDG_DATA_HOME/arthronaut/tour.json, else ~/.local/share/...
[[nodiscard]] std::filesystem::path tour_file();

}  // namespace arthronaut::plan
