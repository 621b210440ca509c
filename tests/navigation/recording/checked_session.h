// A session that is recorded, damaged and checked.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sqlite3.h>

#include <chrono>
#include <fstream>
#include <iterator>
#include <random>
#include <thread>

#include "navigation/recording/session_check.h"
#include "tests/navigation/recording/recorded_frames.h"
#include "tests/temporary_folder.h"

namespace arthronaut::recording {

// Noise, so that the video is longer than its head.
inline camera::FramePtr noisy_picture(int number) {
  std::mt19937 random(static_cast<std::uint32_t>(number));
  auto frame = std::make_shared<camera::Frame>();
  frame->index = number;
  frame->width = 160;
  frame->height = 96;
  frame->bgr.resize(static_cast<std::size_t>(3) * 160 * 96);
  for (std::uint8_t& value : frame->bgr) value = static_cast<std::uint8_t>(random());
  return frame;
}

class SessionCheckTest : public ::testing::Test {
 protected:
  static constexpr int kFrames = 90;

  [[nodiscard]] static std::string text_of(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
  }
  static void put_text(const std::filesystem::path& file, const std::string& text) {
    std::ofstream(file, std::ios::binary | std::ios::trunc) << text;
  }
  // A session with everything that one can hold; pictures over more than a second, so that its hashes are
  // written piece by piece.
  void record(bool with_pictures = true) {
    SessionRecorder recorder(folder_, test::session_header(), test::scripted_options());
    for (int i = 0; i < kFrames; ++i) {
      if (with_pictures) recorder.append_picture(noisy_picture(i));
      recorder.append(test::frame_result(i));
      recorder.append_digests({static_cast<std::uint64_t>(i), 7});
      recorder.append_latency({.tracking_ms = 3});
      if (i == 40) recorder.set_registration(test::some_registration());
      if (i % 30 == 0) recorder.add_event({test::frame_result(i).timestamp_ns, "note", "a note"});
      std::this_thread::sleep_for(std::chrono::milliseconds(17));
    }
    recorder.set_curves({{0, 0.5, {1, 2, 3}}, {0, 0.6, {1, 2, 4}}});
    recorder.finish();
  }
  void change_database(const std::string& sql) const {
    sqlite3* database = nullptr;
    ASSERT_EQ(sqlite3_open((folder_ / "session.sqlite").c_str(), &database), SQLITE_OK);
    EXPECT_EQ(sqlite3_exec(database, sql.c_str(), nullptr, nullptr, nullptr), SQLITE_OK);
    sqlite3_close(database);
  }
  void flip_byte(const std::string& name, std::size_t at) const {
    std::string text = text_of(folder_ / name);
    ASSERT_LT(at, text.size());
    text[at] = static_cast<char>(text[at] ^ 0x20);
    put_text(folder_ / name, text);
  }
  // The one finding; its range must hold `place` and be a part of all.
  void expect_one_finding(const std::string& of, std::int64_t place, const std::string& words) const {
    const SessionCheck check = check_session(folder_);
    EXPECT_EQ(check.outcome, SessionCheck::Outcome::Broken);
    ASSERT_EQ(check.findings.size(), 1u) << check_words(check);
    const CheckFinding& finding = check.findings.front();
    EXPECT_EQ(finding.of, of);
    EXPECT_LE(finding.from, place);
    EXPECT_GT(finding.to, place);
    EXPECT_THAT(finding.text(), ::testing::HasSubstr(words));
  }

  const test::TemporaryFolder temporary_;
  const std::filesystem::path& folder_ = temporary_.path();
};

}  // namespace arthronaut::recording
