#include "navigation/recording/quick_pictures.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <stdexcept>
#include <utility>

#include "navigation/recording/kept_pictures.h"
#include "navigation/recording/recorded_pictures.h"
#include "navigation/recording/video_encoder.h"
#include "navigation/recording/video_files.h"
#include "navigation/sources/video_file.h"
#include "planning/files/format.h"
#include "planning/files/free_space.h"
#include "planning/files/private_folder.h"
#include "planning/files/running_process.h"
#include "planning/files/sha256.h"
#include "planning/geometry/error.h"

namespace arthronaut::recording {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kStretch = 600;  // pictures of one file
constexpr double kRate = 60;           // what the files say; which picture is which is told by their order
constexpr int kLeastSide = 16;         // of a copy, which encoders take
constexpr std::uintmax_t kLeftFree = 4'000'000'000;

// Another one for files of another name, size or time.
std::string mark_of(const fs::path& folder, const std::vector<fs::path>& files) {
  std::string text;
  for (const fs::path& file : files) {
    std::error_code error;
    text += file.lexically_relative(folder).string() + "\n" + std::to_string(fs::file_size(file, error)) +
            "\n" + std::to_string(fs::last_write_time(file, error).time_since_epoch().count()) + "\n";
  }
  return files::sha256_of(text).substr(0, 16);
}

// By a program that lives.
std::string unfinished_name(pid_t process) {
  return files::format("unfinished_%d.mkv", static_cast<int>(process));
}
bool another_makes(const std::string& name) {
  int process = 0;
  if (std::sscanf(name.c_str(), "unfinished_%d", &process) != 1 || process <= 0) return false;
  return process != ::getpid() && name == unfinished_name(process) && files::is_running(process);
}

// Half as wide and half as high.
camera::Frame halved(const camera::Frame& picture) {
  std::vector<std::uint8_t> made;
  const std::vector<std::uint8_t>& bgr = camera::bgr_of(picture, made);
  camera::Frame small;
  small.index = picture.index;
  small.width = picture.width / 2;
  small.height = picture.height / 2;
  if (std::min(small.width, small.height) < kLeastSide) return small;
  small.bgr.resize(static_cast<std::size_t>(3) * static_cast<std::size_t>(small.width) *
                   static_cast<std::size_t>(small.height));
  const cv::Mat from(picture.height, picture.width, CV_8UC3, const_cast<std::uint8_t*>(bgr.data()));
  cv::Mat to(small.height, small.width, CV_8UC3, small.bgr.data());
  cv::resize(from, to, to.size(), 0, 0, cv::INTER_AREA);
  return small;
}

}  // namespace

struct QuickPictures::State {
  State(std::shared_ptr<const SessionOverview> whole, const std::vector<Name>& frames)
      : session(std::move(whole)), folder(session->folder / "quick") {
    const SessionOverview& of = *session;
    std::vector<fs::path> files;
    for (const VideoPart& part : parts_of(of.header)) files.push_back(of.folder / part.file);
    if (files.empty()) {
      names = frames;
      files.push_back(of.video());
    } else {
      auto kept = of.pictures.begin();
      for (const Name& name : frames) {
        while (kept != of.pictures.end() && kept->frame < name.frame) ++kept;
        if (kept != of.pictures.end() && kept->frame == name.frame) names.push_back(name);
      }
    }
    mark = mark_of(of.folder, files);
    is_refused.resize((names.size() + kStretch - 1) / kStretch, false);
  }

  [[nodiscard]] fs::path file_of(std::size_t stretch) const {
    return folder / files::format("%s_%05zu.mkv", mark.c_str(), stretch);
  }

  // What is of another video, or was left unfinished; not what another window is just making.
  void remove_strangers() const {
    std::error_code error;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
      const std::string name = entry.path().filename().string();
      if (name.rfind(mark, 0) != 0 && !another_makes(name)) fs::remove(entry.path(), error);
    }
  }

  [[nodiscard]] std::vector<Name>::const_iterator find(std::int64_t frame) const {
    return std::lower_bound(names.begin(), names.end(), frame,
                            [](const Name& name, std::int64_t wanted) { return name.frame < wanted; });
  }

  // The nearest that is neither there nor known not to be made.
  [[nodiscard]] std::optional<std::size_t> next_near(std::int64_t frame) const {
    const std::size_t count = is_refused.size();
    if (count == 0) return std::nullopt;
    const std::size_t at =
        std::min(count - 1, static_cast<std::size_t>(find(frame) - names.begin()) / kStretch);
    for (std::size_t off = 0; off < count; ++off)
      for (const std::size_t stretch : {at + off, at - off})  // below 0 it is beyond the last
        if (stretch < count && !is_refused[stretch] && !fs::exists(file_of(stretch))) return stretch;
    return std::nullopt;
  }

  // False: a picture is missing, or goes_on ended it.
  bool encode(std::size_t stretch, const fs::path& to, const std::function<bool()>& goes_on) {
    if (pictures == nullptr) pictures = std::make_unique<RecordedPictures>(session);
    std::optional<VideoEncoder> encoder;
    const std::size_t end = std::min(names.size(), (stretch + 1) * kStretch);
    for (std::size_t n = stretch * kStretch; n < end; ++n) {
      const camera::FramePtr picture = pictures->picture(
          names[n].frame, names[n].timestamp_ns, [&goes_on](const auto& /*passed*/) { return goes_on(); });
      if (picture == nullptr || !goes_on()) return false;
      const camera::Frame small = halved(*picture);
      if (std::min(small.width, small.height) < kLeastSide) return false;
      if (!encoder) encoder.emplace(to, small.width, small.height, kRate, PicturesAs::H264, H264For::Looking);
      encoder->encode(small);
    }
    if (encoder) encoder->finish();
    return encoder.has_value();
  }

  std::shared_ptr<const SessionOverview> session;
  fs::path folder;
  std::vector<Name> names;       // of the frames with pictures
  std::string mark;              // of the video that the copies are of
  std::vector<bool> is_refused;  // by stretches: nothing can be made of it
  std::unique_ptr<RecordedPictures> pictures;
  // The file that was read last.
  std::unique_ptr<sources::SeekableVideo> video;
  std::size_t video_of = 0;
};

QuickPictures::QuickPictures(std::shared_ptr<const SessionOverview> session, const std::vector<Name>& of)
    : state_(std::make_unique<State>(std::move(session), of)) {}

QuickPictures::~QuickPictures() = default;

camera::FramePtr QuickPictures::picture(std::int64_t frame) {
  State& s = *state_;
  const auto name = s.find(frame);
  if (name == s.names.end() || name->frame != frame) return nullptr;
  const auto number = static_cast<std::size_t>(name - s.names.begin());
  const std::size_t stretch = number / kStretch;
  try {
    if (s.video == nullptr || s.video_of != stretch) {
      s.video.reset();
      if (!fs::exists(s.file_of(stretch))) return nullptr;
      s.video = sources::open_seekable_video(s.file_of(stretch), sources::LumaOf::Colours);
      s.video_of = stretch;
    }
    const camera::FramePtr found =
        s.video->picture_at(std::llround(static_cast<double>(number % kStretch) / kRate * 1e9));
    if (found == nullptr) return nullptr;
    auto named = std::make_shared<camera::Frame>(*found);
    named->index = name->frame;
    named->timestamp_ns = name->timestamp_ns;
    return named;
  } catch (
      const std::runtime_error&) {  // deleted or damaged since: the session's own picture is still to come
    s.video.reset();
    return nullptr;
  }
}

bool QuickPictures::make_next(std::int64_t near_frame, const std::function<bool()>& goes_on) {
  State& s = *state_;
  const auto stretch = s.next_near(near_frame);
  if (!stretch || !goes_on() || files::free_bytes_at(s.session->folder) < kLeftFree) return false;
  files::create_private_folder(s.folder);
  const fs::path unfinished = s.folder / unfinished_name(::getpid());
  s.remove_strangers();
  bool is_made = false;
  try {
    files::begin_private_file(unfinished);
    is_made = s.encode(*stretch, unfinished, goes_on);
  } catch (const InvalidInput&) {  // of the session's pictures: damaged
    s.pictures.reset();
  }
  std::error_code error;
  if (is_made)
    fs::rename(unfinished, s.file_of(*stretch), error);
  else
    fs::remove(unfinished, error);
  if (is_made && error) throw IoError(s.file_of(*stretch), "cannot be written: " + error.message());
  if (!goes_on()) return false;
  s.is_refused[*stretch] = !is_made;
  return true;
}

}  // namespace arthronaut::recording
