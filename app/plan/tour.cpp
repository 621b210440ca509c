#include "app/plan/tour.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "app/case/case_opening.h"
#include "planning/files/json_document.h"
#include "planning/files/private_folder.h"
#include "planning/geometry/rigid_transform.h"

namespace arthronaut::plan {

namespace {

using bones::BoneKind;
namespace fs = std::filesystem;
constexpr std::string_view kFormat = "arthronaut.tour";
constexpr int kVersion = 1;

// What a hand means to do, not what it trembles.
constexpr double kTurned_deg = 10, kMoved_mm = 0.5, kAimed_deg = 0.5;
// As far as a saved plan may differ from the one that was computed.
constexpr double kSame_mm = 0.01, kSame_deg = 0.01;

struct StepText {
  std::string_view id, title, text;
};
constexpr std::array<StepText, kTourStepCount> kSteps{{
    {"look", "Turn the knee",
     "Drag beside the bones with the left mouse button, or press 1 to 7 for a named side; 6 looks into the "
     "notch."},
    {"landmarks", "Look at the landmarks",
     "Press L. Each can be dragged on the bone; Enter confirms one. Directions and grids follow from them."},
    {"default", "Make the default plan", "Press N: both tunnels by published norms and these landmarks."},
    {"move", "Move a tunnel",
     "6 looks into the notch: drag the ring of the entry there, or aim by the arrow keys. The numbers "
     "follow."},
    {"checks", "Read the checks of both bones",
     "Press C for the checks, Tab for the other bone. Rest the mouse on one for its source; mend what is "
     "wrong."},
    {"take_back", "Take a step back", "Press Ctrl+Z. Every step can be taken back; H lists them all."},
    {"keep", "Keep this version",
     "The plan saves itself. K keeps it as it is beside the one that you work on."},
    {"theatre", "That is planning",
     "F4 sets up the arthroscope, F2 drills this plan in the simulation. F9 ends the tour."},
}};

bool is_same(const tunnels::Tunnel& a, const tunnels::Tunnel& b, double within_mm, double within_deg) {
  return (a.entry_mm - b.entry_mm).norm() <= within_mm &&
         geometry::deg_from_rad(geometry::angle_between_rad(a.direction, b.direction)) <= within_deg;
}

bool has_moved(const std::map<BoneKind, tunnels::Tunnel>& from,
               const std::map<BoneKind, tunnels::Tunnel>& to) {
  return std::any_of(to.begin(), to.end(), [&](const auto& one) {
    const auto before = from.find(one.first);
    return before != from.end() && !is_same(before->second, one.second, kMoved_mm, kAimed_deg);
  });
}

bool is_default(const TourFacts& facts) {
  return !facts.defaults.empty() &&
         std::all_of(facts.defaults.begin(), facts.defaults.end(), [&](const auto& one) {
           const auto planned = facts.tunnels.find(one.first);
           return planned != facts.tunnels.end() && is_same(planned->second, one.second, kSame_mm, kSame_deg);
         });
}

}  // namespace

fs::path tour_file() { return open_case::built_in_case_folder().parent_path() / "tour.json"; }

Tour::Tour(fs::path file) : file_(std::move(file)) { load(); }

void Tour::case_opened(bool is_built_in) {
  is_built_in_ = is_built_in;
  go_to(step_);
  if (std::exchange(begins_when_opened_, false) && is_built_in) begin();
}

void Tour::begin_when_opened() { begins_when_opened_ = true; }

void Tour::begin() {
  go_to(state_ == State::Done ? TourStep::Look : step_);
  state_ = State::Running;
  save();
}

void Tour::leave() {
  if (state_ == State::Running && step_ == TourStep::Theatre)
    state_ = State::Done;
  else
    state_ = State::Left;
  save();
}

void Tour::plan_mode_left() {
  if (is_running() && step_ == TourStep::Theatre) leave();
}

void Tour::go_to(TourStep step) {
  step_ = step;
  at_begin_.reset();
  landmarks_seen_.clear();
  checks_seen_.clear();
}

void Tour::see(const TourFacts& facts) {
  if (!at_begin_) at_begin_ = facts;
  if (facts.landmarks_shown) landmarks_seen_.insert(*facts.landmarks_shown);
  if (facts.checks_shown) checks_seen_.insert(*facts.checks_shown);
}

void Tour::follow(const TourFacts& facts) {
  if (!is_running()) return;
  see(facts);
  if (step_ == TourStep::Theatre || !is_done(facts)) return;
  go_to(static_cast<TourStep>(static_cast<int>(step_) + 1));
  see(facts);  // what is on the screen now may be gone with the next frame
  save();
}

bool Tour::is_done(const TourFacts& facts) const {
  const auto turned_deg =
      geometry::deg_from_rad(geometry::angle_between_rad(at_begin_->view_direction, facts.view_direction));
  switch (step_) {
    case TourStep::Look:
      return turned_deg >= kTurned_deg;
    case TourStep::Landmarks:
      return std::any_of(landmarks_seen_.begin(), landmarks_seen_.end(),
                         [&](BoneKind bone) { return !facts.unconfirmed.contains(bone); });
    case TourStep::DefaultPlan:
      return is_default(facts);
    case TourStep::Move:
      return facts.is_saved && has_moved(at_begin_->tunnels, facts.tunnels);
    case TourStep::Checks:
      return facts.wrong.empty() &&
             std::all_of(facts.tunnels.begin(), facts.tunnels.end(),
                         [&](const auto& one) { return checks_seen_.contains(one.first); });
    case TourStep::TakeBack:
      return facts.can_redo;
    case TourStep::Keep:
      return facts.is_saved && facts.kept_versions > at_begin_->kept_versions;
    case TourStep::Theatre:
      break;
  }
  return false;
}

std::optional<TourCard> Tour::card() const {
  if (is_offered())
    return TourCard{"A first case?",
                    "F9 leads through planning on this knee, in some minutes; it can be left at any time.",
                    0};
  if (!is_running()) return std::nullopt;
  const StepText& step = kSteps.at(static_cast<std::size_t>(step_));
  return TourCard{std::string(step.title), std::string(step.text), static_cast<int>(step_) + 1};
}

void Tour::load() {
  try {
    if (!fs::exists(file_)) return;
    const auto root = files::read_json(file_, kFormat, kVersion);
    const std::string state = root.text("state"), step = root.text("step");
    state_ = state == "running" ? State::Running : state == "done" ? State::Done : State::Left;
    const auto at =
        std::find_if(kSteps.begin(), kSteps.end(), [&](const StepText& one) { return one.id == step; });
    if (at != kSteps.end()) step_ = static_cast<TourStep>(at - kSteps.begin());
  } catch (const std::exception&) {  // as the header says
    state_ = State::Left;
  }
}

// A disk that fails is no reason not to plan.
void Tour::save() const noexcept {
  try {
    files::create_private_folder(file_.parent_path());
    files::write_json(file_, {{"format", kFormat},
                              {"version", kVersion},
                              {"state", state_ == State::Running ? "running"
                                        : state_ == State::Done  ? "done"
                                                                 : "left"},
                              {"step", kSteps.at(static_cast<std::size_t>(step_)).id}});
  } catch (const std::exception&) {
  }
}

}  // namespace arthronaut::plan
