#include "navigation/operation/registration_ledger.h"

#include <utility>

#include "planning/files/format.h"

namespace arthronaut::operation {

namespace {

constexpr double kClearlyBetter = 0.9;
// Below it a fit that is not reliable says more about the strokes than about the bone.
constexpr double kTellingLength_mm = 100;

RegistrationPtr doubted(const registration::RegistrationSummary& found, std::vector<std::string> reasons) {
  auto summary = std::make_shared<registration::RegistrationSummary>(found);
  summary->reliable = false;
  summary->reasons = std::move(reasons);
  return summary;
}

// Empty: as it was found.
double error_at_mm(const registration::RegistrationSummary& found,
                   const std::optional<Eigen::Vector3d>& target_mm) {
  return target_mm && found.has_pose ? registration::predicted_error_mm(found, *target_mm)
                                     : found.predicted_tre_mm;
}

// It may have been found for another tunnel than this one.
bool is_reliable_at(const registration::RegistrationSummary& found,
                    const std::optional<Eigen::Vector3d>& target_mm) {
  const double error_mm = error_at_mm(found, target_mm);
  return found.reliable && (error_mm == found.predicted_tre_mm || error_mm <= registration::kMaxError_mm);
}

RegistrationPtr known_at(const RegistrationPtr& found, const std::optional<Eigen::Vector3d>& target_mm) {
  const double error_mm = error_at_mm(*found, target_mm);
  if (error_mm == found->predicted_tre_mm) return found;
  auto summary = std::make_shared<registration::RegistrationSummary>(*found);
  summary->predicted_tre_mm = error_mm;
  if (found->reliable && !is_reliable_at(*found, target_mm)) {
    summary->reliable = false;
    summary->reasons = {files::format(
        "at the tunnel of this plan %.2f mm is its predicted error: touch nearer to it", error_mm)};
  }
  return summary;
}

bool is_same(const RegistrationPtr& a, const RegistrationPtr& b) {
  if (a == b) return true;
  return a != nullptr && b != nullptr && a->reliable == b->reliable && a->reasons == b->reasons &&
         a->predicted_tre_mm == b->predicted_tre_mm &&
         a->marker_from_bone.translation_mm == b->marker_from_bone.translation_mm &&
         a->marker_from_bone.rotation.coeffs() == b->marker_from_bone.rotation.coeffs();
}

}  // namespace

std::string_view to_text(RegistrationOrigin origin) {
  switch (origin) {
    case RegistrationOrigin::WhileDrawing:
      return "while drawing";
    case RegistrationOrigin::AllStrokes:
      return "all strokes";
    case RegistrationOrigin::Given:
      return "given";
    case RegistrationOrigin::Resumed:
      return "resumed";
  }
  return "unknown";
}

std::string_view to_text(Standing standing) {
  switch (standing) {
    case Standing::None:
      return "none";
    case Standing::Stands:
      return "stands";
    case Standing::NotReliable:
      return "not reliable";
    case Standing::Void:
      return "void";
    case Standing::Alarm:
      return "alarm";
    case Standing::InDoubt:
      return "in doubt";
  }
  return "unknown";
}

RegistrationLedger::RegistrationLedger(std::shared_ptr<const geometry::Surface> surface,
                                       std::optional<registration::CartilageRegion> cartilage,
                                       const TouchLimits& limits)
    : surface_(std::move(surface)), cartilage_(std::move(cartilage)), touches_(limits) {}

void RegistrationLedger::set_now(const registration::Provenance& now) {
  const bool is_same_world = now.bone == now_.bone && (now.source == sources::SourceKind::Simulation) ==
                                                          (now_.source == sources::SourceKind::Simulation);
  now_ = now;
  at_ = {at_.source + 1, std::numeric_limits<std::int64_t>::min()};
  // A touch of a simulated bone says nothing about a real one, and what touches verified was verified by
  // those that go here: it does not come back with its own world.
  if (!is_same_world) return forget_touches();
  judge();
}

void RegistrationLedger::take_online(const std::shared_ptr<const registration::OnlineResult>& online,
                                     std::uint64_t request_count) {
  const registration::RegistrationSummary& found = online->registration;
  const bool is_confirmed = online->state >= registration::OnlineState::Confirmed &&
                            is_reliable_at(found, target_in_bone_mm_) && !online->bone_is_in_doubt;
  if (online->bone_is_in_doubt && request_count > fitted_after_ && entry_in_force_) {
    doubt_ = found.reasons.empty() ? std::vector<std::string>{"the strokes bring the bone in doubt"}
                                   : found.reasons;
    best_tre_mm_ = std::numeric_limits<double>::infinity();
    judge();
  }
  if (!is_confirmed) return;
  if (doubt_) {
    doubt_.reset();
    is_chosen_ = false;  // what was chosen is what was doubted
  }
  // At the tunnel of now, as the best one so far: what was asked for before it is of another one.
  const double error_mm = error_at_mm(found, target_in_bone_mm_);
  if (error_mm >= kClearlyBetter * best_tre_mm_) return judge();
  best_tre_mm_ = error_mm;
  add({RegistrationOrigin::WhileDrawing, std::make_shared<const registration::RegistrationSummary>(found),
       now_});
}

void RegistrationLedger::take_fit(const RegistrationPtr& fit, std::uint64_t request_count, double length_mm) {
  const bool is_given = entry_in_force_ && (*entries_)[*entry_in_force_].origin == RegistrationOrigin::Given;
  if (!fit->reliable && is_given && in_force_.standing == Standing::Stands && length_mm < kTellingLength_mm)
    return;
  is_chosen_ = false;  // it was asked for just now
  fitted_after_ = request_count;
  if (fit->reliable) doubt_.reset();
  best_tre_mm_ = is_reliable_at(*fit, target_in_bone_mm_) ? error_at_mm(*fit, target_in_bone_mm_)
                                                          : std::numeric_limits<double>::infinity();
  add({RegistrationOrigin::AllStrokes, fit, now_});
}

void RegistrationLedger::give(RegistrationOrigin origin, const RegistrationPtr& registration,
                              const registration::Provenance& of) {
  is_chosen_ = false;
  add({origin, registration, of});
}

void RegistrationLedger::bring_back(const registration::Provenance& of,
                                    const std::vector<Eigen::Vector3d>& touches_mm,
                                    const std::optional<Eigen::Vector3d>& control_point_mm) {
  const int placement = now_.placement;
  now_ = of;
  registration::Provenance before = of;
  before.placement = placement - 1;  // whether it is the same one, nobody has seen
  now_.placement = placement;
  touches_.bring_back(touches_mm, control_point_mm, before);
  judge();
}

void RegistrationLedger::choose(std::size_t entry) {
  if (entry >= entries_->size() || entry == entry_in_force_ || (*entries_)[entry].is_gone()) return;
  entry_in_force_ = entry;
  is_chosen_ = entry + 1 < entries_->size();
  judge();
}

void RegistrationLedger::add_touch(const Eigen::Vector3d& tip_in_marker_mm) {
  touches_.add_touch(tip_in_marker_mm, now_, at_);
  judge();
  if (in_force_.standing == Standing::Void && in_force_.can_be_confirmed && touches_.last_confirms()) {
    // One touch confirms; what verified it before was under other circumstances.
    change_entry(*entry_in_force_, [this](RegistrationEntry& entry) {
      entry.confirmed_from = std::exchange(entry.of, now_);
      entry.at = at_;
      entry.is_verified = false;
    });
    judge();
  }
}

void RegistrationLedger::touch_control_point(const Eigen::Vector3d& tip_in_marker_mm) {
  // Set since, it knows where the bone lies since it moved, and would lift the alarm at the next touch.
  if (seen_drift_mm_ && !control_point_is_older_) return;
  touches_.touch_control_point(tip_in_marker_mm, now_, at_);
  judge();
  const Touches::Last last = touches_.last();
  if (!seen_drift_mm_ || last.kind != Touches::Last::Kind::ControlAgain || !last.distance_mm ||
      !denies_drift(*last.distance_mm, *seen_drift_mm_))
    return;
  seen_drift_mm_.reset();
  judge();
}

void RegistrationLedger::bone_moved_in_picture(double drift_mm, bool control_point_is_older) {
  if (in_force_.standing != Standing::Stands) return;
  seen_drift_mm_ = drift_mm;
  control_point_is_older_ = control_point_is_older && touches_.has_control_point();
  judge();
}

TouchAlarm RegistrationLedger::alarm() const {
  TouchAlarm alarm = touches_.alarm();
  alarm.seen_drift_mm = seen_drift_mm_.value_or(0);
  alarm.control_point_decides = seen_drift_mm_ && control_point_is_older_;
  if (alarm || !seen_drift_mm_) return alarm;
  alarm.kind = TouchAlarm::Kind::SeenInPicture;
  return alarm;
}

void RegistrationLedger::forget_touches() {
  touches_.clear();
  take_verification_back();
  seen_drift_mm_.reset();
  judge();
}

Touches::Gone RegistrationLedger::forget_since(std::int64_t time_ns) {
  const Moment since{at_.source, time_ns};
  const Touches::Gone gone = touches_.forget_since(since);
  if (gone.touches) take_verification_back();
  for (std::size_t i = 0; i < entries_->size(); ++i) {
    const RegistrationEntry& entry = (*entries_)[i];
    if (!entry.at.is_after(since)) continue;
    if (entry.confirmed_from)
      change_entry(i, [](RegistrationEntry& confirmed) {
        confirmed.of = *std::exchange(confirmed.confirmed_from, std::nullopt);
      });
    else if (entry.origin == RegistrationOrigin::WhileDrawing ||
             entry.origin == RegistrationOrigin::AllStrokes)
      change_entry(i, [](RegistrationEntry& found) { found.is_of_wrong_medium = true; });
  }
  if (entry_in_force_ && (*entries_)[*entry_in_force_].is_gone()) {
    entry_in_force_.reset();
    for (std::size_t i = 0; i < entries_->size(); ++i)
      if (!(*entries_)[i].is_gone()) entry_in_force_ = i;
    forget_strokes();
  }
  judge();
  return gone;
}

void RegistrationLedger::verify_anew() {
  touches_.verify_anew();
  take_verification_back();
  judge();
}

void RegistrationLedger::aim_at(const std::optional<Eigen::Vector3d>& target_in_bone_mm) {
  target_in_bone_mm_ = target_in_bone_mm;
  judge();
  // Errors at two places can't be compared: the next one has to be better there.
  const bool found_itself = best_tre_mm_ < std::numeric_limits<double>::infinity() && entry_in_force_;
  best_tre_mm_ = found_itself && in_force_.registration->reliable ? in_force_.registration->predicted_tre_mm
                                                                  : std::numeric_limits<double>::infinity();
}

void RegistrationLedger::forget_strokes() {
  best_tre_mm_ = std::numeric_limits<double>::infinity();
  is_chosen_ = false;
  judge();
}

void RegistrationLedger::marker_placed_anew() {
  for (std::size_t i = 0; i < entries_->size(); ++i)
    change_entry(i, [](RegistrationEntry& entry) { entry.marker_has_moved = true; });
  entry_in_force_.reset();
  doubt_.reset();
  ++now_.placement;
  touches_.clear();
  seen_drift_mm_.reset();
  forget_strokes();
}

void RegistrationLedger::add(RegistrationEntry entry) {
  entry.at = at_;
  auto entries = std::make_shared<std::vector<RegistrationEntry>>(*entries_);
  entries->push_back(std::move(entry));
  entries_ = std::move(entries);
  if (!is_chosen_) entry_in_force_ = entries_->size() - 1;
  judge();
}

void RegistrationLedger::change_entry(std::size_t entry,
                                      const std::function<void(RegistrationEntry&)>& change) {
  auto entries = std::make_shared<std::vector<RegistrationEntry>>(*entries_);
  change((*entries)[entry]);
  entries_ = std::move(entries);
}

void RegistrationLedger::take_verification_back() {
  for (std::size_t i = 0; i < entries_->size(); ++i)
    if ((*entries_)[i].is_verified)
      change_entry(i, [](RegistrationEntry& entry) { entry.is_verified = false; });
}

RegistrationInForce RegistrationLedger::judged() const {
  RegistrationInForce judged;
  if (!entry_in_force_) return judged;
  const RegistrationEntry& entry = (*entries_)[*entry_in_force_];
  judged.registration = known_at(entry.registration, target_in_bone_mm_);
  judged.mismatch = registration::mismatch_of(entry.of, now_);
  if (judged.mismatch) {
    judged.standing = Standing::Void;
    judged.can_be_confirmed = registration::can_be_confirmed(entry.of, now_);
    judged.registration =
        doubted(*judged.registration, {registration::in_words(*judged.mismatch, entry.of, now_)});
    return judged;
  }
  if (!judged.registration->has_pose || !judged.registration->reliable) {
    judged.standing = Standing::NotReliable;
    return judged;
  }
  if (const TouchAlarm told = alarm()) {
    judged.standing = Standing::Alarm;
    judged.registration = doubted(*judged.registration, {in_words(told)});
    return judged;
  }
  if (doubt_) {
    judged.standing = Standing::InDoubt;
    judged.registration = doubted(*judged.registration, *doubt_);
    return judged;
  }
  judged.standing = Standing::Stands;
  judged.is_verified = entry.is_verified;
  return judged;
}

// Distances of the touches first, the alarm with them, and then what is in force.
void RegistrationLedger::judge() {
  const RegistrationEntry* entry = entry_in_force_ ? &(*entries_)[*entry_in_force_] : nullptr;
  touches_.judge(entry != nullptr ? entry->registration.get() : nullptr, surface_.get(), cartilage_, now_);
  // What touches verified a touch takes back: one off the bone says that something is not as it was.
  if (entry != nullptr && entry->is_verified && touches_.lie_off_the_bone())
    change_entry(*entry_in_force_, [](RegistrationEntry& denied) { denied.is_verified = false; });
  RegistrationInForce next = judged();
  if (next.standing == Standing::Stands && !next.is_verified && touches_.verify()) {
    change_entry(*entry_in_force_, [](RegistrationEntry& verified) { verified.is_verified = true; });
    next.is_verified = true;
  }
  // The same verdict keeps its object: who follows it compares pointers.
  if (is_same(next.registration, in_force_.registration))
    next.registration = in_force_.registration;
  else
    ++change_count_;
  in_force_ = std::move(next);
}

}  // namespace arthronaut::operation
