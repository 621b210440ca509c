#include "app/window/untaken_key.h"

#include <GLFW/glfw3.h>
#include <gtest/gtest.h>

namespace arthronaut::window {
namespace {

class UntakenKeys : public ::testing::Test {
 protected:
  UntakenKeys() {
    actions_.add({"plan.default", "Default plan", "", GLFW_KEY_N, 0, false, [] { return false; }, {}, {}});
  }
  std::string after(int key, bool is_opening = false) {
    UntakenKey untaken;
    untaken.note({key, 0, false}, actions_, {"app.", "plan."}, is_opening, 10);
    EXPECT_EQ(untaken.words(100), "") << "long after";
    return untaken.words(11);
  }
  widgets::Actions actions_;
};

// Whoever presses a key learns what became of it.
TEST_F(UntakenKeys, AreSaidWithTheirReason) {
  EXPECT_EQ(after(GLFW_KEY_N), "N did nothing: Default plan is not possible now");
  EXPECT_EQ(after(GLFW_KEY_N, true), "N did nothing: the case is still being opened. Press it again then");
}

// Of an action that knows why it is not possible, that too.
TEST_F(UntakenKeys, SayWhyWhereItIsKnown) {
  actions_.add({"app.cases",
                "Cases",
                "",
                GLFW_KEY_F5,
                0,
                false,
                [] { return false; },
                {},
                {},
                {},
                [] { return "end what runs here first"; }});
  EXPECT_EQ(after(GLFW_KEY_F5), "F5 did nothing: Cases is not possible now: end what runs here first");
}

// Enter opens, makes the bones, makes the case: "Open is not possible" of a series that cannot be imported
// was about a button that was not there.
TEST_F(UntakenKeys, OfSeveralThingsNoneIsNamed) {
  for (const auto& [id, label] :
       {std::pair("plan.accept", "Open"), std::pair("plan.import", "Make the bones")})
    actions_.add({id, label, "", GLFW_KEY_ENTER, 0, false, [] { return false; }, {}, {}});
  EXPECT_EQ(after(GLFW_KEY_ENTER), "Enter did nothing: there is nothing for it now");
}

TEST_F(UntakenKeys, NeedNoWordsWhereTheyAreForNothing) {
  EXPECT_EQ(after(GLFW_KEY_K), "");
  EXPECT_EQ(after(GLFW_KEY_ESCAPE), "");
  EXPECT_EQ(after(GLFW_KEY_LEFT_SHIFT, true), "");
}

// After a crash the program begins in Plan: whoever steps on the pedal learns where it leads.
TEST_F(UntakenKeys, OfThePedalSayWhereItLeads) {
  actions_.add({"navigate.next", "Next", "", GLFW_KEY_SPACE, 0, false, [] { return true; }, {}, {}});
  EXPECT_EQ(after(GLFW_KEY_SPACE), "Space did nothing: the pedal leads in Navigate (F2)");
}

// Words that do not hold any more stay as long as they take to read, and no longer.
TEST_F(UntakenKeys, GoOnceTheyDoNotHold) {
  bool can_run = false;
  widgets::Actions actions;
  actions.add({"plan.default", "Default plan", "", GLFW_KEY_N, 0, false, [&] { return can_run; }, {}, {}});
  UntakenKey untaken;
  untaken.note({GLFW_KEY_N, 0, false}, actions, {"plan."}, false, 10);
  untaken.look_again(actions, false, 11);
  EXPECT_NE(untaken.words(13), "");
  can_run = true;
  untaken.look_again(actions, false, 11);
  EXPECT_NE(untaken.words(11), "");
  EXPECT_EQ(untaken.words(12), "");
}

// A case may take longer to open than words are shown: nobody is to wait for what a key was never to do.
TEST_F(UntakenKeys, PressedWhileACaseOpensAreSaidUntilItIsOpenAndThen) {
  UntakenKey untaken;
  untaken.note({GLFW_KEY_N, 0, false}, actions_, {"plan."}, true, 20);
  for (double now_s = 20; now_s < 40; now_s += 0.1) untaken.look_again(actions_, true, now_s);
  EXPECT_EQ(untaken.words(40), "N did nothing: the case is still being opened. Press it again then");
  for (double now_s = 40; now_s < 43; now_s += 0.1) untaken.look_again(actions_, false, now_s);
  EXPECT_EQ(untaken.words(43), "N did nothing: the case was not open yet. Press it again");
  EXPECT_EQ(untaken.words(60), "");
}

// For some seconds, as a key: what threatens the operation must not be kept from the screen by it.
TEST_F(UntakenKeys, WhatIsDroppedWhileSomethingRunsIsSaidForSomeSeconds) {
  UntakenKey untaken;
  untaken.note_drop(10);
  untaken.look_again(actions_, false, 11);
  EXPECT_NE(untaken.words(12).find("Nothing that is dropped is taken"), std::string::npos);
  EXPECT_EQ(untaken.words(20), "");
}

TEST_F(UntakenKeys, AreForgottenWithTheNextThatIsTaken) {
  UntakenKey untaken;
  untaken.note({GLFW_KEY_N, 0, false}, actions_, {"plan."}, false, 10);
  untaken.forget();
  EXPECT_EQ(untaken.words(10), "");
}

}  // namespace
}  // namespace arthronaut::window
