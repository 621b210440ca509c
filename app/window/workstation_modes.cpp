// The modes of the window, and what each is given of the others.
#include <utility>

#include "app/navigate/known_streams.h"
#include "app/navigate/navigate_view.h"
#include "app/plan/plan_view.h"
#include "app/review/review_view.h"
#include "app/setup/capture_panels.h"
#include "app/setup/setup_view.h"
#include "app/training/training_view.h"
#include "app/window/workstation_window.h"

namespace arthronaut::window {

using widgets::GraphicsWindow;

void WorkstationWindow::make_modes() {
  const auto make_current = [this] { window_.make_current(); };
  const auto wake = [] { GraphicsWindow::wake(); };
  const sources::DeviceTurns camera_turns;  // Set up and Navigate open one camera after the other
  constexpr std::size_t kNavigate = 2;
  auto plan = std::make_unique<plan::PlanView>(
      make_current, wake, [this] { show_paint(); }, [this](bones::Side side) { return say_side(side); });
  plan_ = plan.get();
  modes_.push_back(std::move(plan));
  modes_.push_back(std::make_unique<setup::SetupView>(
      wake, [this] { show(kNavigate); }, camera_turns,
      setup::SetupView::Streams{[] { return navigate::load_known_streams(navigate::known_streams_file()); },
                                [](const std::string& address) {
                                  navigate::note_stream(navigate::known_streams_file(), address);
                                }}));
  auto theatre = std::make_unique<navigate::NavigateView>(
      make_current, wake, camera_turns,
      [this](navigate::Elsewhere where) {
        const bool is_plan = where == navigate::Elsewhere::Plan;
        actions_.run(is_plan ? "mode.plan" : "mode.setup");
      },
      std::make_shared<navigate::PoseSharing>(room_.igtl_port(), room_.igtl_network()
                                                                     ? openigtlink::Reach::Network
                                                                     : openigtlink::Reach::ThisMachine));
  navigate::NavigateView* const screen = theatre.get();
  modes_.push_back(std::move(theatre));
  auto review =
      std::make_unique<review::ReviewView>(make_current, wake, [this, screen](bones::BoneKind bone) {
        screen->turn_to(bone);
        show(kNavigate);
      });
  review_ = review.get();
  modes_.push_back(std::move(review));
  modes_.push_back(std::make_unique<training_mode::TrainingView>(
      training_mode::Theatre{
          .screen = screen,
          .refusal = [screen](bones::BoneKind bone) { return screen->refusal_to_lend(bone); },
          .begin_anew = [screen](const mode::OpenCase& opened) { screen->case_opened(opened); },
          .start =
              [screen](bones::BoneKind bone, theatre::TheatreSource source,
                       std::function<std::string()> next_step) {
                screen->lend(bone, std::move(source), std::move(next_step));
              },
          .live = [screen] { return screen->live(); },
          .setup = [screen] { return screen->setup_in_use(); },
          .ask = [screen](operation::Command command) { screen->ask(std::move(command)); },
          .end = [screen] { screen->end_source(); }},
      [texture = std::make_shared<widgets::VideoTexture>()](
          const widgets::Ui& ui, const widgets::Rect& area, const calibration::CalibrateStatus& status,
          float free_px) { return setup::draw_exercise(ui, area, *texture, status, free_px); },
      training::training_file()));
}

}  // namespace arthronaut::window
