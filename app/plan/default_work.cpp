#include "app/plan/default_work.h"

#include <algorithm>
#include <exception>
#include <future>
#include <utility>

#include "planning/cases/plan_versions.h"

namespace arthronaut::plan {

namespace {

// The top of a thread: the geometry library's assertions, too, are words about that tunnel.
default_plan::DefaultTunnel default_tunnel(const open_case::PlanModel& model, const tunnels::TunnelKey& key,
                                           const std::stop_token& stop) {
  try {
    return model.default_tunnel(key, stop);
  } catch (const std::exception& error) {
    default_plan::DefaultTunnel none;
    none.message = error.what();
    return none;
  }
}

}  // namespace

void DefaultWork::start(const open_case::PlanModel& model, const std::vector<tunnels::TunnelKey>& keys) {
  made_of_ = std::make_shared<const open_case::PlanModel>(model);
  stop_ = {};
  asked_ = keys.size();
  done_ = 0;
  running_.start(
      [this, model = made_of_, keys, stop = stop_.get_token()] {
        std::vector<std::future<default_plan::DefaultTunnel>> running;
        running.reserve(keys.size());
        for (const tunnels::TunnelKey& key : keys)
          running.push_back(std::async(std::launch::async, [&, key] {
            auto made = default_tunnel(*model, key, stop);
            ++done_;
            wake_();
            return made;
          }));
        std::vector<MadeTunnel> made;
        for (std::size_t i = 0; i < keys.size(); ++i)
          made.push_back({.key = keys[i], .made = running[i].get()});
        return made;
      },
      wake_);
}

bool DefaultWork::is_of(const open_case::PlanModel& model) const {
  const cases::Case &now = model.knee(), &then = made_of_->knee();
  return now.landmarks == then.landmarks && now.landmark_states == then.landmark_states &&
         std::ranges::all_of(cases::compare_plans(now.plan, then.plan), [](const auto& difference) {
           return difference.kind == cases::TunnelDifference::Kind::Same;
         });
}

std::string DefaultWork::progress() const {
  return std::to_string(done_) + " of " + std::to_string(asked_) + (asked_ == 1 ? " tunnel" : " tunnels");
}

std::optional<std::vector<MadeTunnel>> DefaultWork::take() {
  if (!running_.is_ready()) return std::nullopt;
  std::vector<MadeTunnel> made = running_.take();
  if (std::exchange(made_of_, nullptr) == nullptr) return std::nullopt;
  return made;
}

}  // namespace arthronaut::plan
