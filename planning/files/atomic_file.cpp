#include "planning/files/atomic_file.h"

#include <fcntl.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <iostream>
#include <utility>

#include "planning/files/format.h"
#include "planning/files/pipe.h"
#include "planning/files/private_folder.h"
#include "planning/geometry/error.h"

namespace arthronaut::files {

namespace {

namespace fs = std::filesystem;
constexpr mode_t kOwnerAlone = 0600, kAsTheUserHasIt = 0666;  // the latter less the umask

// A file descriptor that closes itself.
class Descriptor {
 public:
  explicit Descriptor(int fd) : fd_(fd) {}
  ~Descriptor() {
    if (fd_ >= 0) ::close(fd_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  [[nodiscard]] int get() const { return fd_; }
  // close() can report a write error that write() did not (NFS, quota).
  [[nodiscard]] int close() { return ::close(std::exchange(fd_, -1)); }

 private:
  int fd_;
};

[[noreturn]] void fail(const fs::path& file, const char* what) {
  throw IoError(file, std::string(what) + ": " + std::strerror(errno));
}

void sync_folder(const fs::path& folder) {
  const Descriptor descriptor(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  // Some file systems cannot sync a folder; the rename itself is still atomic there.
  if (descriptor.get() >= 0) ::fsync(descriptor.get());
}

void sync_file(const fs::path& file, bool for_owner_alone) {
  const Descriptor descriptor(::open(file.c_str(), O_RDONLY | O_CLOEXEC));
  if (descriptor.get() < 0) fail(file, "cannot open");
  // Writers of their own (a video encoder) made the file as the umask has it. On file systems that know no
  // rights this fails, and nothing can be done about it.
  if (for_owner_alone) (void)::fchmod(descriptor.get(), kOwnerAlone);
  if (::fsync(descriptor.get()) != 0) fail(file, "cannot write");
}

void write_whole(const fs::path& file, std::string_view contents, mode_t mode) {
  Descriptor descriptor(::open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, mode));
  if (descriptor.get() < 0) fail(file, "cannot create");
  while (!contents.empty()) {
    const ssize_t written = ::write(descriptor.get(), contents.data(), contents.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail(file, "cannot write");
    contents.remove_prefix(static_cast<std::size_t>(written));
  }
  if (descriptor.close() != 0) fail(file, "cannot write");
}

fs::path folder_of(const fs::path& target) {
  return target.has_parent_path() ? target.parent_path() : fs::path(".");
}

fs::path temporary_beside(const fs::path& target) {
  static std::atomic<unsigned> counter{0};
  return target.parent_path() / format(".%s.%d-%u.partial%s", target.stem().c_str(),
                                       static_cast<int>(::getpid()), counter++, target.extension().c_str());
}

// A device or a pipe (/dev/full, /dev/stdout) is written to; renaming over it would replace it.
bool is_written_through(const fs::path& target) {
  std::error_code ignored;
  return fs::is_other(target, ignored);
}

// For a writer that needs a path of its own; the folder is the user's alone, and gone afterwards.
std::string written_elsewhere(const fs::path& target, const std::function<void(const fs::path&)>& write) {
  struct Folder {
    std::string path = (fs::temp_directory_path() / "arthronaut-XXXXXX").string();
    bool is_made = ::mkdtemp(path.data()) != nullptr;
    ~Folder() {
      std::error_code ignored;
      if (is_made) fs::remove_all(path, ignored);
    }
  } folder;
  if (!folder.is_made) fail(folder.path, "cannot be created");
  const fs::path file = fs::path(folder.path) / target.filename();
  write(file);
  return read_text(file);
}

}  // namespace

void write_atomically(const fs::path& target, const std::function<void(const fs::path&)>& write) {
  if (is_written_through(target))
    return write_whole(target, written_elsewhere(target, write), kAsTheUserHasIt);
  const fs::path folder = folder_of(target);
  if (std::error_code ignored; !fs::is_directory(folder, ignored))
    throw IoError(target, "the folder " + folder.string() + " does not exist");
  // The user knows the target's name, not that of the file beside it: errors speak of the target.
  const fs::path temporary = temporary_beside(target);
  try {
    write(temporary);
    sync_file(temporary, is_private(folder));
    if (::rename(temporary.c_str(), target.c_str()) != 0) fail(target, "cannot replace");
  } catch (const IoError& error) {
    std::error_code ignored;
    fs::remove(temporary, ignored);
    std::string message = error.what();
    if (const auto at = message.find(temporary.string()); at != std::string::npos) {
      message.replace(at, temporary.string().size(), target.string());
    }
    throw IoError(message);
  } catch (...) {
    std::error_code ignored;
    fs::remove(temporary, ignored);
    throw;
  }
  sync_folder(folder);
}

void write_atomically(const fs::path& target, std::string_view contents) {
  if (target == "-") {
    std::cout << contents << std::flush;
    if (!std::cout) throw IoError("standard output: cannot write");
    return;
  }
  if (is_written_through(target)) return write_whole(target, contents, kAsTheUserHasIt);
  const mode_t mode = is_private(folder_of(target)) ? kOwnerAlone : kAsTheUserHasIt;
  write_atomically(target,
                   [contents, mode](const fs::path& temporary) { write_whole(temporary, contents, mode); });
}

std::string read_text(const fs::path& file) {
  if (std::error_code ignored; fs::is_directory(file, ignored))
    throw IoError(file, "is a folder, not a file");
  refuse_pipe(file);
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw IoError(file, std::string("cannot open: ") + std::strerror(errno));
  std::string text;
  std::array<char, 65536> buffer{};
  while (stream.read(buffer.data(), buffer.size()), stream.gcount() > 0)
    text.append(buffer.data(), static_cast<std::size_t>(stream.gcount()));
  if (stream.bad()) throw IoError(file, "cannot be read to its end");
  return text;
}

}  // namespace arthronaut::files
