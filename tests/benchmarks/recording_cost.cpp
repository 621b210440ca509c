// What it costs to keep the pictures of a live stream in each way, and how long any picture of it takes to be
// shown again.
//   recording_cost CLIP SECONDS     CLIP: H.264 in Matroska, sent by RTSP over the loopback at its own rate
// Prints for each way: processor time a picture, of taking and keeping (less that of taking alone), bytes,
// what was left out; and the time to random pictures, to the next and to the one before.
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <random>

#include "navigation/recording/picture_writer.h"
#include "navigation/sources/kept_stream.h"
#include "navigation/sources/video_file.h"
#include "tests/navigation/recording/streams.h"
#include "tests/temporary_folder.h"

namespace arthronaut {
namespace {

using Clock = std::chrono::steady_clock;
using recording::PicturesAs;

double processor_s() {
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + static_cast<double>(t.tv_usec) * 1e-6;
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

struct Kept {
  std::vector<recording::VideoPart> parts;
  std::vector<recording::KeptPicture> pictures;
};

// Processor time a picture, ms. Nothing is kept without a way.
double run(const std::string& clip, int port_offset, double seconds, std::optional<PicturesAs> as,
           const std::filesystem::path& folder, Kept& kept) {
  const std::string port = test::stream_port(port_offset);
  const auto sender = test::send_by_rtsp(port, test::h264_clip_launch(clip));
  const auto source = test::open_when_there(test::rtsp_address(port));
  std::optional<recording::PictureWriter> writer;
  if (as)
    writer.emplace(folder, recording::PictureWriterOptions{*as, source->info().packets, 60},
                   recording::PictureNews{
                       [&](const recording::VideoPart& part, const camera::Frame&, const std::string& why) {
                         kept.parts.push_back(part);
                         if (!why.empty()) std::printf("  %s: %s\n", part.file.c_str(), why.c_str());
                       },
                       [&](const recording::KeptPicture& picture) { kept.pictures.push_back(picture); },
                       {}});
  const double before_s = processor_s();
  const auto begin = Clock::now();
  int count = 0, left_out = 0;
  while (std::chrono::duration<double>(Clock::now() - begin).count() < seconds) {
    const camera::FramePtr frame = source->next();
    if (frame == nullptr) break;
    ++count;
    if (writer && !writer->try_write(frame)) ++left_out;
  }
  if (writer) writer->finish();
  const double cost_ms = 1000 * (processor_s() - before_s) / std::max(count, 1);
  std::uintmax_t bytes = 0;
  for (const recording::VideoPart& part : kept.parts) bytes += std::filesystem::file_size(folder / part.file);
  std::printf(
      "%-14s %5d pictures, %4d left out, %6.2f ms a picture in all, %8.1f kB a picture, %zu part(s)\n",
      as ? std::string(recording::to_text(*as)).c_str() : "nothing", count, left_out, cost_ms,
      static_cast<double>(bytes) / 1000 / std::max(count, 1), kept.parts.size());
  source->info().line->end();
  return cost_ms;
}

void print_times(const char* what, std::vector<double> times_ms) {
  if (times_ms.empty()) return;
  std::sort(times_ms.begin(), times_ms.end());
  std::printf("  %-22s median %7.1f ms, 90 %% %7.1f ms, worst %7.1f ms of %zu\n", what,
              times_ms[times_ms.size() / 2], times_ms[times_ms.size() * 9 / 10], times_ms.back(),
              times_ms.size());
}

// Of the first part, which was kept as it came.
void look(const std::filesystem::path& folder, const Kept& kept) {
  sources::KeptStreamFile file{folder / kept.parts[0].file, kept.parts[0].held_back, {}};
  const std::size_t end =
      kept.parts.size() > 1 ? static_cast<std::size_t>(kept.parts[1].first_picture) : kept.pictures.size();
  for (std::size_t i = 0; i < end; ++i)
    if (file.starts.empty() || kept.pictures[i].start_packet > file.starts.back().packet)
      file.starts.push_back({kept.pictures[i].start_packet, kept.pictures[i].start_ms});
  sources::KeptStream stream(file, sources::KeptStream::Use::ToLookAt);
  std::mt19937 random(1);
  std::vector<double> across_ms, next_ms, back_ms;
  const auto timed = [&](std::size_t at, std::vector<double>& times_ms) {
    const auto begin = Clock::now();
    if (stream.picture(kept.pictures[at].packet) == nullptr) std::printf("  no picture at %zu\n", at);
    times_ms.push_back(std::chrono::duration<double, std::milli>(Clock::now() - begin).count());
  };
  for (int i = 0; i < 40; ++i) {
    const std::size_t at = std::uniform_int_distribution<std::size_t>(20, end - 2)(random);
    timed(at, across_ms);
    timed(at + 1, next_ms);
    for (std::size_t back = 1; back <= 5; ++back) timed(at + 1 - back, back_ms);
  }
  std::printf("%zu key frames\n", file.starts.size());
  print_times("any picture", across_ms);
  print_times("the next", next_ms);
  print_times("the one before", back_ms);
}

}  // namespace
}  // namespace arthronaut

int main(int count, char** arguments) {
  using namespace arthronaut;
  if (count < 3) return std::puts("recording_cost CLIP SECONDS"), 2;
  const double seconds = std::atof(arguments[2]);
  const test::TemporaryFolder folder;
  Kept none, came;
  const double taking_ms = run(arguments[1], 0, seconds, std::nullopt, folder.path(), none);
  int offset = 1;
  for (const PicturesAs as : {PicturesAs::AsTheyCame, PicturesAs::Lossless, PicturesAs::H264}) {
    const std::filesystem::path to = folder / std::to_string(offset);
    std::filesystem::create_directory(to);
    Kept kept;
    const double all_ms = run(arguments[1], offset++, seconds, as, to, kept);
    std::printf("  keeping costs %.2f ms a picture\n", all_ms - taking_ms);
    if (as == PicturesAs::AsTheyCame && !kept.parts.empty()) look(to, kept);
  }
  return 0;
}
