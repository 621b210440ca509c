// Torn pictures on path-traced arthroscopy. Clean clips, as they came and coded anew by H.264 from fine to
// coarse: no picture of theirs is taken for torn. The same clips with a tear in every picture, and with a
// half that was lost for good: hardly a picture of theirs stands.
#include <gtest/gtest.h>

#include <cstdio>
#include <functional>
#include <iostream>

#include "navigation/camera/camera_file.h"
#include "navigation/camera/medium.h"
#include "navigation/markers/marker_tracker.h"
#include "navigation/pipeline/view_tracker.h"
#include "navigation/sources/frame_source.h"
#include "navigation/tools/tool_set.h"
#include "tests/real_data/real_data.h"
#include "tests/temporary_folder.h"

namespace arthronaut {
namespace {

constexpr int kMostPictures = 90;
using Picture = std::vector<std::uint8_t>;

struct Clip {
  std::vector<Picture> pictures;
  int width = 0, height = 0;
};

Clip read(const std::filesystem::path& file) {
  Clip clip;
  const auto source = sources::open_video(file);
  while (const camera::FramePtr frame = source->next()) {
    clip.width = frame->width;
    clip.height = frame->height;
    if (clip.pictures.size() == kMostPictures) break;
    camera::gray_from(*frame, clip.pictures.emplace_back());
  }
  return clip;
}

// Coded and decoded again.
Clip coded(const Clip& clip, const std::string& options) {
  const test::TemporaryFolder folder;
  const std::string file = (folder / "v.mkv").string();
  FILE* const pipe = popen(
      ("ffmpeg -v error -f rawvideo -pix_fmt gray -s " + std::to_string(clip.width) + "x" +
       std::to_string(clip.height) + " -r 60 -i - -c:v libx264 " + options + " -pix_fmt yuv420p " + file)
          .c_str(),
      "w");
  if (pipe == nullptr) return {};
  for (const Picture& picture : clip.pictures) std::fwrite(picture.data(), 1, picture.size(), pipe);
  return pclose(pipe) == 0 ? read(file) : Clip{};
}

struct Counts {
  int pictures = 0, torn = 0;
  int last_whole = 0;  // the last one that was not torn, counted from 0
  int stale_poses = 0;
};

// Rows [from, to) are not of their picture's moment, from picture `since` on.
struct Stale {
  int from = 0, to = 0, since = 0;
};

Counts look_at(const Clip& clip, const std::filesystem::path& folder, const Stale& stale = {}) {
  pipeline::ViewTrackerOptions options;
  options.calibration = camera::read_camera_file(folder / "camera.json").calibration;
  options.refractive_index = camera::kSalineIndex;
  pipeline::ViewTracker tracker(
      options,
      markers::make_tracker(markers::declared_markers(tools::read_tools_file(folder / "tools.json"))));
  pipeline::PictureObservation view;
  Counts counts;
  for (const Picture& picture : clip.pictures) {
    camera::Frame frame;
    frame.index = counts.pictures;
    frame.timestamp_ns = counts.pictures * 1'000'000'000LL / 60;
    frame.width = clip.width;
    frame.height = clip.height;
    frame.luma = picture;
    tracker.observe(frame, view);
    ++counts.pictures;
    counts.torn += view.is_torn ? 1 : 0;
    if (!view.is_torn) counts.last_whole = counts.pictures - 1;
    if (counts.pictures <= stale.since) continue;
    for (const markers::MarkerObservation& marker : view.markers) {
      if (!view.stands_for(marker)) continue;
      const double y = (marker.corners_px[0].y() + marker.corners_px[2].y()) / 2;
      counts.stale_poses += y >= stale.from && y < stale.to ? 1 : 0;
    }
  }
  return counts;
}

class TornOnClips : public testing::TestWithParam<const char*> {};

TEST_P(TornOnClips, NoCleanPictureIsTorn) {
  ARTHRONAUT_REQUIRE_DATA(folder, std::string("arthroscopy/") + GetParam());
  const Clip clip = read(folder / "clip.mkv");
  EXPECT_EQ(look_at(clip, folder).torn, 0) << "as it came";
  for (const char* coding :
       {"-preset veryfast -tune zerolatency -crf 18", "-preset veryfast -tune zerolatency -crf 23",
        "-preset medium -crf 28", "-preset medium -crf 33",
        "-preset ultrafast -tune zerolatency -b:v 8M -maxrate 8M -bufsize 800k"}) {
    const Clip anew = coded(clip, coding);
    ASSERT_EQ(anew.pictures.size(), clip.pictures.size()) << coding;
    EXPECT_EQ(look_at(anew, folder).torn, 0) << coding;
  }
}

// The lower part of every picture is of the one before, at three heights.
TEST_P(TornOnClips, ATearInEveryPictureIsSeen) {
  ARTHRONAUT_REQUIRE_DATA(folder, std::string("arthroscopy/") + GetParam());
  const Clip clip = read(folder / "clip.mkv");
  for (const double height : {0.3, 0.5, 0.7}) {
    Clip torn = clip;
    const std::ptrdiff_t from = static_cast<std::ptrdiff_t>(height * clip.height) * clip.width;
    for (std::size_t i = 1; i < clip.pictures.size(); ++i)
      std::copy(clip.pictures[i - 1].begin() + from, clip.pictures[i - 1].end(),
                torn.pictures[i].begin() + from);
    const Counts counts = look_at(torn, folder);
    std::cout << GetParam() << ", torn at " << height << ": " << counts.torn << " of " << counts.pictures - 1
              << " seen\n";
    // Before the votes of a few pictures have come together, one without much motion passes.
    EXPECT_LT(counts.last_whole, 15) << height;
  }
}

// The lower or the upper part was lost in the twentieth picture and never comes again, raw and coded: no
// marker in it has a pose.
TEST_P(TornOnClips, NoPoseStandsOfAPartThatStands) {
  ARTHRONAUT_REQUIRE_DATA(folder, std::string("arthroscopy/") + GetParam());
  const Clip clip = read(folder / "clip.mkv");
  constexpr std::size_t kLost = 20;
  for (const bool is_lower : {true, false}) {
    Clip stale = clip;
    const std::ptrdiff_t at = static_cast<std::ptrdiff_t>(clip.height / 2) * clip.width;
    for (std::size_t i = kLost; i < clip.pictures.size(); ++i) {
      const Picture& lost = clip.pictures[kLost - 1];
      is_lower ? std::copy(lost.begin() + at, lost.end(), stale.pictures[i].begin() + at)
               : std::copy(lost.begin(), lost.begin() + at, stale.pictures[i].begin());
    }
    for (const char* coding : {"", "-preset veryfast -tune zerolatency -crf 23"}) {
      // Raw, from the third picture on. A codec works on what was lost for some pictures more: within the 100
      // ms that a picture may be late.
      const bool is_coded = *coding != 0;
      const Stale part{is_lower ? clip.height / 2 : 0, is_lower ? clip.height : clip.height / 2,
                       static_cast<int>(kLost) + (is_coded ? 6 : 2)};
      const Counts counts = look_at(is_coded ? coded(stale, coding) : stale, folder, part);
      std::cout << GetParam() << (is_lower ? ", lower" : ", upper") << " part stands, "
                << (is_coded ? "coded" : "raw") << ": " << counts.torn << " of "
                << counts.pictures - static_cast<int>(kLost) << " seen, poses from that part "
                << counts.stale_poses << "\n";
      EXPECT_EQ(counts.stale_poses, 0);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Arthroscopy, TornOnClips,
                         testing::Values("probe_wet", "guide_wet", "ruler_wet", "hard"),
                         [](const auto& clip) { return std::string(clip.param); });

}  // namespace
}  // namespace arthronaut
