#include "app/navigate/bone_registration.h"

#include <algorithm>
#include <chrono>

namespace arthronaut::navigate {

namespace {

// The strokes are copied for the screen a few times a second, not for every point.
constexpr std::size_t kPointsBetweenCopies = 6;
constexpr double kClearlyBetter = 0.9;
constexpr const char* kWhileDrawing = "while drawing";

}  // namespace

BoneRegistration::BoneRegistration(std::shared_future<SurfaceIndexPtr> bone,
                                   const std::optional<tunnels::Tunnel>& plan,
                                   std::shared_ptr<const geometry::Surface> surface,
                                   std::optional<registration::CartilageRegion> covered)
    : bone_(std::move(bone)), plan_(plan), surface_(std::move(surface)), covered_(std::move(covered)) {}

void BoneRegistration::start_worker() {
  if (worker_ != nullptr || !status_.bone_trouble.empty()) return;
  if (bone_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return;
  registration::OnlineOptions options;
  if (plan_) {
    options.target_in_bone_mm = plan_->entry_mm;
    options.direction_in_bone = plan_->direction;
  }
  options.covered = covered_;
  try {  // the top of the thread that made the bone ready: the reason stands on the screen
    worker_ = std::make_unique<registration::RegistrationWorker>(bone_.get(), options);
  } catch (const std::exception& error) {
    status_.bone_trouble = error.what();
    published_.reset();
    return;
  }
  // What was drawn and touched while the bone was being made ready; nothing more may come.
  if (!strokes_.points().empty()) worker_->take_up(strokes_.points(), strokes_.left_out());
  TouchCheck seen;
  for (const Eigen::Vector3d& touch : status_.touches.touches_mm()) {
    if (seen.is_new_place(touch)) worker_->add_touch(touch);
    seen.add_touch(touch);
  }
  for (const Eigen::Vector3d& touch : status_.touches.control_touches_mm())
    worker_->touch_control_point(touch);
}

void BoneRegistration::publish_strokes(bool always) {
  if (!always && strokes_.points().size() < status_.drawn->size() + kPointsBetweenCopies) return;
  published_.reset();
  status_.drawn = std::make_shared<const strokes::Curves>(strokes_.points());
  status_.left_out = strokes_.left_out();
}

void BoneRegistration::add_tip(double time_s, const Eigen::Vector3d& tip_in_marker_mm,
                               const std::optional<Eigen::Vector3d>& shaft_direction) {
  const std::lock_guard lock(mutex_);
  start_worker();
  const strokes::CurvePoint point = strokes_.add(time_s, tip_in_marker_mm, shaft_direction);
  if (worker_ != nullptr) worker_->add_points(std::span(&point, 1));
  publish_strokes(false);
}

void BoneRegistration::take_back_stroke() {
  const std::lock_guard lock(mutex_);
  const int count = strokes_.take_back();
  ++removals_;
  for (int i = 0; worker_ != nullptr && i < count; ++i) worker_->undo_stroke();
  publish_strokes(true);
}

void BoneRegistration::leave_out(int curve, bool is_left_out) {
  const std::lock_guard lock(mutex_);
  strokes_.leave_out(curve, is_left_out);
  ++removals_;
  if (worker_ != nullptr) worker_->exclude_stroke(curve, is_left_out);
  publish_strokes(true);
}

void BoneRegistration::clear() {
  const std::lock_guard lock(mutex_);
  const bool marker_has_moved = !status_.alarm.empty();
  strokes_.clear();
  status_.touches.clear();
  if (worker_ != nullptr) worker_->clear();
  status_.online.reset();
  ++removals_;
  best_tre_mm_ = std::numeric_limits<double>::infinity();
  if (marker_has_moved) {
    chosen_.reset();
    status_.entry_in_force.reset();
    auto history = std::make_shared<std::vector<RegistrationEntry>>(*status_.history);
    for (RegistrationEntry& entry : *history) entry.is_void = true;
    status_.history = std::move(history);
  }
  status_.is_chosen = false;
  judge();
  publish_strokes(true);
}

void BoneRegistration::add_touch(const Eigen::Vector3d& tip_in_marker_mm) {
  const std::lock_guard lock(mutex_);
  start_worker();
  // The same place touched again verifies nothing more.
  if (worker_ != nullptr && status_.touches.is_new_place(tip_in_marker_mm))
    worker_->add_touch(tip_in_marker_mm);
  status_.touches.add_touch(tip_in_marker_mm);
  judge();
}

void BoneRegistration::touch_control_point(const Eigen::Vector3d& tip_in_marker_mm) {
  const std::lock_guard lock(mutex_);
  start_worker();
  status_.touches.touch_control_point(tip_in_marker_mm);
  if (worker_ != nullptr) worker_->touch_control_point(tip_in_marker_mm);
  judge();
}

void BoneRegistration::forget_touches() {
  const std::lock_guard lock(mutex_);
  status_.touches.clear();
  if (worker_ != nullptr) worker_->clear_touches();
  judge();
}

void BoneRegistration::step_history(int by) {
  const std::lock_guard lock(mutex_);
  const std::size_t count = status_.history->size();
  if (count == 0) return;
  const std::size_t now = status_.entry_in_force.value_or(count);
  const std::size_t next = by < 0 ? (now > 0 ? now - 1 : 0) : std::min(now + 1, count - 1);
  if (status_.entry_in_force == next || (*status_.history)[next].is_void) return;
  put_in_force(next);
  status_.is_chosen = next + 1 < count;
}

void BoneRegistration::put_in_force(std::size_t entry) {
  status_.entry_in_force = entry;
  chosen_ = (*status_.history)[entry].registration;
  judge();
}

// Distances of the touches, the alarm, and with it what is in force.
void BoneRegistration::judge() {
  published_.reset();
  status_.touches.judge(chosen_.get(), surface_.get(), covered_);
  std::string alarm = status_.touches.alarm();
  if (alarm.empty() && status_.online != nullptr) alarm = status_.online->alarm;
  const bool had_alarm = !status_.alarm.empty();
  const RegistrationPtr before = status_.in_force;
  status_.alarm = std::move(alarm);
  if (status_.alarm.empty() || chosen_ == nullptr) {
    status_.in_force = chosen_;
  } else if (!had_alarm || status_.in_force == nullptr ||
             status_.in_force->reasons != std::vector<std::string>{status_.alarm}) {
    registration::RegistrationSummary doubtful = *chosen_;
    doubtful.reliable = false;
    doubtful.reasons = {status_.alarm};
    status_.in_force = std::make_shared<const registration::RegistrationSummary>(std::move(doubtful));
  }
  if (status_.in_force != before) ++status_.change_count;
}

void BoneRegistration::take_in(const std::shared_ptr<const registration::OnlineResult>& online) {
  if (status_.online != nullptr && status_.online->revision == online->revision) return;
  if (!online->failure.empty()) {
    status_.bone_trouble = online->failure;
    worker_.reset();
    published_.reset();
    return;
  }
  // What was drawn before the worker began is still being worked in.
  if (online->revision == 0 && !strokes_.points().empty()) return;
  // What was found with strokes that are gone or left out since, before the worker heard of it, must not take
  // effect any more.
  for (const registration::StrokeInfo& stroke : online->strokes)
    if (!stroke.is_excluded && !strokes_.uses(stroke.curve)) return;
  status_.online = online;
  judge();
  const registration::RegistrationSummary& found = online->registration;
  const RegistrationEntry* guiding =
      status_.entry_in_force ? &(*status_.history)[*status_.entry_in_force] : nullptr;
  if (online->bone_is_in_doubt && guiding != nullptr && guiding->origin == kWhileDrawing &&
      guiding->registration->reliable) {
    status_.is_chosen = false;
    best_tre_mm_ = std::numeric_limits<double>::infinity();
    add_entry(
        {kWhileDrawing, online->state, std::make_shared<const registration::RegistrationSummary>(found)});
    return;
  }
  if (online->state < registration::OnlineState::Confirmed || !found.reliable) return;
  auto history = std::make_shared<std::vector<RegistrationEntry>>(*status_.history);
  if (found.predicted_tre_mm >= kClearlyBetter * best_tre_mm_) {
    history->back().state = std::max(history->back().state, online->state);  // touches may have verified it
    status_.history = std::move(history);
    return;
  }
  best_tre_mm_ = found.predicted_tre_mm;
  add_entry({kWhileDrawing, online->state, std::make_shared<const registration::RegistrationSummary>(found)});
}

void BoneRegistration::add_entry(const RegistrationEntry& entry) {
  auto history = std::make_shared<std::vector<RegistrationEntry>>(*status_.history);
  history->push_back(entry);
  published_.reset();
  status_.history = std::move(history);
  if (!status_.is_chosen) put_in_force(status_.history->size() - 1);
}

void BoneRegistration::register_all(const std::function<bool()>& is_wanted) {
  registration::RegistrationOptions options;
  if (plan_) options.target_in_bone_mm = plan_->entry_mm;
  options.covered = covered_;
  registration::RegistrationSummary found;
  strokes::Curves curves;
  int removals = 0;
  {
    const std::lock_guard lock(mutex_);
    curves = strokes_.in_use();
    removals = removals_;
  }
  try {
    found = registration::register_curves(*bone_.get(), curves, options);
  } catch (const std::exception& error) {  // the top of the caller's thread: the reason stands on the screen
    found.reasons = {error.what()};
  }
  const std::lock_guard lock(mutex_);
  if (!is_wanted() || removals_ != removals) return;
  status_.is_chosen = false;  // it was asked for just now
  best_tre_mm_ = found.reliable ? found.predicted_tre_mm : std::numeric_limits<double>::infinity();
  add_entry({"all points",
             found.reliable ? registration::OnlineState::Confirmed : registration::OnlineState::Candidate,
             std::make_shared<const registration::RegistrationSummary>(std::move(found))});
}

strokes::Curves BoneRegistration::strokes_in_use() const {
  const std::lock_guard lock(mutex_);
  return strokes_.in_use();
}

std::shared_ptr<const RegistrationStatus> BoneRegistration::status() {
  const std::lock_guard lock(mutex_);
  start_worker();
  if (worker_ != nullptr) take_in(worker_->latest());
  if (published_ == nullptr) published_ = std::make_shared<const RegistrationStatus>(status_);
  return published_;
}

void BoneRegistration::finish() {
  const std::lock_guard lock(mutex_);
  start_worker();
  if (worker_ != nullptr) worker_->finish();
}

}  // namespace arthronaut::navigate
