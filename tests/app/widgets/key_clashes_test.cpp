#include "app/widgets/key_clashes.h"

#include <GLFW/glfw3.h>
#include <gmock/gmock.h>

namespace arthronaut::widgets {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

// Two clash when both can run, on one screen, with the same modifiers; and not else.
TEST(KeyClashes, AreOfActionsThatCanRunOnOneScreen) {
  bool both = true;
  Actions actions;
  const auto add = [&](const char* id, int key, int mods, std::function<bool()> when = {}) {
    actions.add({id, "", "", key, mods, false, std::move(when), {}, [] {}});
  };
  add("plan.place", GLFW_KEY_P, 0);
  add("plan.landmark", GLFW_KEY_P, 0, [&] { return both; });
  add("plan.print", GLFW_KEY_P, GLFW_MOD_CONTROL);
  add("paint.pick", GLFW_KEY_P, 0);
  add("plan.without", 0, 0);
  add("plan.without_too", 0, 0);
  EXPECT_THAT(key_clashes(actions, {"app.", "plan."}), ElementsAre("P: plan.place, plan.landmark"));
  EXPECT_THAT(key_clashes(actions, {"paint."}), IsEmpty());
  both = false;
  EXPECT_THAT(key_clashes(actions, {"plan."}), IsEmpty());
}

}  // namespace
}  // namespace arthronaut::widgets
