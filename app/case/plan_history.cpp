#include "app/case/plan_history.h"

#include <algorithm>
#include <map>
#include <utility>

#include "planning/cases/plan_file.h"
#include "planning/cases/plan_versions.h"
#include "planning/files/local_time.h"
#include "planning/files/utc_clock.h"
#include "planning/geometry/error.h"

namespace arthronaut::open_case {

namespace {

constexpr double kRest_s = 0.5, kLookEvery_s = 1.0, kTryAgainEvery_s = 3.0;

bool is_same(const std::optional<tunnels::Tunnel>& a, const std::optional<tunnels::Tunnel>& b) {
  if (!a || !b) return !a && !b;
  return cases::is_same_tunnel(*a, *b);
}

}  // namespace

void PlanHistory::open(PlanModel* model, const std::filesystem::path& case_folder,
                       const std::string& read_only) {
  *this = PlanHistory();
  model_ = model;
  case_folder_ = case_folder;
  if (model != nullptr) {
    model->set_saver([this, model] { return model_ == model ? save_now() : std::string(); });
    version_ = model->knee().plan_version;
    saved_ = state();
    // What was proposed on opening goes to disk with the first change: whoever reads the case, as a report,
    // has the grid and the checks that were planned by.
    std::erase_if(saved_.landmarks,
                  [&](const auto& of) { return model->has_bone(of.first) && model->was_proposed(of.first); });
  }
  is_read_only_ = !read_only.empty();
  if (is_read_only_) {
    status_.save = PlanStatus::Save::ReadOnly;
    status_.text = "not to be changed: the case " + read_only;
  } else if (model != nullptr) {
    take_up_steps();
  }
}

void PlanHistory::take_up_steps() {
  try {  // a file of the case, of which nothing but the steps is lost
    cases::StepHistory kept = cases::load_step_history(case_folder_);
    if (kept.steps.empty()) return;
    const auto position = kept.position_of(state());
    if (!position || kept.side != model_->knee().side) {
      status_.text = "saved; the case was changed elsewhere since: what was done before cannot be taken back";
      return;
    }
    steps_ = std::move(kept.steps);
    position_ = *position;
    describe();
  } catch (const std::runtime_error& error) {
    status_.text = std::string("saved; what was done before cannot be taken back: ") + error.what();
  }
}

// Before the plan is saved: whatever comes between the two, it is the plan of one of the steps.
void PlanHistory::keep_steps() {
  steps_not_kept_.clear();
  try {
    cases::save_step_history(case_folder_, {steps_, position_, model_->knee().side});
  } catch (const std::runtime_error& error) {  // what counts is the plan
    steps_not_kept_ = error.what();
  }
}

void PlanHistory::begin(const std::string& what, bool continues) {
  if (is_moving_ && (!continues || what != steps_.back().what)) settle_now();
  if (is_moving_) return;
  add_step(what);
  is_moving_ = true;
}

void PlanHistory::add_step(const std::string& what) {
  steps_.resize(position_);  // what was undone can't be redone after a new step
  if (steps_.size() == cases::kMostSteps) steps_.erase(steps_.begin());
  steps_.push_back({what, state(), {}});
  position_ = steps_.size();
}

void PlanHistory::moved(double now_s) {
  steps_.back().after = state();
  moved_at_s_ = now_s;
  if (!is_in_conflict()) {
    status_.save = PlanStatus::Save::NotYet;
    status_.text = "not saved yet";
  }
  describe();
}

void PlanHistory::apply(const PlanEdit& edit, double now_s) {
  if (model_ == nullptr || is_read_only_ || is_same(model_->tunnel(edit.key), edit.tunnel)) return;
  begin(edit.what, edit.continues);
  model_->set_tunnel(edit.key, edit.tunnel);
  moved(now_s);
}

void PlanHistory::apply_landmarks(bones::BoneKind bone, const landmarks::Landmarks& landmarks,
                                  const landmarks::LandmarkStates& states, const std::string& what,
                                  bool continues, double now_s) {
  if (model_ == nullptr || is_read_only_) return;
  if (landmarks == model_->landmarks(bone) && states == model_->landmark_states(bone)) return;
  begin(what, continues);
  model_->set_landmarks(bone, landmarks, states);
  moved(now_s);
}

void PlanHistory::apply_tunnels(const std::map<tunnels::TunnelKey, tunnels::Tunnel>& tunnels,
                                const std::string& what) {
  if (model_ == nullptr || is_read_only_) return;
  if (std::all_of(tunnels.begin(), tunnels.end(),
                  [&](const auto& one) { return is_same(model_->tunnel(one.first), one.second); }))
    return;
  settle_now();
  begin(what, false);
  for (const auto& [key, tunnel] : tunnels) model_->set_tunnel(key, tunnel);
  moved(moved_at_s_);
  settle_now();
}

void PlanHistory::apply_plan(const cases::Plan& plan, const std::string& what) {
  if (model_ == nullptr || is_read_only_ || cases::is_same_plan(model_->knee().plan, plan)) return;
  settle_now();
  begin(what, false);
  model_->set_plan(plan);
  moved(moved_at_s_);
  settle_now();
}

void PlanHistory::apply_measurements(const std::vector<cases::Measurement>& measurements,
                                     const std::string& what) {
  if (model_ == nullptr || is_read_only_ || measurements == model_->measurements()) return;
  settle_now();
  add_step(what);
  model_->set_measurements(measurements);
  steps_.back().after = state();
  save();
  describe();
}

PlanHistory::State PlanHistory::state() const {
  return {model_->knee().plan, model_->measurements(), model_->knee().landmarks,
          model_->knee().landmark_states};
}

void PlanHistory::put(const State& state) {
  model_->set_plan(state.plan);
  model_->set_measurements(state.measurements);
  for (const auto& [bone, landmarks] : state.landmarks) {
    const auto& states = state.landmark_states.at(bone);
    if (landmarks != model_->landmarks(bone) || states != model_->landmark_states(bone))
      model_->set_landmarks(bone, landmarks, states);
  }
}

void PlanHistory::undo() {
  settle_now();
  if (!can_undo()) return;
  put(steps_[--position_].before);
  save();
  describe();
}

void PlanHistory::redo() {
  settle_now();
  if (!can_redo()) return;
  put(steps_[position_++].after);
  save();
  describe();
}

void PlanHistory::settle(double now_s, bool is_held) {
  if (!is_held && now_s - moved_at_s_ > kRest_s) settle_now();
}

void PlanHistory::settle_now() {
  if (std::exchange(is_moving_, false)) save();
}

std::string PlanHistory::save_now() {
  settle_now();
  if (status_.save == PlanStatus::Save::Failed) save();
  // What another program saved within the last second is not noticed yet.
  std::error_code none;
  if (!is_read_only_ && !is_in_conflict() && std::filesystem::is_directory(case_folder_, none) &&
      is_changed_on_disk())
    set_conflict();
  const bool is_saved = status_.save == PlanStatus::Save::Saved || status_.save == PlanStatus::Save::ReadOnly;
  return is_saved ? std::string() : status_.text;
}

void PlanHistory::describe() {
  status_.undo_what = can_undo() ? steps_[position_ - 1].what : "";
  status_.redo_what = can_redo() ? steps_[position_].what : "";
}

std::set<bones::BoneKind> PlanHistory::bones_of(std::size_t step) const {
  std::set<bones::BoneKind> changed;
  for (const auto bone : {bones::BoneKind::Femur, bones::BoneKind::Tibia}) {
    const auto on_bone = [bone](State of) {
      of.measurements.clear();
      const auto is_of_other_tunnel = [&](const auto& one) { return one.first.bone != bone; };
      std::erase_if(of.plan.tunnels, is_of_other_tunnel);
      std::erase_if(of.plan.mesh_sha256, is_of_other_tunnel);
      const auto is_of_other = [&](const auto& one) { return one.first != bone; };
      std::erase_if(of.landmarks, is_of_other);
      std::erase_if(of.landmark_states, is_of_other);
      return of;
    };
    if (!(on_bone(steps_[step].before) == on_bone(steps_[step].after))) changed.insert(bone);
  }
  return changed;
}

void PlanHistory::go_to(std::size_t position) {
  settle_now();
  position = std::min(position, steps_.size());
  if (position == position_ || model_ == nullptr) return;
  put(position < position_ ? steps_[position].before : steps_[position - 1].after);
  position_ = position;
  save();
  describe();
}

void PlanHistory::look_at_disk(double now_s) {
  const bool has_failed = status_.save == PlanStatus::Save::Failed;
  if (model_ == nullptr || is_read_only_ ||
      now_s - looked_at_s_ < (has_failed ? kTryAgainEvery_s : kLookEvery_s))
    return;
  looked_at_s_ = now_s;
  if (is_in_conflict()) return read_theirs();  // it may be saved again
  if (has_failed) return save();               // there may be room again, or the share is back
  std::error_code error;
  if (!std::filesystem::is_directory(case_folder_, error))
    return;  // one that is gone is told by the next save
  if (is_changed_on_disk()) set_conflict();
}

bool PlanHistory::is_changed_on_disk() const {
  try {
    return cases::plan_version(case_folder_) != version_;
  } catch (const std::runtime_error&) {  // a share that is away for a moment: told by the next save
    return false;
  }
}

void PlanHistory::set_conflict() {
  status_.save = PlanStatus::Save::Conflict;
  status_.text = "another program has saved another plan: take it, or keep this one";
  read_theirs();
}

void PlanHistory::read_theirs() {
  try {
    cases::Case there;
    cases::read_plan(case_folder_, there);
    theirs_ = there.plan;
  } catch (const std::exception&) {  // said when somebody takes it
    theirs_.reset();
  }
}

std::string PlanHistory::theirs_in_words() const {
  if (!is_in_conflict() || !theirs_) return {};
  std::string words;
  for (const cases::TunnelDifference& tunnel : cases::compare_plans(model_->knee().plan, *theirs_)) {
    if (tunnel.kind == cases::TunnelDifference::Kind::Same) continue;
    words += (words.empty() ? "" : "; ") + tunnel.in_words();
  }
  return words.empty() ? "the tunnels are the same" : words;
}

void PlanHistory::take_theirs() {
  if (!is_in_conflict()) return;
  is_moving_ = false;  // what was moving stays a step, and is not written
  try {
    const cases::Case there = cases::load_case(case_folder_);
    add_step("Take the plan of the other program");
    model_->set_plan(there.plan);
    steps_.back().after = state();
    keep_steps();
    version_ = there.plan_version;
    status_.save = PlanStatus::Save::Saved;
    status_.text = "as the other program saved it";
    describe();
    // What is no plan could not be saved beside the other one.
    if (!is_saved_beside_plan(steps_.back().after)) save();
  } catch (const std::exception& error) {  // a file of another program: whatever is wrong with it is said
    status_.text = std::string("the other program's plan cannot be read: ") + error.what();
  }
}

void PlanHistory::keep_ours() {
  if (!is_in_conflict()) return;
  is_moving_ = false;
  try {
    version_ = cases::plan_version(case_folder_);
  } catch (const std::runtime_error& error) {
    status_.text = std::string("the other program's plan cannot be read: ") + error.what();
    return;
  }
  status_.save = PlanStatus::Save::NotYet;
  save();
}

bool PlanHistory::is_saved_beside_plan(const State& now) const {
  return now.measurements == saved_.measurements && now.landmarks == saved_.landmarks &&
         now.landmark_states == saved_.landmark_states;
}

void PlanHistory::save() {
  if (is_in_conflict()) return;
  const auto fail = [this](const std::exception& error) {
    status_.save = PlanStatus::Save::Failed;
    status_.text = std::string("not saved: ") + error.what();
  };
  try {  // a disk that is full is a state of the screen, not the end of the frame
    const State now = state();
    keep_steps();
    if (now.measurements != saved_.measurements) cases::save_measurements(case_folder_, now.measurements);
    if (now.landmarks != saved_.landmarks || now.landmark_states != saved_.landmark_states) {
      if (cases::plan_version(case_folder_) != version_) return set_conflict();
      cases::save_landmarks(case_folder_, model_->knee());
    }
    version_ = cases::save_plan_over(case_folder_, now.plan, version_);
    saved_ = now;
    status_.save = PlanStatus::Save::Saved;
    status_.text = "saved at " + files::local_time_in_words(files::utc_now()).substr(11);
    if (!steps_not_kept_.empty())
      status_.text += "; after the program's end it cannot be taken back: " + steps_not_kept_;
  } catch (const IoError& error) {
    fail(error);
  } catch (const std::filesystem::filesystem_error& error) {
    fail(error);
  } catch (
      const InvalidInput& error) {  // another program has written it, it is no plan, or the folder is gone
    std::error_code none;
    if (std::filesystem::is_directory(case_folder_, none) && is_changed_on_disk())
      set_conflict();
    else
      fail(error);
  }
}

}  // namespace arthronaut::open_case
