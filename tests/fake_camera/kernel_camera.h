// Inner header: one open file of a camera that is none, as its driver would answer for it.
#pragma once

#include <fcntl.h>
#include <linux/videodev2.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cstdint>
#include <ctime>
#include <deque>
#include <memory>
#include <utility>
#include <vector>

#include "tests/fake_camera/fake_camera.h"

namespace arthronaut::test {

inline constexpr std::int64_t kFakeSecond_ns = 1'000'000'000;

inline std::int64_t clock_now_ns(clockid_t clock = CLOCK_MONOTONIC) {
  timespec now{};
  ::clock_gettime(clock, &now);
  return now.tv_sec * kFakeSecond_ns + now.tv_nsec;
}

// A file in memory for as long as it is mapped.
class Mapping {
 public:
  Mapping(const char* path, int flags, int protection) {
    const int file = static_cast<int>(::syscall(SYS_openat, AT_FDCWD, path, flags | O_CLOEXEC, 0));
    if (file < 0) return;
    size_ = static_cast<std::size_t>(::lseek(file, 0, SEEK_END));
    void* const at = ::mmap(nullptr, size_, protection, MAP_SHARED, file, 0);
    if (at != MAP_FAILED) data_ = static_cast<std::uint8_t*>(at);
    ::syscall(SYS_close, file);
  }
  ~Mapping() {
    if (data_ != nullptr) ::munmap(data_, size_);
  }
  Mapping(const Mapping&) = delete;
  Mapping& operator=(const Mapping&) = delete;
  [[nodiscard]] std::uint8_t* data() const { return data_; }

 private:
  std::uint8_t* data_ = nullptr;
  std::size_t size_ = 0;
};

// One open file of a camera.
class OpenCamera {
 public:
  OpenCamera(int file, std::shared_ptr<Mapping> room, FakeCamera& camera)
      : file_(file), room_(std::move(room)), camera_(camera), changes_(camera.source_changes) {
    ++camera_.opened;
  }
  ~OpenCamera() { stop(); }
  OpenCamera(const OpenCamera&) = delete;
  OpenCamera& operator=(const OpenCamera&) = delete;

  int request(unsigned long what, void* with);
  short ready();

 private:
  [[nodiscard]] const FakeMode* mode() const { return &camera_.modes[mode_]; }
  [[nodiscard]] std::size_t slot_bytes() const { return (mode()->picture_bytes + 4095U) & ~4095U; }
  int enumerate_format(v4l2_fmtdesc& format) const;
  int enumerate_size(v4l2_frmsizeenum& size) const;
  int enumerate_rate(v4l2_frmivalenum& rate) const;
  int enumerate_input(v4l2_input& input) const;
  int enumerate_standard(v4l2_standard& standard) const;
  int format(v4l2_format& format, bool is_set);
  int rate(v4l2_streamparm& parameters, bool is_set);
  int request_buffers(v4l2_requestbuffers& request);
  int start();
  int stop();
  int take(v4l2_buffer& buffer);
  void make_due_pictures();
  void write_picture(std::int64_t due_ns);

  int file_;
  std::shared_ptr<Mapping> room_;
  FakeCamera& camera_;
  int changes_;  // that were told
  std::uint32_t mode_ = 0, rate_ = 0;
  bool streams_ = false, hears_changes_ = false;
  std::uint32_t buffer_count_ = 0, sequence_ = 0, next_picture_ = 0;
  std::int64_t due_ns_ = 0;
  std::unique_ptr<Mapping> pictures_;
  std::vector<std::pair<const std::uint8_t*, std::uint32_t>> each_picture_;
  std::uint8_t* slots_ = nullptr;
  std::deque<std::uint32_t> empty_;
  std::deque<v4l2_buffer> full_;
};

}  // namespace arthronaut::test
