// Cameras that are none: what a kernel's V4L2 driver would answer, in a library that stands before the C
// library (linked before it, or LD_PRELOAD) and answers for /dev/videoN itself. The program under test is the
// real one, unchanged.
//
// The cameras lie in a file that is mapped by the test and by the program: what the test writes there while
// the program runs (a plug pulled out, a picture lost, a signal gone) happens there and then. The file is
// named by ARTHRONAUT_FAKE_CAMERAS; beside it lies a folder "dev" that stands for /dev when it is listed.
#pragma once

#include <atomic>
#include <cstdint>

namespace arthronaut::test {

inline constexpr int kFakeCameras = 4;
inline constexpr const char* kFakeCamerasVariable = "ARTHRONAUT_FAKE_CAMERAS";

struct FakeMode {
  std::uint32_t fourcc, width, height;
  std::uint32_t rates[4];  // pictures a second; 0 ends
  std::uint32_t quantization, field;
  std::uint32_t picture_bytes;  // the most that one has
  // The pictures as the driver would write them, over and over: how many (32 bits), then of each its size
  // (32 bits) and its bytes.
  char pictures[256];
};

enum class FakeClock { Monotonic, Wall, None };

// All that is not atomic is written before the program opens the camera.
struct FakeCamera {
  char driver[16], card[32], bus[32];
  FakeMode modes[8];
  std::uint32_t mode_count;
  FakeClock clock;
  std::uint64_t standards;        // of its input; 0: it is a digital one
  std::atomic<bool> tells_sizes;  // else, as some capture cards, none
  std::uint32_t size_step;  // above 0: all sizes between its smallest mode and its largest, in such steps
  std::atomic<bool> is_plugged;
  std::atomic<bool> is_stalled;             // gives nothing, and says nothing
  std::atomic<bool> is_busy;                // another program has it
  std::atomic<int> open_error;              // of open(); 0: none
  std::atomic<int> picture_error;           // of VIDIOC_DQBUF; 0: none
  std::atomic<std::uint32_t> input_status;  // V4L2_IN_ST_...
  std::atomic<std::uint64_t> standard;
  std::atomic<int> loses, damages;        // so many of the next pictures
  std::atomic<int> source_changes;        // counted up: the format of the signal has changed
  std::atomic<std::uint32_t> first_mode;  // those before are not there any more
  // What the program has done.
  std::atomic<int> streaming, most_streaming, opened, given;
  std::atomic<std::uint32_t> mode_in_use, rate_in_use;
};

struct FakeCameras {
  FakeCamera cameras[kFakeCameras];
};

}  // namespace arthronaut::test
