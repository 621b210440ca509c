#include "app/setup/setup_sources.h"

#include <algorithm>

#include "app/case/case_calibration.h"
#include "navigation/camera/camera_file.h"
#include "navigation/simulator/simulated_operation.h"
#include "navigation/simulator/simulated_ruler.h"
#include "navigation/sources/camera_modes.h"
#include "navigation/sources/connected_cameras.h"
#include "navigation/sources/frame_source.h"
#include "navigation/sources/source_files.h"
#include "planning/geometry/error.h"
#include "planning/phantom/phantom_knee.h"

namespace arthronaut::setup {

namespace {

namespace fs = std::filesystem;

// The scripted surgeon's motions are sampled as coarsely as a machine without a GPU draws them.
constexpr int kPivotFrames = 72;
constexpr int kRulerFrames = 33, kRulerFramesPerSecond = 6;

// The pictures of a folder one after the other.
class PictureFolder : public sources::FrameSource {
 public:
  explicit PictureFolder(const fs::path& folder) : files_(sources::pictures_in(folder)) {
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
  source.name = camera::kSimulatedScope;
  source.open = [purpose] { return open_simulation(purpose); };
  source.is_simulated = true;
  source.path = kSimulatorWord;
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

// Shown without its password.
FeedSource stream(const std::string& address, const sources::DeviceTurns& turns) {
  FeedSource source;
  source.name = sources::shown_address(address);
  source.path = address;
  source.open = [turns, address] { return turns.open_stream(address); };
  source.look = [turns, address] { return turns.open_stream_if_free(address); };
  source.is_live = true;
  return source;
}

// Of one camera, the way in which it is to be opened said with it; looked at, it is opened the same way.
FeedSource addressed_camera(const std::string& address, const sources::DeviceTurns& turns) {
  FeedSource source;
  source.name = source.path = address;
  source.open = [turns, address] { return turns.open(sources::read_camera_address(address)); };
  source.look = [turns, address] { return turns.open_if_free(sources::read_camera_address(address)); };
  source.is_live = true;
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

}  // namespace

std::optional<std::size_t> index_of(const std::vector<FeedSource>& sources, const fs::path& path) {
  const auto found = std::find_if(sources.begin(), sources.end(), [&](const FeedSource& source) {
    return !path.empty() && source.path == path;
  });
  if (found == sources.end()) return std::nullopt;
  return static_cast<std::size_t>(found - sources.begin());
}

std::vector<FeedSource> sources_for(Purpose purpose, const fs::path& case_folder,
                                    const sources::DeviceTurns& turns, const std::vector<fs::path>& named) {
  const bool is_real_case = open_case::has_real_camera(case_folder);
  std::vector<FeedSource> offered;
  if (!is_real_case) offered.push_back(simulated(purpose));
  const auto offer_cameras = [&] {
    for (const sources::ConnectedCamera& camera : sources::connected_cameras()) {
      FeedSource source;
      source.name = camera.name;
      source.open = [turns, index = camera.index] { return turns.open({index}); };
      source.look = [turns, index = camera.index] { return turns.open_if_free({index}); };
      source.is_live = true;
      offered.push_back(std::move(source));
    }
    for (const fs::path& path : named) {
      if (sources::is_camera_address(path.string()))
        offered.push_back(addressed_camera(path.string(), turns));
      else if (sources::is_stream_address(path.string()))
        offered.push_back(stream(path.string(), turns));
    }
  };
  const auto offer_stills = [&](const fs::path& folder) {
    if (purpose == Purpose::Camera && !sources::pictures_in(folder).empty())
      offered.push_back(stills(folder));
  };
  if (is_real_case) offer_cameras();
  std::error_code ignored;
  for (const fs::path& path : named) {
    if (fs::is_directory(path, ignored)) offer_stills(path);
    if (fs::is_regular_file(path, ignored) && sources::looks_like_video(path))
      offered.push_back(video(path, purpose));
  }
  offer_stills(case_folder);
  std::vector<fs::path> inner;
  for (const auto& entry : fs::directory_iterator(case_folder, ignored))
    if (entry.is_directory(ignored)) inner.push_back(entry.path());
  std::sort(inner.begin(), inner.end());
  for (const fs::path& folder : inner) offer_stills(folder);
  for (const fs::path& file : sources::videos_in(case_folder)) offered.push_back(video(file, purpose));
  if (!is_real_case) offer_cameras();
  const bool is_asked_for = std::find(named.begin(), named.end(), kSimulatorWord) != named.end();
  if (is_real_case && is_asked_for) offered.push_back(simulated(purpose));
  return offered;
}

}  // namespace arthronaut::setup
