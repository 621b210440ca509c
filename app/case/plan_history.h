// A key's whole way to the plan: a mode makes a PlanEdit of it and hands it over here; the history puts it
// into the model, keeps the plan before it for undo, and saves.
//
// Edits that follow each other as one movement (a drag, a key held down) are one step, saved when the hand
// rests. After every step, undo and redo the plan on disk is the model's, so that a crash resumes there. Two
// things stand against that, and the status says which: a case that another program has open is read-only,
// every edit is refused; a plan.json that another program has changed meanwhile is not written over: the
// model keeps its plan, edits go on in memory, and the surgeon chooses by take_theirs() or keep_ours().
//
// GUI-free. One thread.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "app/case/plan_edit.h"
#include "app/case/plan_model.h"
#include "planning/cases/step_history.h"

namespace arthronaut::open_case {

class PlanHistory {
 public:
  // Another case. Its steps are kept with it (cases/step_history.h): they are there again whenever it is
  // opened as it was left, also after the program was killed; where anything of it was changed elsewhere,
  // or they cannot be read, there are none, and the status says so. The model outlives this history's use of
  // it; null closes. read_only: why nothing may be changed; empty where it may.
  void open(PlanModel* model, const std::filesystem::path& case_folder, const std::string& read_only = {});
  [[nodiscard]] const PlanModel* model() const { return model_; }  // null while no case is open
  [[nodiscard]] bool is_read_only() const { return is_read_only_; }

  // An edit that changes nothing is no step.
  void apply(const PlanEdit& edit, double now_s);
  // Several tunnels at once, as one step: a default plan.
  void apply_tunnels(const std::map<tunnels::TunnelKey, tunnels::Tunnel>& tunnels, const std::string& what);
  // Another plan as a whole, with the meshes that it names, as one step: a version that was kept.
  void apply_plan(const cases::Plan& plan, const std::string& what);
  // A bone's landmarks become these. continues: belongs to the step before it, as a drag does.
  void apply_landmarks(bones::BoneKind bone, const landmarks::Landmarks& landmarks,
                       const landmarks::LandmarkStates& states, const std::string& what, bool continues,
                       double now_s);
  // What was measured becomes this list, as one step, saved at once.
  void apply_measurements(const std::vector<cases::Measurement>& measurements, const std::string& what);
  // Without effect when there is nothing to undo or redo.
  void undo();
  void redo();
  [[nodiscard]] bool can_undo() const { return position_ > 0; }
  [[nodiscard]] bool can_redo() const { return position_ < steps_.size(); }

  // Ends a movement that has rested for half a second, which saves it; never one that is held, which goes on
  // however long the hand, or a machine under load, pauses.
  void settle(double now_s, bool is_held = false);
  void settle_now();
  // The same, and what could not be saved is tried again. Why the disk holds another plan than the model by
  // now; empty where it is the model's. PlanModel::save_now() is this.
  std::string save_now();
  [[nodiscard]] bool is_moving() const { return is_moving_; }

  // Whether another program has saved a plan: looks at plan.json, at most once a second. What could not be
  // saved is tried again every three. For every frame.
  void look_at_disk(double now_s);
  [[nodiscard]] bool is_in_conflict() const { return status_.save == PlanStatus::Save::Conflict; }
  // How the other program's plan differs from the model's, a tunnel each: "femur: entry 2.1 mm off, 0.5 mm
  // wider". Empty without a conflict, and where its plan cannot be read.
  [[nodiscard]] std::string theirs_in_words() const;
  // The end of a conflict; without effect where there is none. Theirs comes into the model, as a step that
  // undo takes back; ours is written over theirs. A plan.json that cannot be read leaves the conflict, with
  // the reason.
  void take_theirs();
  void keep_ours();

  // What was done, the oldest first, and how many of these are not undone: the list that a screen shows.
  [[nodiscard]] std::size_t step_count() const { return steps_.size(); }
  [[nodiscard]] std::size_t position() const { return position_; }
  // Precondition: step < step_count().
  [[nodiscard]] const std::string& step_name(std::size_t step) const { return steps_[step].what; }
  // Whose tunnels or landmarks it changed. Precondition: as above.
  [[nodiscard]] std::set<bones::BoneKind> bones_of(std::size_t step) const;
  // Undoes or redoes until so many steps are done; at most step_count().
  void go_to(std::size_t position);
  [[nodiscard]] const PlanStatus& status() const { return status_; }

 private:
  using State = cases::PlanState;
  void take_up_steps();
  void keep_steps();
  [[nodiscard]] State state() const;
  void put(const State& state);
  [[nodiscard]] bool is_saved_beside_plan(const State& now) const;
  // Before and after a change: begins a step, or goes on with the one that is moving.
  void begin(const std::string& what, bool continues);
  void add_step(const std::string& what);
  void moved(double now_s);
  void save();
  void set_conflict();
  [[nodiscard]] bool is_changed_on_disk() const;
  void read_theirs();
  void describe();

  PlanModel* model_ = nullptr;
  std::filesystem::path case_folder_;
  State saved_;                        // what is on disk, but for the plan
  std::string version_;                // of the plan on disk that the model's was made from
  std::optional<cases::Plan> theirs_;  // the other program's in a conflict, where it can be read
  bool is_read_only_ = false;
  std::vector<cases::PlanStep> steps_;
  std::size_t position_ = 0;    // steps_[0, position_) are done
  std::string steps_not_kept_;  // why; empty: they are
  bool is_moving_ = false;      // the last step is still going on
  double moved_at_s_ = 0, looked_at_s_ = 0;
  PlanStatus status_;
};

}  // namespace arthronaut::open_case
