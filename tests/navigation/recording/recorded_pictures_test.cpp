#include "navigation/recording/recorded_pictures.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sqlite3.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <map>
#include <numeric>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>
#include <random>

#include "planning/geometry/error.h"
#include "tests/navigation/recording/numbered_pictures.h"
#include "tests/navigation/recording/recorded_frames.h"
#include "tests/temporary_folder.h"

namespace arthronaut::recording {
namespace {

namespace fs = std::filesystem;
void expect_every_picture(const fs::path& folder, int count) {
  const SessionOverview session = read_overview(folder);
  RecordedPictures pictures(session);
  for (const int i : seeded_order(count, 3)) {
    const std::int64_t time_ns = test::frame_result(i).timestamp_ns;
    const camera::FramePtr picture = pictures.picture(i, time_ns);
    ASSERT_NE(picture, nullptr) << i;
    EXPECT_EQ(number_of(*picture), i);
    EXPECT_EQ(picture->index, i);
    EXPECT_EQ(picture->timestamp_ns, time_ns);
  }
}

// The recorder's own video, also with pictures that were left out: each frame gives its own picture, and one
// without a picture gives none.
TEST(RecordedPictures, GivesEachFrameItsOwnPicture) {
  const test::TemporaryFolder folder;
  {
    SessionRecorder recorder(folder.path(), test::session_header(), test::scripted_options());
    for (int i = 0; i < kFrames; ++i) {
      if (i % 7 != 5) recorder.append_picture(frame_of(i));
      recorder.append(test::frame_result(i));
    }
    recorder.finish();
  }
  const SessionOverview session = read_overview(folder.path());
  RecordedPictures pictures(session);
  for (const int i : seeded_order(kFrames, 1)) {
    const camera::FramePtr picture = pictures.picture(i, test::frame_result(i).timestamp_ns);
    ASSERT_EQ(picture != nullptr, i % 7 != 5) << i;
    if (picture != nullptr) {
      EXPECT_EQ(number_of(*picture), i);
    }
  }
  EXPECT_EQ(pictures.picture(kFrames + 100, test::frame_result(kFrames + 100).timestamp_ns), nullptr);
}

// Players show it as fast as it was; a source that does not say how fast that is, or names its clock's ticks,
// is taken for one of 60 a second. Whatever it says, each frame gives its own picture.
TEST(RecordedPictures, OfAnEncodedVideoPlayAtTheSourcesPace) {
  for (const auto& [of_source, as_played] :
       {std::pair(7.5, 7.5), {29.97, 29.97}, {240, 240}, {0, 60}, {90'000, 60}}) {
    SCOPED_TRACE(of_source);
    const test::TemporaryFolder folder;
    {
      SessionRecorder recorder(folder.path(), test::session_header(), test::scripted_options());
      sources::SourceInfo source;
      source.frames_per_second = of_source;
      recorder.keep_pictures(PicturesAs::Lossless, source);
      for (int i = 0; i < kFrames; ++i) {
        recorder.append_picture(frame_of(i));
        recorder.append(test::frame_result(i));
      }
      recorder.finish();
    }
    EXPECT_NEAR(sources::open_video(folder / "video.mkv")->info().frames_per_second, as_played, 1e-3);
    expect_every_picture(folder.path(), kFrames);
  }
}

// Copied videos: one with a key frame every 12 pictures, and one whose pictures are all key frames.
TEST(RecordedPictures, FindsThePicturesOfCopiedVideos) {
  for (const auto& [name, code] :
       std::map<std::string, std::string>{{"a.mp4", "mp4v"}, {"b.avi", "MJPG"}, {"c.mkv", "mp4v"}}) {
    SCOPED_TRACE(name);
    const test::TemporaryFolder folder;
    ASSERT_NO_FATAL_FAILURE(copy_numbered_video(folder / name, code, folder / "session"));
    expect_every_picture(folder / "session", kFrames);
  }
}

// What is passed on the way to a picture of a copied video says by its timestamp which one it is; a search
// that was ended goes on where it was.
TEST(RecordedPictures, NamesWhatIsPassedInACopiedVideo) {
  const test::TemporaryFolder folder;
  // A key frame every 12 pictures.
  ASSERT_NO_FATAL_FAILURE(copy_numbered_video(folder / "a.mp4", "mp4v", folder / "session"));
  RecordedPictures pictures(read_overview(folder / "session"));
  constexpr int kLeftAfter = 3, kWanted = 95;  // a key frame is 84
  std::vector<int> passed;
  const auto note = [&](const auto& make) {
    const camera::FramePtr picture = make();
    EXPECT_EQ(picture->index, -1);
    // The file's clock counts in ticks finer than a tenth of a millisecond.
    EXPECT_NEAR(static_cast<double>(picture->timestamp_ns),
                static_cast<double>(test::frame_result(number_of(*picture)).timestamp_ns), 1e5);
    passed.push_back(number_of(*picture));
    return passed.size() != kLeftAfter;
  };
  EXPECT_EQ(pictures.picture(kWanted, test::frame_result(kWanted).timestamp_ns, note), nullptr);
  const camera::FramePtr found = pictures.picture(kWanted, test::frame_result(kWanted).timestamp_ns, note);
  ASSERT_NE(found, nullptr);
  EXPECT_EQ(number_of(*found), kWanted);
  std::vector<int> all(11);
  std::iota(all.begin(), all.end(), 84);
  EXPECT_EQ(passed, all);
}

// Who goes back in a copied video decodes nothing anew: what was passed is remembered, 16 pictures of it, and
// what lies before that is read between two wishes.
TEST(RecordedPictures, GoesBackInACopiedVideoByWhatItRemembers) {
  const test::TemporaryFolder folder;
  // A key frame every 12 pictures.
  ASSERT_NO_FATAL_FAILURE(copy_numbered_video(folder / "a.mp4", "mp4v", folder / "session"));
  RecordedPictures pictures(read_overview(folder / "session"));
  int passed = 0;
  const auto expect_picture = [&](int wanted) {
    const camera::FramePtr picture =
        pictures.picture(wanted, test::frame_result(wanted).timestamp_ns, [&](const auto& /*make*/) {
          ++passed;
          return true;
        });
    ASSERT_NE(picture, nullptr) << wanted;
    EXPECT_EQ(number_of(*picture), wanted);
    EXPECT_EQ(picture->index, wanted);
  };
  expect_picture(95);  // a key frame is 84
  EXPECT_EQ(passed, 11);
  for (int wanted = 94; wanted >= 84; --wanted) expect_picture(wanted);
  EXPECT_EQ(passed, 11);
  pictures.read_before_remembered([] { return true; });
  for (int wanted = 83; wanted >= 72; --wanted) expect_picture(wanted);
  EXPECT_EQ(passed, 11);
  // Ended: the picture itself is decoded when it is asked for.
  pictures.read_before_remembered([] { return false; });
  expect_picture(71);
  EXPECT_GT(passed, 11);
  // On from there, and far from all that is remembered.
  for (const int wanted : {96, 97, 71, 3, 230}) expect_picture(wanted);
}

// Stills of a pattern that does not begin with nought.
TEST(RecordedPictures, FindsTheStillsOfAPattern) {
  const test::TemporaryFolder folder;
  constexpr int kStills = 30;
  fs::create_directory(folder / "stills");
  fs::create_directory(folder / "session");
  char name[32];
  for (int i = 0; i < kStills; ++i) {
    std::snprintf(name, sizeof name, "f_%04d.png", i + 17);
    cv::imwrite((folder / "stills" / name).string(), numbered(i));
  }
  {
    SessionRecorder recorder(folder / "session", test::session_header(), test::scripted_options());
    for (int i = 0; i < kStills; ++i) recorder.append(test::frame_result(i));
    recorder.copy_video(folder / "stills/f_%04d.png");
    recorder.finish();
  }
  expect_every_picture(folder / "session", kStills);
}

// Killed at 40 seeded moments while it recorded pictures and frames, 60 a second: each record opens, is known
// to have been cut off, and has every frame and the picture of every frame but those of the last second; any
// of them is found though the video's index was never written.
TEST(RecordedPictures, LosesAtMostASecondAtAnyOf40Kills) {
  constexpr int kAtOnce = 8, kRounds = 5;
  std::mt19937 random(17);
  int opened = 0;
  for (int round = 0; round < kRounds; ++round) {
    struct Child {
      std::unique_ptr<test::TemporaryFolder> folder = std::make_unique<test::TemporaryFolder>();
      pid_t process = -1;
      int pipe = -1;
      double lives_s = 0;
      std::vector<std::pair<std::chrono::steady_clock::time_point, int>> given;
    };
    std::vector<Child> children(kAtOnce);
    for (Child& child : children) {
      child.lives_s = std::uniform_real_distribution(1.1, 3.5)(random);
      int ends[2];
      ASSERT_EQ(::pipe2(ends, O_NONBLOCK), 0);
      child.process = ::fork();
      ASSERT_GE(child.process, 0);
      if (child.process == 0) {
        SessionRecorder recorder(child.folder->path(), test::session_header(), test::scripted_options());
        for (int i = 0;; ++i) {
          recorder.append_picture(frame_of(i % 256));
          recorder.append(test::frame_result(i));
          if (::write(ends[1], &i, sizeof i) != static_cast<ssize_t>(sizeof i)) ::_exit(1);
          ::usleep(16'000);
        }
      }
      ::close(ends[1]);
      child.pipe = ends[0];
    }
    using Clock = std::chrono::steady_clock;
    std::vector<Clock::time_point> ended(children.size());
    std::size_t alive = children.size();
    while (alive > 0) {
      for (std::size_t n = 0; n < children.size(); ++n) {
        Child& child = children[n];
        int i = 0;
        while (::read(child.pipe, &i, sizeof i) == static_cast<ssize_t>(sizeof i))
          child.given.emplace_back(Clock::now(), i);
        if (child.process < 0 || child.given.empty()) continue;
        const double lived_s =
            std::chrono::duration<double>(Clock::now() - child.given.front().first).count();
        if (lived_s < child.lives_s) continue;
        ::kill(child.process, SIGKILL);
        ended[n] = Clock::now();
        ::waitpid(std::exchange(child.process, -1), nullptr, 0);
        --alive;
      }
      ::usleep(2000);
    }
    for (std::size_t n = 0; n < children.size(); ++n) {
      SCOPED_TRACE("round " + std::to_string(round) + ", child " + std::to_string(n));
      const Child& child = children[n];
      ::close(child.pipe);
      // The last frame that was given more than a second before the end.
      int must_be_there = -1;
      for (const auto& [when, i] : child.given)
        if (std::chrono::duration<double>(ended[n] - when).count() > 1) must_be_there = i;
      ASSERT_GT(must_be_there, 0);
      const SessionOverview session = read_overview(child.folder->path());
      ++opened;
      EXPECT_FALSE(session.was_finished);
      ASSERT_GT(RecordedSession(child.folder->path()).frames().size(),
                static_cast<std::size_t>(must_be_there));
      ASSERT_GT(session.pictures.size(), static_cast<std::size_t>(must_be_there));
      RecordedPictures pictures(session);
      for (const int i : seeded_order(must_be_there + 1, 9)) {
        const camera::FramePtr picture = pictures.picture(i, test::frame_result(i).timestamp_ns);
        ASSERT_NE(picture, nullptr) << i << " of " << must_be_there;
        EXPECT_EQ(number_of(*picture), i % 256);
      }
    }
  }
  EXPECT_EQ(opened, kAtOnce * kRounds);
}

// A video that was cut in the middle gives what is whole; what is not there has no picture.
TEST(RecordedPictures, GivesWhatIsWholeOfACutVideo) {
  const test::TemporaryFolder folder;
  {
    SessionRecorder recorder(folder.path(), test::session_header(), test::scripted_options());
    for (int i = 0; i < kFrames; ++i) {
      recorder.append_picture(frame_of(i));
      recorder.append(test::frame_result(i));
    }
    recorder.finish();
  }
  fs::resize_file(folder / "video.mkv", fs::file_size(folder / "video.mkv") / 2);
  const SessionOverview session = read_overview(folder.path());
  RecordedPictures pictures(session);
  int whole = 0;
  for (int i = kFrames - 1; i >= 0; --i) {
    const camera::FramePtr picture = pictures.picture(i, test::frame_result(i).timestamp_ns);
    if (picture == nullptr) continue;
    EXPECT_EQ(number_of(*picture), i);
    ++whole;
  }
  EXPECT_GT(whole, kFrames / 4);
  EXPECT_LT(whole, kFrames * 3 / 4);
}

// A part is announced before it holds anything: what a crash leaves of it then is no video. What was kept
// before it is there all the same, to look at and to replay.
TEST(RecordedPictures, GivesWhatIsBeforeAPartThatACrashLeftEmpty) {
  constexpr int kOfAPart = kFrames / 2;
  const test::TemporaryFolder folder;
  const fs::path left = folder / "left";
  fs::create_directory(folder / "made");
  {
    SessionRecorder recorder(folder / "made", test::session_header(), test::scripted_options());
    for (int i = 0; i < 2 * kOfAPart; ++i) {
      if (i == kOfAPart) recorder.interrupt_pictures();
      recorder.append_picture(frame_of(i));
      recorder.append(test::frame_result(i));
    }
    recorder.finish();
  }
  fs::copy(folder / "made", left, fs::copy_options::recursive);
  fs::resize_file(left / "video_2.mkv", 64);
  sqlite3* database = nullptr;
  ASSERT_EQ(sqlite3_open((left / "session.sqlite").c_str(), &database), SQLITE_OK);
  sqlite3_exec(database, "DELETE FROM ending", nullptr, nullptr, nullptr);  // nobody ended it
  sqlite3_close(database);
  const SessionOverview session = read_overview(left);
  ASSERT_FALSE(session.was_finished);
  RecordedPictures pictures(session);
  EXPECT_EQ(pictures.picture(kOfAPart + 3, test::frame_result(kOfAPart + 3).timestamp_ns), nullptr);
  EXPECT_NE(pictures.picture(3, test::frame_result(3).timestamp_ns), nullptr);
  const auto video = open_recorded_video(RecordedSession(left));
  int replayed = 0;
  while (video->next() != nullptr) ++replayed;
  EXPECT_EQ(replayed, kOfAPart);
}

// No video, and one that is gone, are told as such.
TEST(RecordedPictures, SaysThatThereIsNone) {
  const test::TemporaryFolder folder;
  {
    SessionRecorder recorder(folder.path(), test::session_header(), test::scripted_options());
    recorder.refer_to_video("/nowhere/scope.mp4");
    recorder.append(test::frame_result(0));
    recorder.finish();
  }
  const SessionOverview session = read_overview(folder.path());
  ASSERT_EQ(session.problems.size(), 1U);
  EXPECT_NE(session.problems.front().find("/nowhere/scope.mp4"), std::string::npos);
  EXPECT_THROW(RecordedPictures{session}, IoError);
}

}  // namespace
}  // namespace arthronaut::recording
