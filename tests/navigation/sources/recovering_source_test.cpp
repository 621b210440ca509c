#include "navigation/sources/recovering_source.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <thread>

#include "planning/geometry/error.h"

namespace arthronaut::sources {
namespace {

using testing::HasSubstr;

// What a source does with each of its frames: gives one of a width, has none yet, breaks, or ends.
enum class Does { Gives, GivesSmall, HasNone, Breaks, Ends };

class Scripted : public FrameSource {
 public:
  Scripted(std::vector<Does> script, const Opening& opening, std::int64_t at_ns, bool ends = false)
      : script_(std::move(script)), stamps_(opening.stamps), remark_(opening.remark), at_ns_(at_ns) {
    info_.name = "scope";
    info_.image_size_px = {64, 48};
    info_.kind = SourceKind::Live;
    info_.ends = ends;
  }
  const SourceInfo& info() const override { return info_; }
  camera::FramePtr next() override {
    const Does does = next_ < script_.size() ? script_[next_++] : Does::Ends;
    if (does == Does::Breaks) throw DeviceError("scope: unplugged");
    remark_ = does == Does::HasNone ? "scope: no key frame" : "";
    if (does == Does::Ends || does == Does::HasNone) return nullptr;
    auto frame = std::make_shared<camera::Frame>();
    frame->width = does == Does::Gives ? 64 : 32;
    frame->height = 48;
    stamps_.put_on(*frame, at_ns_ += 1'000'000, camera::CaptureClock::Driver);
    return frame;
  }

 private:
  std::vector<Does> script_;
  LiveStamps& stamps_;
  std::string& remark_;
  std::int64_t at_ns_;
  std::size_t next_ = 0;
  SourceInfo info_;
};

// Broken twice, once not to be opened, once ended: pictures go on, their numbers and times too.
TEST(RecoveringSource, GoesOnWhereItWas) {
  int opened = 0;
  const auto source = recovering([&](const Opening& opening) -> std::unique_ptr<FrameSource> {
    EXPECT_EQ(opening.is_again, opened > 0);
    const std::int64_t at_ns = 1'000'000'000LL * ++opened;
    if (opened == 2) throw DeviceError("scope: nobody there");
    if (opened == 1)
      return std::make_unique<Scripted>(std::vector{Does::Gives, Does::Gives, Does::Breaks}, opening, at_ns);
    return std::make_unique<Scripted>(std::vector{Does::Gives, Does::Ends}, opening, at_ns);
  });
  std::int64_t before_ns = -1;
  for (int i = 0; i < 4; ++i) {
    const camera::FramePtr frame = source->next();
    ASSERT_NE(frame, nullptr);
    EXPECT_EQ(frame->index, i);
    EXPECT_GT(frame->timestamp_ns, before_ns);
    before_ns = frame->timestamp_ns;
    EXPECT_EQ(source->info().line->trouble(), "");
  }
  EXPECT_EQ(opened, 4);
}

// Pictures that are dated as of an hour ago, once: the time goes on with them, and does not wait for an hour.
TEST(LiveStamps, Hazard3GoOnWithDatesThatWentBack) {
  constexpr std::int64_t kInterval_ns = 33'333'333, kHour_ns = 3'600'000'000'000;
  LiveStamps stamps;
  std::vector<std::int64_t> times_ns;
  for (std::int64_t i = 0; i < 90; ++i) {
    camera::Frame frame;
    stamps.put_on(frame, 2 * kHour_ns + i * kInterval_ns - (i < 30 ? 0 : kHour_ns),
                  camera::CaptureClock::Driver);
    EXPECT_EQ(frame.captured_ns, 2 * kHour_ns + i * kInterval_ns - (i < 30 ? 0 : kHour_ns));
    times_ns.push_back(frame.timestamp_ns);
  }
  for (std::size_t i = 1; i < times_ns.size(); ++i)
    EXPECT_EQ(times_ns[i] - times_ns[i - 1], i == 30 ? 1 : kInterval_ns) << i;
}

// A pipeline that reads a file would begin again at its beginning, as if it went on.
TEST(RecoveringSource, WhatComesToAnEndIsNotBegunAnew) {
  int opened = 0;
  const auto source = recovering([&](const Opening& opening) {
    ++opened;
    return std::make_unique<Scripted>(std::vector{Does::Gives, Does::Breaks}, opening, 5, true);
  });
  ASSERT_NE(source->next(), nullptr);
  EXPECT_THROW((void)source->next(), DeviceError);
  EXPECT_EQ(opened, 1);
}

TEST(RecoveringSource, PassesOverAnotherSizeAndSaysSo) {
  const auto source = recovering([&](const Opening& opening) {
    return std::make_unique<Scripted>(
        std::vector{Does::Gives, Does::GivesSmall, Does::GivesSmall, Does::Breaks}, opening, 5);
  });
  ASSERT_NE(source->next(), nullptr);
  std::thread ender([line = source->info().line] {
    for (int i = 0; i < 1000 && line->trouble().empty(); ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    EXPECT_THAT(line->trouble(), HasSubstr("scope: "));
    line->end();
  });
  // 64 pixels wide or nothing.
  while (const camera::FramePtr frame = source->next()) EXPECT_EQ(frame->width, 64);
  ender.join();
}

// It says why and is asked again, since opening it anew would lose what it waits for; and it can be ended.
TEST(RecoveringSource, WaitsForOneThatIsThereWithoutAPicture) {
  int opened = 0;
  const auto source = recovering([&](const Opening& opening) {
    ++opened;
    std::vector<Does> script(100'000'000, Does::HasNone);
    script[0] = script[2] = Does::Gives;
    return std::make_unique<Scripted>(std::move(script), opening, 5);
  });
  ASSERT_NE(source->next(), nullptr);
  ASSERT_NE(source->next(), nullptr);
  EXPECT_EQ(source->info().line->trouble(), "");
  std::string told;
  std::thread ender([&, line = source->info().line] {
    while (told.empty()) told = line->trouble();
    line->end();
  });
  EXPECT_EQ(source->next(), nullptr);
  ender.join();
  EXPECT_EQ(told, "scope: no key frame");
  EXPECT_EQ(opened, 1);
}

// Another camera in the place of the first one gives no picture, whatever its size, nor does one that no
// longer says who it is; the first one does when it is there again.
TEST(RecoveringSource, HazardAnotherCameraInItsPlaceIsNotTakenForIt) {
  for (const std::string& other : {std::string("uvc, card, serial 2"), std::string()}) {
    int opened = 0;
    const auto source = recovering([&](const Opening& opening) {
      ++opened;
      opening.identity = opened == 2 ? other : "uvc, card, serial 1";
      return std::make_unique<Scripted>(std::vector{Does::Gives, Does::Breaks}, opening,
                                        1'000'000'000LL * opened);
    });
    ASSERT_NE(source->next(), nullptr);
    std::string told;
    std::thread looker([&, line = source->info().line] {
      for (int i = 0; i < 5000 && told.find("another camera") == std::string::npos; ++i) {
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
        told = line->trouble();
      }
    });
    const camera::FramePtr frame = source->next();
    looker.join();
    ASSERT_NE(frame, nullptr);
    EXPECT_EQ(frame->captured_ns, 3'001'000'000LL) << "nothing of the second one";
    EXPECT_THAT(told, testing::AllOf(HasSubstr("another camera is there"), HasSubstr("serial 1")));
    EXPECT_EQ(source->info().line->trouble(), "");
  }
}

// Of a source that never said who it is nobody can tell.
TEST(RecoveringSource, IsKnownByItsSizeAloneWhereItSaysNothing) {
  int opened = 0;
  const auto source = recovering([&](const Opening& opening) {
    if (++opened == 2) opening.identity = "now it does";
    return std::make_unique<Scripted>(std::vector{Does::Gives, Does::Breaks}, opening, opened);
  });
  EXPECT_NE(source->next(), nullptr);
  EXPECT_NE(source->next(), nullptr);
  EXPECT_EQ(opened, 2);
}

// Who names a source that is not there wants to know at once.
TEST(RecoveringSource, CannotBeginBroken) {
  EXPECT_THROW((void)recovering([](const Opening&) -> std::unique_ptr<FrameSource> {
                 throw DeviceError("scope: nobody there");
               }),
               DeviceError);
}

// Told to end while it waits for a source that never comes back.
TEST(RecoveringSource, EndsWhenItIsTold) {
  bool is_first = true;
  const auto source = recovering([&](const Opening& opening) -> std::unique_ptr<FrameSource> {
    if (!std::exchange(is_first, false)) throw DeviceError("scope: nobody there");
    return std::make_unique<Scripted>(std::vector{Does::Breaks}, opening, 5);
  });
  std::thread ender([line = source->info().line] {
    while (line->trouble().empty()) std::this_thread::yield();
    line->end();
  });
  EXPECT_EQ(source->next(), nullptr);
  ender.join();
}

}  // namespace
}  // namespace arthronaut::sources
