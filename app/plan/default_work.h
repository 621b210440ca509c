// Default tunnels made while the screen goes on: one takes a second or two. They are made of a copy of the
// case, which may be changed or closed meanwhile; whoever takes them asks is_of() whether it was.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "app/case/plan_model.h"
#include "app/plan/default_words.h"
#include "navigation/worker/awaited.h"

namespace arthronaut::plan {

class DefaultWork {
 public:
  // wake: called from other threads when a tunnel is done.
  explicit DefaultWork(std::function<void()> wake) : wake_(std::move(wake)) {}
  ~DefaultWork() { cancel(); }  // and waits for the thread
  DefaultWork(const DefaultWork&) = delete;
  DefaultWork& operator=(const DefaultWork&) = delete;

  // Precondition: not is_busy(), and the model has these bones.
  void start(const open_case::PlanModel& model, const std::vector<tunnels::TunnelKey>& keys);
  // What is being made will not be taken. The thread is asked to end, and does within a direction that it is
  // trying: until then nothing can be started.
  void cancel() {
    made_of_ = nullptr;
    stop_.request_stop();
  }
  [[nodiscard]] bool is_running() const { return made_of_ != nullptr; }  // and was not cancelled
  [[nodiscard]] bool is_busy() const { return running_.is_busy(); }
  // Whether the model's plan and landmarks are those that it is made of. Precondition: is_running().
  [[nodiscard]] bool is_of(const open_case::PlanModel& model) const;
  // "1 of 2 tunnels"
  [[nodiscard]] std::string progress() const;
  // For every frame: once what was made, in the order of the keys, without checks; nullopt while there is no
  // news. What cannot be made says why.
  [[nodiscard]] std::optional<std::vector<MadeTunnel>> take();

 private:
  std::function<void()> wake_;
  std::shared_ptr<const open_case::PlanModel> made_of_;  // null: nothing is wanted
  std::stop_source stop_;
  std::size_t asked_ = 0;
  std::atomic<std::size_t> done_ = 0;
  worker::Awaited<std::vector<MadeTunnel>> running_;  // last: ends first
};

}  // namespace arthronaut::plan
