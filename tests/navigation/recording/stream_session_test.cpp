// Sessions of a stream that is kept as it came: whole, looked at, tampered with.
#include "tests/navigation/recording/stream_session.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <random>

#include "navigation/recording/recorded_pictures.h"
#include "navigation/recording/session.h"
#include "navigation/recording/session_check.h"
#include "tests/navigation/recording/given_picture.h"
#include "tests/navigation/recording/recorded_frames.h"

namespace arthronaut::recording {
namespace {

namespace fs = std::filesystem;
using test::GivenPicture;
using test::luma_of_picture;
using test::record;

// What is passed on the way to a picture is the picture of the frame that it says it is, and what no frame
// has is none of any. Going back goes on at once where what lies before was read meanwhile, across a key
// frame, too.
TEST_F(StreamSession, NamesWhatIsPassedAndReadsBefore) {
  const test::TemporaryFolder folder;
  std::map<std::int64_t, std::uint64_t> given;
  {
    const auto source = open();
    SessionRecorder recorder(folder.path(), test::session_header(), test::scripted_options());
    record(*source, recorder, [&](const GivenPicture& picture) {
      if (picture.frame % 11 != 4) given.emplace(picture.frame, picture.luma);
      return given.size() == 150;
    });
    recorder.finish();
  }
  RecordedPictures pictures(read_overview(folder.path()));
  const auto time_of = [](std::int64_t frame) { return test::frame_result(frame).timestamp_ns; };
  int passed = 0, without_frame = 0;
  const auto note = [&](const auto& make) {
    ++passed;
    const camera::FramePtr picture = make();
    if (picture == nullptr) return ++without_frame, true;
    EXPECT_EQ(picture->timestamp_ns, -1);
    const auto same = given.find(picture->index);
    EXPECT_TRUE(same != given.end() && luma_of_picture(*picture) == same->second) << picture->index;
    return true;
  };
  // The last is up to 44 pictures behind its key frame, of which 16 are remembered.
  auto at = std::prev(given.end());
  ASSERT_NE(pictures.picture(at->first, time_of(at->first), note), nullptr);
  std::mt19937 random(4);
  for (int i = 0; i < 30; ++i) {
    at = std::next(given.begin(), std::uniform_int_distribution(0, 149)(random));
    ASSERT_NE(pictures.picture(at->first, time_of(at->first), note), nullptr);
  }
  EXPECT_GT(passed, 100);
  EXPECT_GT(without_frame, 0);

  at = std::prev(given.end());
  ASSERT_NE(pictures.picture(at->first, time_of(at->first)), nullptr);
  passed = 0;
  for (int back = 0; back < 110; ++back) {
    --at;
    pictures.read_before_remembered([] { return true; });
    const camera::FramePtr picture = pictures.picture(at->first, time_of(at->first), note);
    ASSERT_NE(picture, nullptr) << at->first;
    EXPECT_EQ(luma_of_picture(*picture), at->second);
  }
  EXPECT_EQ(passed, 0);
}

// A session of its own: whole by its hashes, every picture under its frame, in order and across; it says how
// its pictures were kept. A bit that is changed in the video is told by the hashes.
TEST_F(StreamSession, ComesBackWholeAndTellsTampering) {
  const test::TemporaryFolder folder;
  std::vector<GivenPicture> given;
  {
    const auto source = open();
    SessionRecorder recorder(folder.path(), test::session_header(), test::scripted_options());
    record(*source, recorder, [&](const GivenPicture& picture) {
      given.push_back(picture);
      return given.size() == 130;
    });
    recorder.finish();
  }
  EXPECT_TRUE(check_session(folder.path()).is_unbroken()) << check_words(check_session(folder.path()));
  const RecordedSession session(folder.path());
  EXPECT_TRUE(session.header().video_has_exact_luma);
  ASSERT_EQ(session.header().video_parts.size(), 1U);
  EXPECT_EQ(session.header().video_parts[0].codec, "h264");
  const auto said = std::find_if(session.events().begin(), session.events().end(),
                                 [](const SessionEvent& event) { return event.kind == kPicturesKeptEvent; });
  ASSERT_NE(said, session.events().end());
  EXPECT_EQ(said->text, "as they came (h264), video.mkv");

  const auto video = open_recorded_video(session);
  RecordedPictures pictures(read_overview(folder.path()));
  for (const GivenPicture& picture : given) {
    if (picture.frame % 11 == 4) continue;
    const camera::FramePtr replayed = video->next();
    ASSERT_NE(replayed, nullptr) << picture.frame;
    EXPECT_EQ(replayed->index, picture.frame);
    EXPECT_EQ(luma_of_picture(*replayed), picture.luma) << picture.frame;
  }
  EXPECT_EQ(video->next(), nullptr);
  std::mt19937 random(2);
  for (int i = 0; i < 60; ++i) {
    const GivenPicture& picture =
        given[std::uniform_int_distribution<std::size_t>(0, given.size() - 1)(random)];
    const camera::FramePtr shown =
        pictures.picture(picture.frame, test::frame_result(picture.frame).timestamp_ns);
    ASSERT_EQ(shown != nullptr, picture.frame % 11 != 4) << picture.frame;
    if (shown != nullptr) {
      EXPECT_EQ(luma_of_picture(*shown), picture.luma) << picture.frame;
    }
  }

  std::fstream file(folder / "video.mkv", std::ios::in | std::ios::out | std::ios::binary);
  file.seekp(static_cast<std::streamoff>(fs::file_size(folder / "video.mkv") / 2));
  file.put('x');
  file.close();
  EXPECT_EQ(check_session(folder.path()).outcome, SessionCheck::Outcome::Broken);
}

}  // namespace
}  // namespace arthronaut::recording
