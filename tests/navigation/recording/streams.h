// Streams over the loopback, sent by processes of their own that can be killed.
#pragma once

#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "navigation/sources/frame_source.h"
#include "planning/geometry/error.h"
#include "tests/child_process.h"

namespace arthronaut::test {

inline constexpr int kStreamWidth = 320, kStreamHeight = 240;

// A port of this process alone, so that tests side by side do not hear each other.
inline std::string stream_port(int offset) {
  return std::to_string(20000 + (::getpid() * 8 + offset) % 40000);
}

inline pid_t run_ffmpeg(const std::vector<std::string>& options) {
  std::vector<std::string> words = {"ffmpeg", "-loglevel", "quiet", "-nostdin", "-y"};
  words.insert(words.end(), options.begin(), options.end());
  return run_program(words);
}

// A moving test picture as MPEG-TS by UDP, at its own rate. `codec`: options of ffmpeg.
inline std::unique_ptr<ChildProcess> send_by_udp(const std::string& port,
                                                 const std::vector<std::string>& codec) {
  std::vector<std::string> options = {
      "-re", "-f", "lavfi", "-i",
      "testsrc2=size=" + std::to_string(kStreamWidth) + "x" + std::to_string(kStreamHeight) + ":rate=30"};
  options.insert(options.end(), codec.begin(), codec.end());
  options.insert(options.end(), {"-f", "mpegts", "udp://127.0.0.1:" + port + "?pkt_size=1316"});
  return std::make_unique<ChildProcess>(run_ffmpeg(options));
}

// A clip of so many pictures. `codec`: options of ffmpeg.
inline void make_clip(const std::filesystem::path& file, int pictures, const std::vector<std::string>& codec,
                      const std::string& size = std::to_string(kStreamWidth) + "x" +
                                                std::to_string(kStreamHeight)) {
  std::vector<std::string> options = {
      "-f", "lavfi", "-i", "testsrc2=size=" + size + ":rate=30", "-frames:v", std::to_string(pictures)};
  options.insert(options.end(), codec.begin(), codec.end());
  options.push_back(file.string());
  ::waitpid(run_ffmpeg(options), nullptr, 0);
}

// Waits until somebody sends.
inline std::unique_ptr<sources::FrameSource> open_when_there(const std::string& address) {
  for (int tries = 0;; ++tries) {
    try {
      return sources::open_source(address);
    } catch (const DeviceError&) {
      if (tries == 50) throw;
      std::this_thread::sleep_for(std::chrono::milliseconds(200));
    }
  }
}

}  // namespace arthronaut::test
