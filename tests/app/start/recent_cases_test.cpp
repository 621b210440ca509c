#include "app/start/recent_cases.h"

#include <gtest/gtest.h>

#include <fstream>

#include "tests/temporary_folder.h"

namespace arthronaut::start {
namespace {

// The newest first, each once, twenty at most; read back as they were noted.
TEST(RecentCases, TheNewestIsFirstAndEachStandsOnce) {
  const test::TemporaryFolder folder;
  const auto file = folder / "arthronaut" / "recent.json";
  EXPECT_TRUE(load_recent_cases(file).empty());
  for (int i = 0; i < 25; ++i)
    note_recent_case(file, {folder / ("Knee" + std::to_string(i) + ".arthro"), "Knee " + std::to_string(i),
                            "left", "2026-01-31T12:00:00Z"});
  note_recent_case(file, {folder / "Knee20.arthro", "Knee 20", "right", "2026-02-01T12:00:00Z"});
  const auto recent = load_recent_cases(file);
  ASSERT_EQ(recent.size(), 20U);
  EXPECT_EQ(recent[0].name, "Knee 20");
  EXPECT_EQ(recent[0].side, "right");
  EXPECT_EQ(recent[0].opened_utc, "2026-02-01T12:00:00Z");
  EXPECT_EQ(recent[1].name, "Knee 24");
  EXPECT_EQ(recent[5].name, "Knee 19") << "20 is not there a second time";
}

// The list is a convenience: one that is broken is an empty one, and is mended by the next case.
TEST(RecentCases, ABrokenListIsNoHarm) {
  const test::TemporaryFolder folder;
  const auto file = folder / "recent.json";
  std::ofstream(file) << "{ \"format\": ";
  EXPECT_TRUE(load_recent_cases(file).empty());
  note_recent_case(file, {folder / "A.arthro", "A", "left", "2026-01-31T12:00:00Z"});
  EXPECT_EQ(load_recent_cases(file).size(), 1U);
  note_recent_case("/proc/nowhere/recent.json", {folder / "A.arthro", "A", "left", ""});  // does not throw
}

TEST(RecentCases, WhenInWords) {
  const std::string now = "2026-02-01T12:00:00Z";
  EXPECT_EQ(when_in_words("2026-02-01T11:59:10Z", now), "just now");
  EXPECT_EQ(when_in_words("2026-02-01T11:18:00Z", now), "42 min ago");
  EXPECT_EQ(when_in_words("2026-02-01T02:00:00Z", now), "10 h ago");
  EXPECT_EQ(when_in_words("2026-01-31T11:00:00Z", now), "yesterday");
  EXPECT_EQ(when_in_words("2026-01-29T11:00:00Z", now), "3 days ago");
  EXPECT_EQ(when_in_words("2025-12-24T11:00:00Z", now), "2025-12-24");
  EXPECT_EQ(when_in_words("2026-02-03T11:00:00Z", now), "2026-02-03") << "a clock that was set back";
}

}  // namespace
}  // namespace arthronaut::start
