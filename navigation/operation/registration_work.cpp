#include "navigation/operation/registration_work.h"

namespace arthronaut::operation {

namespace {

void hand_over(registration::OnlineRegistration& online, const DrawnPoint& drawn) {
  online.add_points({&drawn.point, 1});
}
void hand_over(registration::OnlineRegistration& online, const StrokeExclusion& exclusion) {
  online.exclude_stroke(exclusion.curve, exclusion.is_excluded);
}
void hand_over(registration::OnlineRegistration& online, const StrokesTakenBack& taken) {
  for (int i = 0; i < taken.count; ++i) online.undo_stroke();
}
void hand_over(registration::OnlineRegistration& online, const StrokesCleared&) { online.clear(); }
void hand_over(registration::OnlineRegistration& online, const JudgeAll&) { online.judge_all(); }
void hand_over(registration::OnlineRegistration&, const FitAll&) {}
void hand_over(registration::OnlineRegistration& online, const AimAt& aim) {
  online.aim_at(aim.target_in_bone_mm, aim.direction_in_bone);
}

}  // namespace

RegistrationWork::RegistrationWork(const std::function<SurfaceIndexPtr()>& bone,
                                   const RegistrationWorkOptions& options)
    : options_(options), outcome_(std::make_shared<const RegistrationOutcome>()) {
  try {
    bone_ = bone();
    online_ = std::make_unique<registration::OnlineRegistration>(bone_, options_.online);
    publish([](RegistrationOutcome& outcome) { outcome.bone_is_ready = true; });
  } catch (const std::exception& error) {
    fail(error);
  }
}

// The reason is an outcome like any other: it stands on the screen.
void RegistrationWork::fail(const std::exception& error) {
  online_.reset();
  publish([&](RegistrationOutcome& outcome) { outcome.failure = error.what(); });
}

bool RegistrationWork::work_in(const RegistrationRequest& request) {
  ++request_count_;
  if (online_ == nullptr) return false;
  try {
    return carry_out(request);
  } catch (const std::exception& error) {  // of memory that is short, above all
    fail(error);
    return true;
  }
}

bool RegistrationWork::carry_out(const RegistrationRequest& request) {
  if (const auto* wanted = std::get_if<FitAll>(&request)) {
    fit(*wanted);
    return true;
  }
  if (const auto* aim = std::get_if<AimAt>(&request)) options_.fit.target_in_bone_mm = aim->target_in_bone_mm;
  std::visit([this](const auto& r) { hand_over(*online_, r); }, request);
  const std::uint64_t known = outcome_->online != nullptr ? outcome_->online->revision : 0;
  const registration::OnlineResult& result = online_->update();
  if (result.revision == known) return false;
  publish([&](RegistrationOutcome& outcome) {
    outcome.online = std::make_shared<const registration::OnlineResult>(result);
  });
  return true;
}

void RegistrationWork::fit(const FitAll& request) {
  auto found = registration::register_curves(*bone_, *request.curves, options_.fit);
  publish([&](RegistrationOutcome& outcome) {
    outcome.fit_number = request.number;
    outcome.fit = std::make_shared<const registration::RegistrationSummary>(std::move(found));
  });
}

void RegistrationWork::publish(const std::function<void(RegistrationOutcome&)>& change) {
  RegistrationOutcome next = *outcome_;
  next.request_count = request_count_;
  change(next);
  outcome_ = std::make_shared<const RegistrationOutcome>(std::move(next));
}

}  // namespace arthronaut::operation
