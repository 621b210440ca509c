// What holds the screen's rate and how soon it follows a key, counted in frames and bytes instead of seconds,
// which are the machine's: on the real window.
#include <algorithm>
#include <cstdlib>
#include <optional>

#include "tests/app/window/theatre.h"

namespace arthronaut::test {
namespace {

// The 3D view is drawn once more, smoothly, when it has come to rest.
bool rests(const RunningWorkstation& app) {
  const auto frames = app.frames();
  if (frames.size() < 4) return false;
  const auto last = frames.end() - 4;
  return std::all_of(last, frames.end(),
                     [](const DrawnFrame& frame) { return frame.number("scenes") == 0; }) &&
         frames.back().number("shown_s") > last->number("shown_s") + 0.5;
}

// A key is seen in the frame that takes it, whatever a frame costs: nothing that it does waits for another
// one.
TEST_F(Theatre, Hazard34AKeyIsSeenInTheFrameThatTakesIt) {
  const VirtualDisplay display(1280, 720);
  RunningWorkstation app(display, folder_.path());
  start_simulation(app);
  struct Key {
    const char *key, *state;
  };
  for (const Key& key : {Key{"v", "overlay"}, Key{"Return", "menu"}, Key{"u", "view"}, Key{"h", "layout"}}) {
    for (int times = 0; times < 2; ++times) {
      const std::size_t before = app.frames().size();
      app.press(key.key);
      const auto taking = [&]() -> std::optional<DrawnFrame> {
        const auto frames = app.frames();
        for (std::size_t i = before; i < frames.size(); ++i)
          if (frames[i].number("keys") > 0) return frames[i];
        return std::nullopt;
      };
      ASSERT_TRUE(becomes([&] { return taking().has_value(); }, 40)) << key.key;
      const DrawnFrame frame = *taking();
      EXPECT_TRUE(frame.states.contains(key.state)) << key.key;
    }
  }
  EXPECT_EQ(app.hold_to_exit("ctrl+q", 60), 0);
}

// A picture goes to OpenGL once, and no more of it than its colours take.
TEST_F(Theatre, Hazard34APictureIsUploadedOnce) {
  const VirtualDisplay display(1280, 720);
  RunningWorkstation app(display, folder_.path());
  start_simulation(app);
  const auto pictures_of = [](const std::vector<DrawnFrame>& frames) {
    std::map<double, double> bytes;  // by picture
    for (const DrawnFrame& frame : frames)
      if (frame.numbers.contains("picture")) bytes[frame.number("picture")] += frame.number("uploaded_bytes");
    return bytes;
  };
  ASSERT_TRUE(becomes([&] { return pictures_of(app.frames()).size() > 5; }, 120));
  for (int times = 0; times < 4; ++times) app.press("v");
  for (const auto& [picture, bytes] : pictures_of(app.frames())) {
    EXPECT_GT(bytes, 0) << picture;
    EXPECT_LE(bytes, 4 * 1080 * 1920) << picture;
  }
  EXPECT_EQ(app.hold_to_exit("ctrl+q", 60), 0);
}

// Where nothing has changed nothing is computed again: neither the bone in 3D nor the picture.
TEST_F(Theatre, Hazard34WhatStandsStillIsNotDrawnAgain) {
  const VirtualDisplay display(1280, 720);
  RunningWorkstation app(display, folder_.path());
  start_simulation(app);
  ASSERT_TRUE(app.hold_until("Escape", "guidance", "The pictures have ended"));
  ASSERT_TRUE(becomes([&] { return rests(app); }, 60));
  const std::size_t before = app.frames().size();
  for (int times = 0; times < 4; ++times) {
    const std::string was = app.state("overlay");
    app.press("v");
    ASSERT_TRUE(becomes([&] { return app.state("overlay") != was; }, 40));
  }
  const auto frames = app.frames();
  ASSERT_GE(frames.size(), before + 4);
  for (std::size_t i = before; i < frames.size(); ++i) {
    EXPECT_EQ(frames[i].number("scenes"), 0) << i - before;
    EXPECT_EQ(frames[i].number("uploaded_bytes"), 0) << i - before;
  }
  EXPECT_EQ(app.hold_to_exit("ctrl+q", 60), 0);
}

// Where the processor draws, only what changed is drawn: what stands on the screen after pictures, menus and
// text that came and went is what a window draws that was covered and knows nothing of what stood there. The
// mark that moves all the time is the one difference.
TEST_F(Theatre, Hazard34AScreenDrawnInPartsIsTheWholeScreen) {
  const VirtualDisplay display(1280, 720);
  RunningWorkstation app(display, folder_.path());
  start_simulation(app);
  ASSERT_TRUE(app.hold_until("Escape", "guidance", "The pictures have ended"));
  for (const char* key : {"Return", "h", "u", "Return", "F10", "u", "F10", "v"}) app.press(key);
  ASSERT_TRUE(becomes([&] { return rests(app); }, 60));
  const Picture in_parts = app.screenshot();
  const long all_px = 1280L * 720;
  const auto frames = app.frames();
  EXPECT_LT(frames.back().number("drawn_px"), all_px / 3);
  const std::size_t before = frames.size();
  const std::string window = "DISPLAY=" + display.name() +
                             " xdotool search --name Arthronaut windowunmap --sync %@ windowmap --sync %@";
  ASSERT_EQ(std::system(window.c_str()), 0);
  // A few frames are drawn whole; the next ones in parts again.
  const auto was_drawn_whole = [&] {
    const auto since = app.frames();
    return std::any_of(since.begin() + static_cast<std::ptrdiff_t>(before), since.end(),
                       [&](const DrawnFrame& frame) { return frame.number("drawn_px") == all_px; });
  };
  ASSERT_TRUE(becomes(was_drawn_whole, 20));
  ASSERT_TRUE(becomes([&] { return rests(app); }, 60));
  const Picture whole = app.screenshot();
  int left = 1280, right = 0, top = 720, bottom = 0;
  for (int y = 0; y < 720; ++y)
    for (int x = 0; x < 1280; ++x) {
      if (in_parts.at(x, y) == whole.at(x, y)) continue;
      left = std::min(left, x);
      right = std::max(right, x);
      top = std::min(top, y);
      bottom = std::max(bottom, y);
    }
  EXPECT_LE(right - left, 48) << left << ", " << top << " to " << right << ", " << bottom;
  EXPECT_LE(bottom - top, 48);
  EXPECT_EQ(app.hold_to_exit("ctrl+q", 60), 0);
}

}  // namespace
}  // namespace arthronaut::test
