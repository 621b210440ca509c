// Starts a program in a room with cameras that are none, to try by hand what a camera would do:
//
//   in_camera_room clip.mkv [other.mkv ...] -- arthronaut navigate knee.arthro --video /dev/video0
//
// Each clip is a camera, over and over: its first 120 pictures as mjpeg at 60 and 30 a second, nv12 at 30,
// yuyv at 10. A line on standard input is done there and then: "unplug 0", "plug 0", "stall 0", "run 0",
// "signal 0" (it is gone; again: it is back), "lose 0 40", "damage 0 10", "change 0", "busy 0", "free 0".
#include <linux/videodev2.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <iostream>
#include <memory>
#include <sstream>
#include <thread>

#include "navigation/sources/frame_source.h"
#include "tests/fake_camera/camera_room.h"

namespace {

using arthronaut::test::CameraRoom;
using arthronaut::test::FakeCamera;

void show_clip(CameraRoom& room, int index, const char* clip) {
  constexpr std::size_t kMost = 120;
  const auto source = arthronaut::sources::open_source(clip);
  std::vector<cv::Mat> pictures;
  std::vector<std::uint8_t> scratch;
  while (const auto frame = source->next()) {
    std::vector<std::uint8_t> bgr = bgr_of(*frame, scratch);
    pictures.push_back(cv::Mat(frame->height, frame->width, CV_8UC3, bgr.data()).clone());
    if (pictures.size() == kMost) break;
  }
  if (pictures.empty()) throw std::runtime_error(std::string(clip) + ": holds no picture");
  room.add_mode(index, V4L2_PIX_FMT_MJPEG, pictures, {60, 30});
  room.add_mode(index, V4L2_PIX_FMT_NV12, pictures, {30});
  room.add_mode(index, V4L2_PIX_FMT_YUYV, pictures, {10});
  room.plug(index);
}

void obey(CameraRoom& room, const std::string& line) {
  std::istringstream words(line);
  std::string what;
  int index = 0, count = 1;
  if (!(words >> what >> index) || index < 0 || index >= arthronaut::test::kFakeCameras) return;
  words >> count;
  FakeCamera& camera = room.camera(index);
  if (what == "unplug") room.unplug(index);
  if (what == "plug") room.plug(index);
  if (what == "stall") camera.is_stalled = true;
  if (what == "run") camera.is_stalled = false;
  if (what == "signal") camera.input_status = camera.input_status == 0 ? V4L2_IN_ST_NO_SIGNAL : 0;
  if (what == "lose") camera.loses = count;
  if (what == "damage") camera.damages = count;
  if (what == "change") ++camera.source_changes;
  if (what == "busy") camera.is_busy = true;
  if (what == "free") camera.is_busy = false;
}

int run(std::vector<char*> arguments) {
  std::vector<char*> clips;
  std::size_t at = 1;
  for (; at < arguments.size() && std::string_view(arguments[at]) != "--"; ++at)
    clips.push_back(arguments[at]);
  if (clips.empty() || clips.size() > arthronaut::test::kFakeCameras || at + 1 >= arguments.size()) {
    std::cerr << "in_camera_room CLIP... -- PROGRAM ARGUMENTS...\n";
    return 2;
  }
  auto room_here = std::make_unique<CameraRoom>();
  CameraRoom& room = *room_here;
  for (std::size_t i = 0; i < clips.size(); ++i) show_clip(room, static_cast<int>(i), clips[i]);
  const pid_t child = ::fork();
  if (child == 0) {
    ::setenv("LD_PRELOAD", FAKE_CAMERA_LIBRARY, 1);
    std::vector<char*> command(arguments.begin() + static_cast<std::ptrdiff_t>(at) + 1, arguments.end());
    command.push_back(nullptr);
    ::execvp(command[0], command.data());
    ::_exit(127);
  }
  std::thread([&room] {
    for (std::string line; std::getline(std::cin, line);) obey(room, line);
  }).detach();
  int status = 0;
  ::waitpid(child, &status, 0);
  std::cout.flush();
  // Standard input may never end.
  const int code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  room_here.reset();
  ::_exit(code);
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run({argv, argv + argc});
  } catch (const std::exception& error) {
    std::cerr << "in_camera_room: " << error.what() << '\n';
    return 1;
  }
}
