// The kernel's side of fake_camera.h: open, ioctl, poll and close for /dev/videoN, all else passed on.
#include <fcntl.h>
#include <poll.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <cstdarg>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <map>
#include <memory>
#include <mutex>
#include <string>

#include "tests/fake_camera/kernel_camera.h"

namespace {

using arthronaut::test::clock_now_ns;
using arthronaut::test::FakeCamera;
using arthronaut::test::FakeCameras;
using arthronaut::test::Mapping;
using arthronaut::test::OpenCamera;

const char* cameras_file() { return ::getenv(arthronaut::test::kFakeCamerasVariable); }

// All open files of cameras. Never taken apart: the program may close some while it ends.
struct OpenFiles {
  std::mutex mutex;
  std::map<int, std::unique_ptr<OpenCamera>> cameras;
};
OpenFiles& open_files() {
  static OpenFiles* const files = new OpenFiles;
  return *files;
}

// Below -1: not one of ours.
int open_fake(const char* path) {
  constexpr int kNotOurs = -2;
  const char* const file = cameras_file();
  if (file == nullptr || std::strncmp(path, "/dev/video", 10) != 0) return kNotOurs;
  char* end = nullptr;
  const long index = std::strtol(path + 10, &end, 10);
  if (end == path + 10 || *end != '\0' || index < 0 || index >= arthronaut::test::kFakeCameras)
    return kNotOurs;
  auto room = std::make_shared<Mapping>(file, O_RDWR, PROT_READ | PROT_WRITE);
  if (room->data() == nullptr) return kNotOurs;
  FakeCamera& camera = reinterpret_cast<FakeCameras*>(room->data())->cameras[index];
  errno = camera.is_plugged ? camera.open_error.load() : ENOENT;
  if (errno != 0) return -1;
  const int opened = static_cast<int>(::syscall(SYS_memfd_create, path, 1U /* close on exec */));
  if (opened < 0) return -1;
  OpenFiles& files = open_files();
  const std::lock_guard lock(files.mutex);
  files.cameras[opened] = std::make_unique<OpenCamera>(opened, std::move(room), camera);
  return opened;
}

int open_any(int folder, const char* path, int flags, mode_t mode) {
  const char* const file = cameras_file();
  if (file != nullptr && std::strcmp(path, "/dev") == 0) {
    const std::string stands_for_it = std::string(file, std::strrchr(file, '/')) + "/dev";
    return static_cast<int>(::syscall(SYS_openat, folder, stands_for_it.c_str(), flags, mode));
  }
  if (const int fake = open_fake(path); fake >= -1) return fake;
  return static_cast<int>(::syscall(SYS_openat, folder, path, flags, mode));
}

mode_t mode_in(int flags, va_list arguments) {
  return (flags & (O_CREAT | O_TMPFILE)) != 0 ? static_cast<mode_t>(va_arg(arguments, unsigned)) : 0;
}

}  // namespace

extern "C" {

int open(const char* path, int flags, ...) {
  va_list arguments;
  va_start(arguments, flags);
  const mode_t mode = mode_in(flags, arguments);
  va_end(arguments);
  return open_any(AT_FDCWD, path, flags, mode);
}

int open64(const char* path, int flags, ...) {
  va_list arguments;
  va_start(arguments, flags);
  const mode_t mode = mode_in(flags, arguments);
  va_end(arguments);
  return open_any(AT_FDCWD, path, flags, mode);
}

int __open_2(const char* path, int flags) { return open_any(AT_FDCWD, path, flags, 0); }
int __open64_2(const char* path, int flags) { return open_any(AT_FDCWD, path, flags, 0); }

int openat(int folder, const char* path, int flags, ...) {
  va_list arguments;
  va_start(arguments, flags);
  const mode_t mode = mode_in(flags, arguments);
  va_end(arguments);
  return open_any(folder, path, flags, mode);
}

int ioctl(int file, unsigned long what, ...) noexcept {
  va_list arguments;
  va_start(arguments, what);
  void* const with = va_arg(arguments, void*);
  va_end(arguments);
  if (cameras_file() != nullptr) {
    OpenFiles& files = open_files();
    const std::lock_guard lock(files.mutex);
    if (const auto found = files.cameras.find(file); found != files.cameras.end()) {
      const int error = found->second->request(what, with);
      if (error != 0) errno = error;
      return error == 0 ? 0 : -1;
    }
  }
  return static_cast<int>(::syscall(SYS_ioctl, file, what, with));
}

int poll(pollfd* waits, nfds_t count, int patience_ms) {
  const std::int64_t until_ns = clock_now_ns() + patience_ms * std::int64_t{1'000'000};
  while (count == 1 && cameras_file() != nullptr) {
    {
      OpenFiles& files = open_files();
      const std::lock_guard lock(files.mutex);
      const auto found = files.cameras.find(waits->fd);
      if (found == files.cameras.end()) break;
      waits->revents = static_cast<short>(found->second->ready() & (waits->events | POLLERR | POLLHUP));
    }
    if (waits->revents != 0) return 1;
    if (patience_ms >= 0 && clock_now_ns() >= until_ns) return 0;
    constexpr timespec kMoment{0, 500'000};
    ::nanosleep(&kMoment, nullptr);
  }
  return static_cast<int>(::syscall(SYS_poll, waits, count, patience_ms));
}

int close(int file) {
  if (cameras_file() != nullptr) {
    OpenFiles& files = open_files();
    const std::lock_guard lock(files.mutex);
    files.cameras.erase(file);
  }
  return static_cast<int>(::syscall(SYS_close, file));
}

}  // extern "C"
