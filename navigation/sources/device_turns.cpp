#include "navigation/sources/device_turns.h"

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <set>

#include "planning/geometry/error.h"

namespace arthronaut::sources {

struct DeviceTurns::State {
  State(Opener opens, double patience) : opener(std::move(opens)), patience_s(patience) {}

  const Opener opener;
  const std::chrono::duration<double> patience_s;
  std::mutex mutex;
  std::condition_variable given_back;
  std::set<int> taken;
};

namespace {

// What is done when it goes out of scope.
class GiveBack {
 public:
  explicit GiveBack(std::function<void()> give_back) : give_back_(std::move(give_back)) {}
  ~GiveBack() { give_back_(); }
  GiveBack(const GiveBack&) = delete;
  GiveBack& operator=(const GiveBack&) = delete;

 private:
  std::function<void()> give_back_;
};

class TurnedSource : public FrameSource {
 public:
  TurnedSource(std::unique_ptr<GiveBack> turn, std::unique_ptr<FrameSource> source)
      : turn_(std::move(turn)), source_(std::move(source)) {}
  [[nodiscard]] const SourceInfo& info() const override { return source_->info(); }
  [[nodiscard]] camera::FramePtr next() override { return source_->next(); }

 private:
  std::unique_ptr<GiveBack> turn_;  // outlives the source: the device is free when it is closed
  std::unique_ptr<FrameSource> source_;
};

}  // namespace

DeviceTurns::DeviceTurns(Opener opener, double patience_s)
    : state_(std::make_shared<State>(std::move(opener), patience_s)) {}

std::unique_ptr<FrameSource> DeviceTurns::open(const CameraAddress& address) const {
  return open_within(address, state_->patience_s.count());
}

std::unique_ptr<FrameSource> DeviceTurns::open_if_free(const CameraAddress& address) const {
  return open_within(address, 0);
}

std::unique_ptr<FrameSource> DeviceTurns::open_within(const CameraAddress& address, double patience_s) const {
  const int device_index = address.index;
  {
    std::unique_lock lock(state_->mutex);
    const bool is_free = state_->given_back.wait_for(lock, std::chrono::duration<double>(patience_s),
                                                     [&] { return !state_->taken.contains(device_index); });
    if (!is_free)
      throw DeviceError("camera " + std::to_string(device_index) +
                        " is in use: stop what shows it, in Set up or in Navigate");
    state_->taken.insert(device_index);
  }
  auto turn = std::make_unique<GiveBack>([state = state_, device_index] {
    const std::lock_guard lock(state->mutex);
    state->taken.erase(device_index);
    state->given_back.notify_all();
  });
  std::unique_ptr<FrameSource> source = state_->opener(address);
  return std::make_unique<TurnedSource>(std::move(turn), std::move(source));
}

}  // namespace arthronaut::sources
