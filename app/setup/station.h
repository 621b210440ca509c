// What the three steps of setting up have in common: each works on the pictures of one source, leads through
// itself by "next step", and ends with something that is adopted into the case or a verdict.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "app/setup/frame_feed.h"
#include "app/setup/live_run.h"
#include "app/widgets/controls.h"

namespace arthronaut::setup {

// One line of a panel: a state by shape, word and colour.
struct Row {
  widgets::Severity severity = widgets::Severity::Quiet;
  std::string name, text;
};

// What stands under the picture: what is wanted now, or what is wrong.
struct Band {
  widgets::Severity severity = widgets::Severity::Quiet;
  std::string headline, detail;
};

// What follows on a step that was taken.
enum class Then {
  Stay,
  StartAgain,  // from the first picture of the same source
  GoOn,        // this part of setting up is done
};

// "0.03"; what is less than half a hundredth is "under 0.01": nobody should read a nought there.
[[nodiscard]] inline std::string hundredths(double value) {
  return value < 0.005 ? "under 0.01" : widgets::fixed(value, 2);
}

// A value beside its limit: "0.3 mm  (at most 0.5)".
[[nodiscard]] inline Row limited(const std::string& name, bool is_good, const std::string& value,
                                 const std::string& limit) {
  return {is_good ? widgets::Severity::Good : widgets::Severity::Caution, name, value + "  (" + limit + ")"};
}

// A result that a pedal adopts has stood on the screen for so long: a foot that bounces adopts nothing that
// nobody has read.
inline constexpr double kReading_s = 2;

class Station {
 public:
  virtual ~Station() = default;
  virtual void open(const std::filesystem::path& case_folder) = 0;  // another case; ends what runs
  virtual void show() {}  // a step came into view: another one may have adopted something meanwhile
  virtual void start(const FeedSource& source) = 0;         // anew, from this source
  virtual void stop() = 0;                                  // ends what runs and forgets it
  virtual void release_source() = 0;                        // another mode may want the camera
  virtual void add_actions(widgets::Actions& actions) = 0;  // all are named "setup.ID..."
  virtual void draw(const widgets::Ui& ui, const widgets::Rect& area) = 0;
  [[nodiscard]] virtual bool awaits_text() const { return false; }  // see SetupView::awaits_text()
  // The two rows of buttons; ids of actions.
  [[nodiscard]] virtual std::vector<const char*> buttons() const = 0;
  [[nodiscard]] virtual Then take_next_step() = 0;          // once has_run()
  [[nodiscard]] virtual bool has_run() const = 0;           // a source was started
  [[nodiscard]] virtual bool is_busy() const = 0;           // pictures or a result are to come
  [[nodiscard]] virtual bool gives_pictures() const = 0;    // at least one came, and it has not ended
  [[nodiscard]] virtual bool is_of_now() const = 0;         // what is shown is what the source sees now
  [[nodiscard]] virtual std::string next_step() const = 0;  // in words, once has_run()
  [[nodiscard]] virtual Row adopted() const = 0;            // what the case has of this step
};

// One that works by a job of this kind.
template <typename Job>
class JobStation : public Station {
 public:
  [[nodiscard]] bool has_run() const final { return run_ != nullptr; }
  [[nodiscard]] bool gives_pictures() const final {
    return run_ != nullptr && status_.phase == FeedPhase::Running;
  }
  [[nodiscard]] bool is_of_now() const final { return gives_pictures() && status_.is_of_now(steady_now_s()); }

 protected:
  using Run = LiveRun<Job>;
  std::unique_ptr<Run> run_;
  typename Run::Status status_;  // of this frame
};

}  // namespace arthronaut::setup
