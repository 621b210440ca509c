#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <random>
#include <thread>

#include "app/plan/plan_view.h"
#include "app/scene/offscreen_context.h"
#include "app/widgets/key_clashes.h"
#include "planning/cases/case_image.h"
#include "planning/phantom/phantom_case.h"
#include "planning/phantom/phantom_knee.h"
#include "tests/temporary_folder.h"

namespace arthronaut::plan {
namespace {

// The phantom with images, on disk and open.
cases::Case imaged_knee(const std::filesystem::path& folder) {
  cases::Case knee = phantom::case_of(phantom::make_phantom_knee({.edge_length_mm = 4}), "keys");
  images::Volume volume;
  volume.size = {20, 20, 20};
  volume.modality_in_file = "CT";
  volume.lps_from_index.linear() *= 8;
  volume.lps_from_index.translation() = Eigen::Vector3d::Constant(-80);
  volume.values.assign(8000, 40.F);
  cases::save_case(folder, knee);
  knee.images.push_back({.file = "",
                         .modality = "CT",
                         .source = "NRRD",
                         .size = volume.size,
                         .spacing_mm = volume.spacing_mm()});
  cases::store_image(folder, 1, images::encoded(volume), knee.images.back());
  cases::save_case(folder, knee);
  return knee;
}

// Whatever was pressed before, in 600 presses of anything that can be pressed: no key ever does two things,
// so that no action is hidden behind another one's.
TEST(PlanKeys, NoTwoActionsShareOneWhateverWasPressed) {
  unsetenv("DISPLAY");
  const test::TemporaryFolder folder;
  const auto case_folder = folder / "Keys.arthro";
  open_case::PlanModel model(imaged_knee(case_folder));
  const scene::OffscreenContext context;
  PlanView view([&] { context.make_current(); }, [] {}, [] {},
                [](bones::Side) { return std::vector<std::string>{"said"}; });
  widgets::Actions actions;
  view.add_actions(actions);
  view.case_opened({&model, case_folder, ""});
  std::mt19937 random(5);
  std::map<std::string, int> pressed;
  for (int press = 0; press < 600; ++press) {
    std::vector<const widgets::Action*> possible;
    for (const widgets::Action& action : actions.all())
      if (action.can_run()) possible.push_back(&action);
    ASSERT_FALSE(possible.empty());
    std::ranges::shuffle(possible, random);
    // Every other time what was pressed least, so that the walk comes everywhere and not where luck has it.
    const auto least = std::ranges::min_element(
        possible, {}, [&](const widgets::Action* action) { return pressed[action->id]; });
    const widgets::Action& chosen = *(press % 2 == 0 ? *least : possible.front());
    const std::string id = chosen.id;
    ++pressed[id];
    chosen.run();
    const double now_s = 1000 + press;  // later than any movement
    view.tick(now_s);
    while (view.is_busy()) {
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
      view.tick(now_s);
    }
    for (const std::string& clash : widgets::key_clashes(actions, view.action_prefixes()))
      ADD_FAILURE() << "after " << id << ", " << clash;
    if (HasFailure()) break;
  }
  // The walk came to the states in which keys were taken twice.
  for (const char* id : {"plan.landmark_place", "plan.place", "plan.distance", "plan.stop_measuring",
                         "plan.stop_placing", "plan.bundles", "plan.other_bundle", "plan.volume_less"})
    EXPECT_GT(pressed[id], 0) << id;
}

// In a case that is only looked at nothing is offered that would change it, on any page; the landmarks can be
// gone through.
TEST(PlanKeys, OfACaseThatIsOnlyLookedAtNothingIsChanged) {
  unsetenv("DISPLAY");
  const test::TemporaryFolder folder;
  const auto case_folder = folder / "Looked at.arthro";
  open_case::PlanModel model(imaged_knee(case_folder));
  const scene::OffscreenContext context;
  PlanView view([&] { context.make_current(); }, [] {}, [] {},
                [](bones::Side) { return std::vector<std::string>{"said"}; });
  widgets::Actions actions;
  view.add_actions(actions);
  view.case_opened({&model, case_folder, "is open elsewhere"});
  const auto can = [&](const char* id) { return actions.find(id)->can_run(); };
  for (const char* page : {"plan.checks_page", "plan.landmarks_page", "plan.steps_page"}) {
    actions.find(page)->run();
    for (const char* id : {"plan.default", "plan.place", "plan.wider", "plan.aim_up", "plan.slide_left",
                           "plan.remove", "plan.landmark_confirm", "plan.landmark_confirm_all",
                           "plan.landmark_place", "plan.landmark_reset", "plan.roof", "plan.undo"})
      EXPECT_FALSE(can(id)) << id << " on " << page;
  }
  actions.find("plan.landmarks_page")->run();
  EXPECT_TRUE(can("plan.landmark_next"));
}

}  // namespace
}  // namespace arthronaut::plan
