// One edit of a whole label map, beside the screen: growing, parting, filling. Works on copies; what comes of
// it is taken when it is there.
//
//   idle ─► running ─► idle, with labels or a failure to be taken
//              └ cancel(): what comes is dropped
//
// One thread; `wake` is called from the other one.
#pragma once

#include <atomic>
#include <functional>
#include <optional>
#include <string>

#include "navigation/worker/awaited.h"
#include "planning/painting/label_change.h"

namespace arthronaut::paint {

class LabelJob {
 public:
  // Called now and then by what works for long; throws to stop.
  using Tell = std::function<void(double fraction)>;
  using Work = std::function<painting::Labels(const Tell&)>;
  struct Done {
    std::string what;
    painting::Labels labels;
    std::string failure;  // why there are no labels; empty when there are
  };

  explicit LabelJob(std::function<void()> wake) : wake_(std::move(wake)) {}
  ~LabelJob();
  LabelJob(const LabelJob&) = delete;
  LabelJob& operator=(const LabelJob&) = delete;

  // Precondition: !is_running().
  void start(std::string what, Work work);
  void cancel() { stops_ = true; }
  [[nodiscard]] bool is_running() const { return running_.is_busy(); }
  [[nodiscard]] bool is_cancelled() const { return is_running() && stops_; }
  [[nodiscard]] const std::string& what() const { return what_; }  // that runs, or ran last
  [[nodiscard]] double fraction() const { return fraction_; }
  // What came of it, once; nullopt while it runs, after a cancellation, and when nothing ran.
  [[nodiscard]] std::optional<Done> take();

 private:
  std::function<void()> wake_;
  std::string what_;
  std::atomic<bool> stops_{false};
  std::atomic<double> fraction_{0};
  worker::Awaited<Done> running_;  // last: ends first
};

}  // namespace arthronaut::paint
