#include "navigation/sources/device_turns.h"

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <set>
#include <string>

#include "planning/geometry/error.h"

namespace arthronaut::sources {

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

struct DeviceTurns::State {
  State(Opener opens, double patience_s) : opener(std::move(opens)), patience(patience_s) {}

  // Null: it was not free in time.
  [[nodiscard]] static std::unique_ptr<GiveBack> take(const std::shared_ptr<State>& state,
                                                      const std::string& name,
                                                      std::chrono::duration<double> patience);
  [[nodiscard]] static std::unique_ptr<FrameSource> open_camera(const std::shared_ptr<State>& state,
                                                                const CameraAddress& address,
                                                                std::chrono::duration<double> patience);

  const Opener opener;
  const std::chrono::duration<double> patience;
  std::mutex mutex;
  std::condition_variable given_back;
  std::set<std::string> taken;
};

DeviceTurns::DeviceTurns(Opener opener, double patience_s)
    : state_(std::make_shared<State>(std::move(opener), patience_s)) {}

std::unique_ptr<GiveBack> DeviceTurns::State::take(const std::shared_ptr<State>& state,
                                                   const std::string& name,
                                                   std::chrono::duration<double> patience) {
  std::unique_lock lock(state->mutex);
  if (!state->given_back.wait_for(lock, patience, [&] { return !state->taken.contains(name); }))
    return nullptr;
  state->taken.insert(name);
  return std::make_unique<GiveBack>([state, name] {
    const std::lock_guard own(state->mutex);
    state->taken.erase(name);
    state->given_back.notify_all();
  });
}

std::unique_ptr<FrameSource> DeviceTurns::State::open_camera(const std::shared_ptr<State>& state,
                                                             const CameraAddress& address,
                                                             std::chrono::duration<double> patience) {
  const std::string name = "camera " + std::to_string(address.index);
  auto turn = take(state, name, patience);
  if (turn == nullptr) throw DeviceError(name + " is in use: stop what shows it, in Set up or in Navigate");
  std::unique_ptr<FrameSource> source = state->opener(address);
  return std::make_unique<TurnedSource>(std::move(turn), std::move(source));
}

std::unique_ptr<FrameSource> DeviceTurns::open(const CameraAddress& address) const {
  return State::open_camera(state_, address, state_->patience);
}

std::unique_ptr<FrameSource> DeviceTurns::open_if_free(const CameraAddress& address) const {
  return State::open_camera(state_, address, {});
}

std::unique_ptr<FrameSource> DeviceTurns::open_stream(const std::string& address) const {
  auto turn = State::take(state_, address, state_->patience);
  std::unique_ptr<FrameSource> source = sources::open_stream(address);
  return std::make_unique<TurnedSource>(std::move(turn), std::move(source));
}

std::unique_ptr<FrameSource> DeviceTurns::open_stream_if_free(const std::string& address) const {
  auto turn = State::take(state_, address, {});
  if (turn == nullptr) throw DeviceError("is in use: stop what shows it, in Set up or in Navigate");
  std::unique_ptr<FrameSource> source = sources::open_stream(address);
  return std::make_unique<TurnedSource>(std::move(turn), std::move(source));
}

}  // namespace arthronaut::sources
