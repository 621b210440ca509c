#include "app/setup_view/setup_sources.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>

#include "navigation/camera/camera_file.h"
#include "navigation/simulator/simulated_operation.h"
#include "navigation/simulator/simulated_ruler.h"
#include "planning/cases/case.h"
#include "planning/geometry/error.h"
#include "planning/phantom/phantom_knee.h"

namespace arthronaut::setup_view {

namespace {

namespace fs = std::filesystem;

constexpr std::array<std::string_view, 6> kPictures{".png", ".jpg", ".jpeg", ".bmp", ".tif", ".tiff"};
constexpr std::array<std::string_view, 4> kVideos{".mp4", ".mkv", ".avi", ".mov"};

// The scripted surgeon's motions are sampled as coarsely as a machine without a GPU draws them.
constexpr int kPivotFrames = 72;
constexpr int kRulerFrames = 33, kRulerFramesPerSecond = 6;

template <std::size_t Count>
bool has_extension(const fs::path& file, const std::array<std::string_view, Count>& extensions) {
  std::string extension = file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return std::find(extensions.begin(), extensions.end(), extension) != extensions.end();
}

template <std::size_t Count>
std::vector<fs::path> files_of(const fs::path& folder,
                               const std::array<std::string_view, Count>& extensions) {
  std::vector<fs::path> files;
  std::error_code ignored;  // a folder that can't be read has nothing to offer
  for (const auto& entry : fs::directory_iterator(folder, ignored))
    if (entry.is_regular_file(ignored) && has_extension(entry.path(), extensions))
      files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

// The pictures of a folder one after the other.
class PictureFolder : public sources::FrameSource {
 public:
  explicit PictureFolder(const fs::path& folder) : files_(pictures_of(folder)) {
    if (files_.empty()) throw IoError(folder, "there is no picture in this folder");
    info_.name = folder.filename().string();
    info_.frame_count = static_cast<std::int64_t>(files_.size());
  }
  [[nodiscard]] const sources::SourceInfo& info() const override { return info_; }
  [[nodiscard]] camera::FramePtr next() override {
    if (index_ == files_.size()) return nullptr;
    auto frame = std::make_shared<camera::Frame>(sources::read_picture(files_[index_]));
    frame->index = static_cast<std::int64_t>(index_++);
    frame->timestamp_ns = frame->index * 1'000'000'000;
    return frame;
  }

 private:
  std::vector<fs::path> files_;
  sources::SourceInfo info_;
  std::size_t index_ = 0;
};

std::unique_ptr<sources::FrameSource> open_simulation(Purpose purpose) {
  if (purpose == Purpose::Fluid) {
    simulator::RulerOptions ruler;
    ruler.camera = simulator::standard_camera();
    ruler.frame_count = kRulerFrames;
    ruler.frames_per_second = kRulerFramesPerSecond;
    return std::make_unique<simulator::SimulatedRuler>(ruler);
  }
  simulator::SimulationOptions options;
  options.knee = phantom::make_phantom_knee();
  options.camera = simulator::standard_camera();
  options.tools = tools::standard_tools();
  options.plan = options.knee.femoral_tunnel;
  if (purpose == Purpose::Tools) options.frame_count = kPivotFrames;
  return std::make_unique<simulator::SimulatedOperation>(
      options, purpose == Purpose::Camera ? simulator::Phase::Calibrate : simulator::Phase::Pivot);
}

FeedSource simulated(Purpose purpose) {
  FeedSource source;
  source.name = kSimulatedScope;
  source.open = [purpose] { return open_simulation(purpose); };
  source.is_simulated = true;
  source.is_stills = purpose == Purpose::Camera;
  source.newest_wins = false;
  return source;
}

FeedSource stills(const fs::path& folder) {
  FeedSource source;
  source.name = "Pictures in " + folder.filename().string();
  source.path = folder;
  source.open = [folder] { return std::make_unique<PictureFolder>(folder); };
  source.is_stills = true;
  return source;
}

FeedSource video(const fs::path& file, Purpose purpose) {
  FeedSource source;
  source.name = file.filename().string();
  source.path = file;
  source.open = [file] { return sources::open_video(file); };
  source.newest_wins = purpose == Purpose::Camera;
  return source;
}

// What the kernel offers as cameras: /dev/video0, /dev/video1, ...
std::vector<int> camera_devices() {
  std::vector<int> devices;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator("/dev", ignored)) {
    const std::string name = entry.path().filename().string();
    int index = 0;
    if (!name.starts_with("video")) continue;
    const auto [end, error] = std::from_chars(name.data() + 5, name.data() + name.size(), index);
    if (error == std::errc() && end == name.data() + name.size()) devices.push_back(index);
  }
  std::sort(devices.begin(), devices.end());
  return devices;
}

// Whether the case's camera.json is of the simulated arthroscope. A file that can't be read is not.
bool has_simulated_camera(const fs::path& case_folder) {
  try {
    return camera::read_camera_file(cases::camera_file(case_folder)).scope_name == kSimulatedScope;
  } catch (const std::runtime_error&) {  // absent or broken: the one who uses it will say so
    return false;
  }
}

}  // namespace

camera::Calibration camera_of(const FeedSource& source, const fs::path& case_folder) {
  if (source.is_simulated && !has_simulated_camera(case_folder)) return simulator::standard_camera();
  const fs::path file = cases::camera_file(case_folder);
  if (!fs::exists(file)) throw InvalidInput("the case has no camera.json: calibrate the camera first (1)");
  return camera::read_camera_file(file).calibration;
}

tools::ToolSet tools_of(const FeedSource& source, const fs::path& case_folder) {
  const fs::path file = cases::tools_file(case_folder);
  return source.is_simulated || !fs::exists(file) ? tools::standard_tools() : tools::read_tools_file(file);
}

std::string camera_is_kept(const FeedSource& source, const fs::path& case_folder) {
  const bool may_be_replaced = !source.is_simulated || !fs::exists(cases::camera_file(case_folder)) ||
                               has_simulated_camera(case_folder);
  return may_be_replaced
             ? ""
             : "this case has the calibration of a real scope; a simulated one does not replace it";
}

std::string tools_are_kept(const FeedSource& source, const fs::path& case_folder) {
  const bool may_be_replaced = !source.is_simulated || !fs::exists(cases::tools_file(case_folder)) ||
                               has_simulated_camera(case_folder);
  return may_be_replaced ? "" : "this case has its own tools.json; what is simulated does not replace it";
}

std::optional<std::size_t> index_of(const std::vector<FeedSource>& sources, const fs::path& path) {
  const auto found = std::find_if(sources.begin(), sources.end(), [&](const FeedSource& source) {
    return !path.empty() && source.path == path;
  });
  if (found == sources.end()) return std::nullopt;
  return static_cast<std::size_t>(found - sources.begin());
}

std::vector<fs::path> pictures_of(const fs::path& folder) { return files_of(folder, kPictures); }

std::vector<FeedSource> sources_for(Purpose purpose, const fs::path& case_folder,
                                    const std::vector<fs::path>& named) {
  std::vector<FeedSource> offered{simulated(purpose)};
  const auto offer_stills = [&](const fs::path& folder) {
    if (purpose == Purpose::Camera && !pictures_of(folder).empty()) offered.push_back(stills(folder));
  };
  std::error_code ignored;
  for (const fs::path& path : named) {
    if (fs::is_directory(path, ignored)) offer_stills(path);
    if (fs::is_regular_file(path, ignored) && has_extension(path, kVideos))
      offered.push_back(video(path, purpose));
  }
  offer_stills(case_folder);
  std::vector<fs::path> inner;
  for (const auto& entry : fs::directory_iterator(case_folder, ignored))
    if (entry.is_directory(ignored)) inner.push_back(entry.path());
  std::sort(inner.begin(), inner.end());
  for (const fs::path& folder : inner) offer_stills(folder);
  for (const fs::path& file : files_of(case_folder, kVideos)) offered.push_back(video(file, purpose));
  for (const int device : camera_devices()) {
    FeedSource source;
    source.name = "Camera " + std::to_string(device);
    source.open = [device] { return sources::open_device(device); };
    offered.push_back(std::move(source));
  }
  return offered;
}

}  // namespace arthronaut::setup_view
