// The self-check in fluid: five seconds of a ruler with two markers tell whether the camera measures rightly.
#pragma once

#include <functional>
#include <memory>

#include "app/case/case_fluid.h"
#include "app/setup/fluid_display.h"
#include "app/setup/setup_panels.h"
#include "navigation/sources/background_end.h"

namespace arthronaut::setup {

class FluidStation : public JobStation<FluidJob> {
 public:
  // wake: ends the window's wait for input; called from other threads. ending: takes what is stopped.
  FluidStation(std::function<void()> wake, sources::BackgroundEnd& ending)
      : wake_(std::move(wake)), ending_(ending) {}

  void open(const std::filesystem::path& case_folder) override;
  void show() override;
  void start(const FeedSource& source) override;
  void stop() override;
  void release_source() override;
  void add_actions(widgets::Actions& actions) override;
  void draw(const widgets::Ui& ui, const widgets::Rect& area) override;
  [[nodiscard]] std::vector<const char*> buttons() const override;
  [[nodiscard]] Then take_next_step() override;
  [[nodiscard]] bool is_busy() const override;
  [[nodiscard]] std::string next_step() const override { return display_.next_text; }
  [[nodiscard]] Row adopted() const override { return checked_; }

 private:
  void keep_verdict();
  void read_standing();  // what the case's last verdict says of the medium
  void draw_picture_with_ruler(const widgets::Ui& ui, const widgets::Rect& area);
  void draw_models(const widgets::Ui& ui, const widgets::Rect& area);

  std::filesystem::path case_folder_;
  std::function<void()> wake_;
  sources::BackgroundEnd& ending_;
  double refractive_index_ = 1;
  std::string camera_sha256_;  // of the camera.json when the run began
  FluidDisplay display_;       // of this frame
  std::string standing_;       // the same in a sentence
  Row checked_;                // what the case's last verdict says of this medium
  Row daily_check_;            // what became of the day's check of accuracy; no name: nothing yet
  std::shared_ptr<const calibration::FluidCheckSummary> kept_;  // that was looked at last
  widgets::VideoTexture picture_;
};

}  // namespace arthronaut::setup
