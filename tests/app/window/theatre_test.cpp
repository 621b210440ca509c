// An operation in the real window, worked from outside as a surgeon and bad luck do: sources that fail, a
// plan that is edited meanwhile, a stream that is typed.
#include "tests/app/window/theatre.h"

#include <gtest/gtest.h>

#include <fstream>

namespace arthronaut::test {
namespace {

// What was registered in a simulation guides nothing of a video: it is void, and the screen says why. Both
// sessions run again to the same states, the registration and its end with them.
TEST_F(Theatre, Hazard1ARegistrationOfASimulationIsVoidInAVideo) {
  adopt_real_scope();
  write_clip(90);
  const VirtualDisplay display(1280, 720);
  RunningWorkstation app(display, folder_.path());
  start_simulation(app);
  ASSERT_TRUE(app.wait_for_state("standing", "stands", 400));
  const std::string simulated = app.state("journal");
  ASSERT_TRUE(app.hold_until("o", "source_kind", "RECORDING"));
  EXPECT_TRUE(app.wait_for_state("standing", "void", 60));
  EXPECT_NE(app.state("guidance"), "valid");
  EXPECT_TRUE(
      becomes([&] { return app.state("detail").find("another kind of pictures") != std::string::npos; }, 60))
      << app.state("detail");
  EXPECT_EQ(app.state("guidance"), "Registration void");
  const std::string of_video = app.state("journal");
  EXPECT_NE(of_video, simulated);
  EXPECT_EQ(app.hold_to_exit("ctrl+q", 60), 0);
  expect_same_states(simulated);
  expect_same_states(of_video);
}

// A source that fails starts no other kind, whatever ran before it and however often the pedal is pressed.
TEST_F(Theatre, Hazard2AfterASourceThatFailedThePedalStartsNoOtherKind) {
  adopt_real_scope();
  std::ofstream(case_folder() / "broken.mkv") << "no video at all";
  const VirtualDisplay display(1280, 720);
  RunningWorkstation app(display, folder_.path());
  show_navigate(app);
  // A real case offers no simulation unasked.
  EXPECT_TRUE(app.wait_for_state("next", "open the next video"));
  app.press("s");
  ASSERT_TRUE(app.wait_for_state("picture", "live", 120));
  EXPECT_EQ(app.state("source_kind"), "SIMULATION");
  ASSERT_TRUE(app.hold_until("o", "guidance", "Source failed", 60));
  ASSERT_TRUE(app.wait_for_state("source_kind", "RECORDING"));
  for (int press = 0; press < 3; ++press) {
    app.press("space");
    // Long enough for a simulation to have shown its first picture.
    EXPECT_FALSE(becomes([&] { return app.state("source_kind") != "RECORDING"; }, 2)) << press;
    EXPECT_TRUE(app.wait_for_state("guidance", "Source failed", 60));
    EXPECT_EQ(app.state("next").find("simula"), std::string::npos) << app.state("next");
  }
  app.press("ctrl+q");
  EXPECT_EQ(app.wait_for_exit(60), 0);
}

// A plan that is edited while the operation runs is offered, not taken: the one in force stays until the
// pedal takes the other one over.
TEST_F(Theatre, Hazard5AnEditedPlanWaitsUntilItIsTakenOver) {
  const VirtualDisplay display(1280, 720);
  RunningWorkstation app(display, folder_.path());
  start_simulation(app);
  EXPECT_TRUE(app.wait_for_state("plan", "in force"));
  app.press("F1");
  ASSERT_TRUE(app.wait_for_state("mode", "plan"));
  app.press("Right");
  ASSERT_TRUE(app.wait_for_state("undo", "Aim the femoral tunnel"));
  app.press("F2");
  ASSERT_TRUE(app.wait_for_state("mode", "navigate"));
  ASSERT_TRUE(app.wait_for_state("plan", "edited"));
  ASSERT_TRUE(app.wait_for_state("next", "the plan was edited: take it over"));
  EXPECT_EQ(app.state("picture"), "live");
  app.press("space");  // nobody has read it yet
  ASSERT_TRUE(app.wait_for_state("pedal", "acts"));
  EXPECT_EQ(app.state("missing").find("now "), 0U) << app.state("missing");
  EXPECT_EQ(app.state("plan"), "edited");
  app.press("space");
  EXPECT_TRUE(app.wait_for_state("plan", "in force"));
  EXPECT_EQ(app.hold_to_exit("ctrl+q", 60), 0);
}

// Two tunnels in the bone: nothing starts by the pedal before one is chosen; the other one is offered while a
// source runs, and guides once it is taken over.
TEST_F(Theatre, Hazard38OfTwoTunnelsOneIsChosenAndNamed) {
  const VirtualDisplay display(1280, 720);
  RunningWorkstation app(display, folder_.path());
  ASSERT_TRUE(app.wait_for_state("case", "open", 120));
  app.press("b");
  ASSERT_TRUE(app.wait_for_state("undo", "Plan two bundles in the femur"));
  app.press("F2");
  ASSERT_TRUE(app.wait_for_state("mode", "navigate"));
  ASSERT_TRUE(app.wait_for_state("next", "choose the tunnel femur AM (1); V: PL (2)"));
  app.press("space");
  EXPECT_EQ(app.state("tunnel"), "none") << "nobody has read it yet";
  EXPECT_EQ(app.state("picture"), "none");
  // By three pedals alone: the one for the overlay goes on to the other one, the next step takes it.
  app.press("v");
  ASSERT_TRUE(app.wait_for_state("next", "choose the tunnel femur PL (2); V: AM (1)"));
  app.press("v");
  ASSERT_TRUE(app.wait_for_state("next", "choose the tunnel femur AM (1); V: PL (2)"));
  ASSERT_TRUE(app.wait_for_state("pedal", "acts"));
  app.press("space");
  ASSERT_TRUE(app.wait_for_state("tunnel", "femur AM"));
  ASSERT_TRUE(app.wait_for_state("next", "start the simulated operation"));
  app.press("space");
  ASSERT_TRUE(app.wait_for_state("picture", "live", 120));
  app.press("2");
  ASSERT_TRUE(app.wait_for_state("plan", "edited"));
  EXPECT_EQ(app.state("tunnel"), "femur AM");
  ASSERT_TRUE(app.wait_for_state("next", "take over the tunnel femur PL"));
  ASSERT_TRUE(app.wait_for_state("pedal", "acts"));
  app.press("space");
  EXPECT_TRUE(app.wait_for_state("tunnel", "femur PL"));
  EXPECT_EQ(app.hold_to_exit("ctrl+q", 60), 0);
}

// A stream is named in the window: what is typed is no key of the screen, what is no address is told, and the
// kind of source is live, with all that it asks for. The next time it is offered.
TEST_F(Theatre, AStreamIsNamedInTheWindowAndIsLive) {
  adopt_real_scope();
  const VirtualDisplay display(1280, 720);
  {
    RunningWorkstation app(display, folder_.path());
    show_navigate(app);
    app.press("k");
    ASSERT_TRUE(app.wait_for_state("cameras", "address"));
    app.type("desk");
    app.press("Return");
    EXPECT_EQ(app.state("cameras"), "address");
    EXPECT_EQ(app.state("depth_stop"), "none") << "E is no key while it is typed";
    EXPECT_EQ(app.state("view"), "as it came");
    // The field takes two frames to be typed in again.
    const auto closes = [&] {
      app.press("Escape");
      return app.wait_for_state("cameras", "none", 2);
    };
    ASSERT_TRUE(becomes(closes, 20));
    app.press("Return");  // the menu, which would stand over the field
    ASSERT_TRUE(app.wait_for_state("menu", "open"));
    app.press("k");
    EXPECT_TRUE(app.wait_for_state("menu", "closed"));
    ASSERT_TRUE(app.wait_for_state("cameras", "address"));
    app.type("gst:videotestsrc is-live=true ! video/x-raw,width=1920,height=1080,framerate=20/1 ! appsink");
    app.press("Return");
    ASSERT_TRUE(app.wait_for_state("time_out", "due", 60));
    EXPECT_TRUE(app.wait_for_state("source_kind", "LIVE", 60)) << "with its first picture";
    ASSERT_TRUE(app.wait_for_state("next", "time-out: confirm patient, side, plan and tools", 60));
    // A press that was meant for what stood there before confirms nothing: the sheet is to be read first.
    EXPECT_EQ(app.state("pedal"), "waits");
    app.press("space");
    EXPECT_FALSE(app.wait_for_state("time_out", "confirmed", 0.5));
    // Nor does one that was given while the menu lay over the sheet, however long: it shows the sheet.
    app.press("Return");
    ASSERT_TRUE(app.wait_for_state("menu", "open"));
    EXPECT_FALSE(app.wait_for_state("menu", "closed", 2.5));
    app.press("space");
    EXPECT_TRUE(app.wait_for_state("menu", "closed"));
    EXPECT_EQ(app.state("time_out"), "due");
    ASSERT_TRUE(app.wait_for_state("pedal", "waits", 2));
    ASSERT_TRUE(app.wait_for_state("pedal", "acts", 20));
    // By the pedals alone: the other medium, the same pictures again, and the time-out anew.
    app.press("v");
    ASSERT_TRUE(app.wait_for_state("next", "the pictures have ended: open the camera again", 20));
    EXPECT_EQ(app.state("notice"), "The next pictures look through air");
    app.press("space");
    ASSERT_TRUE(becomes([&] { return app.state("cameras").starts_with("gst:videotestsrc"); }, 20));
    app.press("space");
    ASSERT_TRUE(app.wait_for_state("next", "time-out: confirm patient, side, plan and tools", 60));
    ASSERT_TRUE(app.wait_for_state("pedal", "acts", 20));
    EXPECT_EQ(app.state("medium"), "air");
    app.press("space");
    EXPECT_TRUE(app.wait_for_state("time_out", "confirmed"));
    EXPECT_NE(app.state("guidance"), "valid");
    EXPECT_EQ(app.hold_to_exit("ctrl+q", 60), 0);
  }
  RunningWorkstation app(display, folder_.path());
  show_navigate(app);
  if (app.state("resume") != "none") app.press("Escape");
  app.press("k");
  ASSERT_TRUE(becomes([&] { return app.state("cameras").starts_with("gst:videotestsrc"); }, 20));
  app.press("Escape");
  EXPECT_TRUE(app.wait_for_state("cameras", "none"));
  EXPECT_EQ(app.hold_to_exit("ctrl+q", 60), 0);
}

// What the depth stop reads is typed, shown and kept; digits of it are no keys of the screen. A marker that
// was placed anew is one key, held.
TEST_F(Theatre, Hazard7TheDepthStopIsTypedAndTheMarkerPlacedAnewIsAKey) {
  const VirtualDisplay display(1280, 720);
  RunningWorkstation app(display, folder_.path());
  start_simulation(app);
  app.press("e");
  ASSERT_TRUE(app.wait_for_widget("navigate.depth_field"));
  app.type("210");
  app.press("Return");
  EXPECT_FALSE(becomes([&] { return app.state("depth_stop") != "none"; }, 1)) << "no drill is so long";
  app.type("21,5");  // as most of Europe writes it
  app.press("Return");
  ASSERT_TRUE(app.wait_for_state("depth_stop", "21.5"));
  EXPECT_EQ(app.state("picture"), "live");
  // Opened by a slip, the field lets the pedal go again.
  app.press("e");
  ASSERT_TRUE(app.wait_for_state("depth_field", "open"));
  app.press("Prior");
  EXPECT_TRUE(app.wait_for_state("depth_field", "closed"));
  EXPECT_EQ(app.state("back_at"), "");
  app.press("n");
  EXPECT_TRUE(app.wait_for_state("hold", "Hold N to say that the marker was placed anew (let go)"));
  ASSERT_TRUE(becomes([&] { return !app.state("strokes").empty() && app.state("strokes") != "0"; }, 240));
  EXPECT_TRUE(app.hold_until("n", "strokes", "0", 60));
  EXPECT_EQ(app.hold_to_exit("ctrl+q", 60), 0);
}

// What is missing is said in every picture while strokes are collected, however many words it takes: in large
// letters, or else in smaller ones.
TEST_F(Theatre, WhatTheStrokesLackIsNeverLeftOut) {
  const VirtualDisplay display(1280, 720);
  RunningWorkstation app(display, folder_.path());
  start_simulation(app);
  ASSERT_TRUE(app.wait_for_state("standing", "stands", 400));
  int said = 0;
  for (const DrawnFrame& frame : app.frames()) {
    const auto advice = frame.states.find("advice");
    if (advice == frame.states.end()) continue;
    EXPECT_TRUE(said == 0 || !advice->second.empty()) << "after " << said;
    said += advice->second.empty() ? 0 : 1;
  }
  EXPECT_GT(said, 1);
  EXPECT_EQ(app.hold_to_exit("ctrl+q", 60), 0);
}

}  // namespace
}  // namespace arthronaut::test
