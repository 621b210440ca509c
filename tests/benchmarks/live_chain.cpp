// The whole chain on a live stream over the loopback, without a window: 1080p60 H.264 by RTSP, with and
// without the recording of its pictures. And faults, many of them.
//   live_chain stream CLIP SECONDS [--record] [--camera FILE MEDIUM]
//                                               CLIP: 1080p60 H.264 without B-frames, sent round and round,
//                                               as one stream
//   live_chain faults COUNT [SEED [CODEC]]      prints a row a kind: how soon gone, told and back; jpeg or
//   h264
// Prints what was sent, tracked and recorded, latency by stage, and how the memory grew, minute by minute,
// and with how many points of strokes.
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <random>
#include <thread>
#include <vector>

#include "navigation/camera/camera_file.h"
#include "navigation/camera/medium.h"
#include "navigation/recording/session.h"
#include "navigation/sources/frame_source.h"
#include "navigation/theatre/navigate_source.h"
#include "planning/geometry/error.h"
#include "tests/child_process.h"
#include "tests/live/fault_drill.h"
#include "tests/temporary_folder.h"

namespace arthronaut {
namespace {

double resident_mb() {
  std::ifstream statm("/proc/self/statm");
  long all = 0, resident = 0;
  statm >> all >> resident;
  return static_cast<double>(resident) * static_cast<double>(::sysconf(_SC_PAGESIZE)) * 1e-6;
}

// What a clip whose camera is not given is looked at with: its markers are found, and no pose of them is
// right.
camera::Calibration supposed_camera(const Eigen::Vector2i& size_px) {
  camera::Calibration camera;
  camera.image_size_px = size_px;
  camera.focal_px = 0.31 * size_px.x();
  camera.principal_point_px = camera.rotation_center_px = size_px.cast<double>() / 2;
  camera.boundary = {camera.principal_point_px, 0.49 * size_px.y()};
  return camera;
}

struct StreamChoice {
  std::string clip;
  double seconds = 0;
  bool records = false;
  const char *camera_file = nullptr, *medium = nullptr;
};

constexpr std::int64_t kBuffersFull_s = 60;

// The clip round and round. A sender whose clip ends closes the connection, and what is measured is how one
// is made anew.
class EndlessSender {
 public:
  EndlessSender(const std::string& port, const std::string& clip) {
    int ends[2];
    if (::pipe2(ends, O_CLOEXEC) != 0) throw std::runtime_error("no pipe");
    reader_ = std::make_unique<test::ChildProcess>(
        test::run_program({"ffmpeg", "-loglevel", "quiet", "-nostdin", "-stream_loop", "-1", "-i", clip, "-c",
                           "copy", "-an", "-live", "1", "-f", "matroska", "-"},
                          ends[1]));
    sender_ = test::send_by_rtsp(
        port, "( fdsrc ! matroskademux ! h264parse config-interval=-1 ! rtph264pay name=pay0 )", ends[0]);
    ::close(ends[0]);
    ::close(ends[1]);
  }

 private:
  std::unique_ptr<test::ChildProcess> reader_, sender_;
};

int stream(const StreamChoice& choice) {
  const bool records = choice.records;
  const std::string port = std::to_string(20000 + ::getpid() % 40000);
  const EndlessSender sender(port, choice.clip);
  const test::TemporaryFolder folder;
  theatre::NavigateOptions options;
  options.source.kind = sources::SourceKind::Live;
  options.source.pipeline.tools = tools::standard_tools();
  options.duration_s = choice.seconds;
  options.is_confirmed = true;  // no stroke of a live source is drawn before the time-out
  std::shared_ptr<sources::FrameSource> source;
  for (int i = 0; source == nullptr; ++i) {
    try {
      source = sources::open_stream(test::rtsp_address(port));
    } catch (const DeviceError& error) {
      if (i == 20) throw;
      std::this_thread::sleep_for(std::chrono::milliseconds(200));
    }
  }
  pipeline::PipelineOptions& pipeline = options.source.pipeline;
  pipeline.follow_lens = choice.camera_file != nullptr;
  if (choice.camera_file != nullptr) {
    pipeline.calibration = camera::read_camera_file(choice.camera_file).calibration;
    pipeline.refractive_index = camera::refractive_index_from_text(choice.medium);
  } else {
    pipeline.calibration = supposed_camera(source->info().image_size_px);
  }
  theatre::RecordOptions record;
  if (records) {
    record.folder = folder.path() / "session";
    std::filesystem::create_directory(record.folder);
    record.keep = recording::KeepVideo::Encode;
  }
  std::int64_t first = -1, last = -1;
  long seen = 0;
  double first_s = 0, last_s = 0, memory_mb = 0, minute_s = 0;
  theatre::NavigationObserver observer;
  const auto count = [&](const camera::FramePtr& picture, const operation::OperationStatePtr& state) {
    // Until then buffers fill, of which the 20 s of encoded pictures to reach back to are the longest.
    if (memory_mb == 0 && picture->timestamp_ns > kBuffersFull_s * 1'000'000'000) memory_mb = resident_mb();
    if (first < 0) {
      first = picture->index;
      first_s = static_cast<double>(picture->timestamp_ns) * 1e-9;
    }
    last = picture->index;
    last_s = static_cast<double>(picture->timestamp_ns) * 1e-9;
    ++seen;
    if (last_s < minute_s) return;
    minute_s = last_s + 60;
    std::printf("after %.0f s: %.1f MB, %zu points of strokes\n", last_s, resident_mb(),
                state->registration->point_count);
    std::fflush(stdout);
  };
  observer.on_frame = [&](const camera::FramePtr& picture, const operation::OperationStatePtr& state) {
    count(picture, state);
  };
  observer.on_late = [&](const camera::FramePtr& picture, const std::string&,
                         const operation::OperationStatePtr& state) { count(picture, state); };
  const theatre::NavigationSummary summary = theatre::navigate_source(source, options, record, observer);
  const double memory_at_end_mb = resident_mb();  // reading the record back is not the chain's
  const double sent = 60 * (last_s - first_s) + 1;
  std::printf("%.1f s, %s the record\n", last_s - first_s, records ? "with" : "without");
  std::printf("sent %.0f, decoded %lld, tracked %ld (%.2f %% of what was sent)\n", sent,
              static_cast<long long>(last - first + 1), seen, 100.0 * static_cast<double>(seen) / sent);
  if (records) {
    const recording::RecordedSession session(record.folder);
    std::printf("recorded: %zu frames, %zu pictures\n", session.frames().size(), session.pictures().size());
  }
  for (std::size_t i = 0; i < theatre::kStageCount; ++i)
    if (const theatre::StageLatency& stage = summary.latency[i]; stage.count > 0)
      std::printf("  %-12s median %6.2f ms, 99 %% %6.2f ms, worst %7.2f ms\n",
                  std::string(theatre::to_text(static_cast<theatre::Stage>(i))).c_str(), stage.median_ms,
                  stage.p99_ms, stage.worst_ms);
  if (memory_mb > 0)
    std::printf("memory: %.1f MB after %lld s, %+.1f MB since\n", memory_mb,
                static_cast<long long>(kBuffersFull_s), memory_at_end_mb - memory_mb);
  for (const std::string& trouble : summary.troubles) std::printf("trouble: %s\n", trouble.c_str());
  if (!summary.ending.empty()) std::printf("ended: %s\n", summary.ending.c_str());
  return 0;
}

int faults(int count, unsigned seed, const std::string& codec) {
  std::mt19937 random(seed);
  std::vector<test::Fault> all;
  for (int i = 0; i < count; ++i) all.push_back(static_cast<test::Fault>(i % test::kFaultCount));
  std::shuffle(all.begin(), all.end(), random);
  std::map<test::Fault, std::vector<test::FaultOutcome>> outcomes;
  test::FaultDrill drill(codec);
  for (const test::Fault fault : all) outcomes[fault].push_back(drill.run(fault, 0.8, 20));
  std::printf("%-22s %5s  %-16s %-16s %-16s never\n", "fault", "times", "gone, worst", "told, worst",
              "back, worst");
  for (const auto& [fault, of_kind] : outcomes) {
    std::vector<double> gone, told, back;
    int never = 0;
    for (const test::FaultOutcome& one : of_kind) {
      const bool is_asked = fault != test::Fault::Torn && fault != test::Fault::Repeated;
      never += (is_asked && one.gone_s < 0) || one.told_s < 0 || one.back_s < 0 ? 1 : 0;
      if (is_asked) gone.push_back(one.gone_s);
      told.push_back(one.told_s);
      back.push_back(one.back_s);
    }
    const auto text = [](std::vector<double> s) {
      if (s.empty()) return std::string("-");
      std::sort(s.begin(), s.end());
      char line[40];
      std::snprintf(line, sizeof line, "%.3f, %.3f s", s[s.size() / 2], s.back());
      return std::string(line);
    };
    std::printf("%-22s %5zu  %-16s %-16s %-16s %d\n", test::to_text(fault).c_str(), of_kind.size(),
                text(gone).c_str(), text(told).c_str(), text(back).c_str(), never);
  }
  return 0;
}

}  // namespace
}  // namespace arthronaut

int main(int count, char** arguments) {
  const auto is = [&](int i, const char* word) { return count > i && std::strcmp(arguments[i], word) == 0; };
  if (is(1, "stream") && count > 3) {
    arthronaut::StreamChoice choice{arguments[2], std::atof(arguments[3])};
    for (int i = 4; i < count; ++i) {
      choice.records = choice.records || is(i, "--record");
      if (!is(i, "--camera") || i + 2 >= count) continue;
      choice.camera_file = arguments[i + 1];
      choice.medium = arguments[i + 2];
    }
    return arthronaut::stream(choice);
  }
  if (is(1, "faults") && count > 2)
    return arthronaut::faults(std::atoi(arguments[2]),
                              count > 3 ? static_cast<unsigned>(std::atoi(arguments[3])) : 13,
                              count > 4 ? arguments[4] : "jpeg");
  std::puts("live_chain stream CLIP SECONDS [--record] [--camera FILE MEDIUM] | faults COUNT [SEED [CODEC]]");
  return 2;
}
