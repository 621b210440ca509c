#include "planning/import/import_process.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cmath>
#include <cstring>
#include <utility>

#include "planning/files/format.h"
#include "planning/geometry/error.h"
#include "planning/import/import_child.h"
#include "planning/import/import_messages.h"
#include "planning/import/shared_voxels.h"

namespace arthronaut::importing {

namespace {

constexpr double kBytesPerGib = 1024.0 * 1024 * 1024;

std::uint64_t limit_bytes(double memory_limit_gib) {
  if (!(memory_limit_gib > 0) || memory_limit_gib > 1024)
    throw InvalidInput("the memory limit of an import must lie above 0 and be 1024 GiB at most");
  return static_cast<std::uint64_t>(memory_limit_gib * kBytesPerGib);
}

// Only the child's end of the socket goes with it, as its standard input, and the memory for the voxels; what
// it prints is lost.
int spawned(const std::filesystem::path& program, int child_end, int shared) {
  posix_spawn_file_actions_t files;
  ::posix_spawn_file_actions_init(&files);
  ::posix_spawn_file_actions_adddup2(&files, child_end, STDIN_FILENO);
  ::posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  ::posix_spawn_file_actions_addopen(&files, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
  ::posix_spawn_file_actions_adddup2(&files, shared, kSharedDescriptor);
  ::posix_spawn_file_actions_addclosefrom_np(&files, kSharedDescriptor + 1);
  // A group of its own: the terminal's Ctrl+C is for the parent, which then ends the child.
  posix_spawnattr_t attributes;
  ::posix_spawnattr_init(&attributes);
  ::posix_spawnattr_setpgroup(&attributes, 0);
  ::posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
  const std::string path = program.string();
  char* words[] = {const_cast<char*>("arthronaut"), const_cast<char*>(kImportChildWord), nullptr};
  pid_t process = -1;
  const int error = ::posix_spawn(&process, path.c_str(), &files, &attributes, words, environ);
  ::posix_spawnattr_destroy(&attributes);
  ::posix_spawn_file_actions_destroy(&files);
  if (error != 0)
    throw IoError(program, std::string("cannot be started for the import: ") + std::strerror(error));
  return process;
}

}  // namespace

ImportProcess::ImportProcess(ImportRequest request) : request_(std::move(request)) {
  const std::uint64_t memory_limit_bytes = limit_bytes(request_.memory_limit_gib);
  request_.options.most_bytes = memory_limit_bytes;
  int ends[2];
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0)
    throw IoError(std::string("no socket for the import: ") + std::strerror(errno));
  socket_ = ends[0];
  try {
    shared_ = create_shared_memory(memory_limit_bytes);
    process_id_ = spawned(request_.program, ends[1], shared_);
  } catch (...) {
    ::close(ends[0]);
    ::close(ends[1]);
    if (shared_ >= 0) ::close(shared_);
    throw;
  }
  ::close(ends[1]);
  const std::string message = message_of(ChildRequest{request_.source, request_.options, memory_limit_bytes});
  // Shorter than the socket's buffer. A child that is gone already is found out by reading.
  static_cast<void>(::send(socket_, message.data(), message.size(), MSG_NOSIGNAL));
}

ImportProcess::~ImportProcess() { cancel(); }

ImportProcess::State ImportProcess::wait_for(double seconds) {
  bool may_wait = seconds > 0;
  while (state_ == State::Running) {
    pollfd watched{socket_, POLLIN, 0};
    const int ready = ::poll(&watched, 1, may_wait ? static_cast<int>(std::ceil(1000 * seconds)) : 0);
    if (ready <= 0) break;  // nothing yet, or a signal that the caller wants to see
    may_wait = false;
    std::string chunk(1 << 18, '\0');
    const ssize_t count = ::recv(socket_, chunk.data(), chunk.size(), 0);
    if (count < 0 && errno == EINTR) break;
    if (count <= 0) {
      end_by_itself();
    } else {
      chunk.resize(static_cast<std::size_t>(count));
      take_in(chunk);
    }
  }
  return state_;
}

void ImportProcess::take_in(const std::string& bytes) {
  buffer_ += bytes;
  try {
    while (const auto message = take_message(buffer_, limit_bytes(request_.memory_limit_gib))) {
      if (message->kind == MessageKind::Progress) {
        progress_ = progress_from(message->contents);
      } else if (message->kind == MessageKind::Result) {
        result_ = import_from(message->contents);
        take_image();
        state_ = State::Done;
        return;
      } else {
        fail(message->contents);
        return;
      }
    }
  } catch (const InvalidInput& error) {
    fail(request_.source.string() + ": " + error.what());
  }
}

// After the child's end, which else could change it meanwhile.
void ImportProcess::take_image() {
  const int shared = std::exchange(shared_, -1);
  static_cast<void>(ended_child());
  if (result_.image) {
    images::EncodedVolume taken = taken_voxels(shared);
    taken.header = std::move(result_.image->volume.header);
    result_.image->volume = std::move(taken);
    if (result_.image->volume.voxels.empty()) result_.image.reset();
  }
  ::close(shared);
}

void ImportProcess::end_by_itself() {
  const int status = ended_child();
  std::string reason = "ended the importing process";
  if (WIFSIGNALED(status)) {
    reason += files::format(" by signal %d (%s)", WTERMSIG(status), ::strsignal(WTERMSIG(status)));
  } else {
    reason += files::format(" with code %d", WEXITSTATUS(status));
  }
  fail(
      request_.source.string() + ": " + reason +
      files::format(": the file is broken, or needs more than the %.3g GiB of memory that an import may take "
                    "(--memory-limit-gib allows more)",
                    request_.memory_limit_gib));
}

void ImportProcess::fail(const std::string& reason) {
  static_cast<void>(ended_child());
  message_ = reason;
  state_ = State::Failed;
}

int ImportProcess::ended_child() {
  int status = 0;
  if (process_id_ > 0) {
    // Without effect on one that is ending by itself: its own status is kept.
    ::kill(process_id_, SIGKILL);
    while (::waitpid(process_id_, &status, 0) < 0 && errno == EINTR) {
    }
  }
  process_id_ = -1;
  if (socket_ >= 0) ::close(socket_);
  if (shared_ >= 0) ::close(shared_);
  socket_ = shared_ = -1;
  return status;
}

BoneImport ImportProcess::take_result() {
  if (state_ != State::Done) throw InvalidInput("the import of " + request_.source.string() + " is not done");
  return std::move(result_);
}

void ImportProcess::cancel() {
  if (state_ != State::Running) return;
  static_cast<void>(ended_child());
  message_ = "The import was cancelled: nothing was written.";
  state_ = State::Cancelled;
}

}  // namespace arthronaut::importing
