#include "planning/import/child_process.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <limits>
#include <thread>
#include <utility>

#include "planning/files/format.h"
#include "planning/geometry/error.h"
#include "planning/import/import_child.h"
#include "planning/import/import_messages.h"
#include "planning/import/shared_voxels.h"

namespace arthronaut::importing {

namespace {

using Clock = std::chrono::steady_clock;

// A window's frame is not held up for longer by what the child says; the rest comes with the next.
constexpr std::chrono::milliseconds kLongestTaking{20};
constexpr std::size_t kChunk_bytes = 1 << 16;

// Only the child's end of the socket goes with it, as its standard input, and the memory that both see; what
// it prints is lost.
int spawned(const std::filesystem::path& program, int child_end, int shared) {
  posix_spawn_file_actions_t files;
  ::posix_spawn_file_actions_init(&files);
  ::posix_spawn_file_actions_adddup2(&files, child_end, STDIN_FILENO);
  ::posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  ::posix_spawn_file_actions_addopen(&files, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
  if (shared >= 0) ::posix_spawn_file_actions_adddup2(&files, shared, kSharedDescriptor);
  ::posix_spawn_file_actions_addclosefrom_np(&files, shared >= 0 ? kSharedDescriptor + 1 : STDERR_FILENO + 1);
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

// The status of a child that was killed or has closed its end: it is gone in a moment, unless it waits for a
// disc that does not answer. Then nobody else waits: a thread takes leave of it.
int status_of_ended(int process_id) {
  constexpr std::chrono::milliseconds kMoment{1000}, kAgain{1};
  const auto until = Clock::now() + kMoment;
  int status = 0;
  while (Clock::now() < until) {
    const pid_t gone = ::waitpid(process_id, &status, WNOHANG);
    if (gone == process_id || (gone < 0 && errno != EINTR)) return status;
    std::this_thread::sleep_for(kAgain);
  }
  std::thread([process_id] {
    while (::waitpid(process_id, nullptr, 0) < 0 && errno == EINTR) {
    }
  }).detach();
  return SIGKILL;
}

}  // namespace

std::uint64_t memory_limit_bytes(double memory_limit_gib) {
  constexpr double kBytesPerGib = 1024.0 * 1024 * 1024;
  if (!(memory_limit_gib > 0) || memory_limit_gib > 1024)
    throw InvalidInput("the memory limit of an import must lie above 0 and be 1024 GiB at most");
  return static_cast<std::uint64_t>(memory_limit_gib * kBytesPerGib);
}

ChildProcess::ChildProcess(ChildProcessOptions options, const std::string& request)
    : options_(std::move(options)) {
  int ends[2];
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0)
    throw IoError(std::string("no socket for the import: ") + std::strerror(errno));
  socket_ = ends[0];
  try {
    if (options_.shared_bytes > 0) shared_ = create_shared_memory(options_.shared_bytes);
    process_id_ = spawned(options_.program, ends[1], shared_);
  } catch (...) {
    ::close(ends[0]);
    ::close(ends[1]);
    if (shared_ >= 0) ::close(shared_);
    throw;
  }
  ::close(ends[1]);
  // Shorter than the socket's buffer. A child that is gone already is found out by reading.
  static_cast<void>(::send(socket_, request.data(), request.size(), MSG_NOSIGNAL));
}

ChildProcess::~ChildProcess() {
  cancel();
  if (shared_ >= 0) ::close(shared_);
}

ChildProcess::State ChildProcess::wait_for(double seconds, const Take& take) {
  Clock::time_point until;
  for (bool is_first = true; state_ == State::Running; is_first = false) {
    pollfd watched{socket_, POLLIN, 0};
    const double wait_s = is_first && seconds > 0 ? std::clamp(patience_s(), 0.0, seconds) : 0;
    const int ready = ::poll(&watched, 1, static_cast<int>(std::ceil(1000 * wait_s)));
    if (ready < 0) break;  // a signal that the caller wants to see
    if (ready == 0) {
      // What it said while nobody asked has been heard before this.
      if (patience_s() <= 0)
        fail({.words = options_.source.string() +
                       files::format(": nothing was heard of its reading for %.3g s: a file is broken, or "
                                     "the disc does not answer",
                                     options_.longest_silence_s)});
      break;
    }
    std::string chunk(kChunk_bytes, '\0');
    const ssize_t count = ::recv(socket_, chunk.data(), chunk.size(), 0);
    if (count < 0 && errno == EINTR) break;
    heard_ = Clock::now();
    if (is_first) until = heard_ + kLongestTaking;
    if (count <= 0) {
      end_by_itself();
    } else {
      chunk.resize(static_cast<std::size_t>(count));
      take_in(chunk, take);
    }
    if (Clock::now() > until) break;
  }
  return state_;
}

double ChildProcess::patience_s() const {
  if (options_.longest_silence_s <= 0) return std::numeric_limits<double>::infinity();
  return options_.longest_silence_s - std::chrono::duration<double>(Clock::now() - heard_).count();
}

void ChildProcess::take_in(const std::string& bytes, const Take& take) {
  buffer_ += bytes;
  try {
    while (const auto message = take_message(buffer_, options_.longest_message_bytes)) {
      if (message->kind == MessageKind::Failure) return fail(failure_from(message->contents));
      if (!take(*message)) continue;
      // Not left to end by itself: whatever it still does is nobody's wish.
      static_cast<void>(ended_child());
      state_ = State::Done;
      return;
    }
  } catch (const InvalidInput& error) {
    fail({.words = options_.source.string() + ": " + error.what()});
  }
}

void ChildProcess::end_by_itself() {
  const int status = ended_child();
  std::string reason = "ended the importing process";
  if (WIFSIGNALED(status)) {
    reason += files::format(" by signal %d (%s)", WTERMSIG(status), ::strsignal(WTERMSIG(status)));
  } else {
    reason += files::format(" with code %d", WEXITSTATUS(status));
  }
  fail({.words = options_.source.string() + ": " + reason +
                 files::format(
                     ": a file is broken, or needs more than the %.3g GiB of memory that an import may take "
                     "(--memory-limit-gib allows more)",
                     options_.memory_limit_gib)});
}

void ChildProcess::fail(Failure failure) {
  static_cast<void>(ended_child());
  failure_ = std::move(failure);
  state_ = State::Failed;
}

int ChildProcess::ended_child() {
  int status = 0;
  if (process_id_ > 0) {
    // Without effect on one that is ending by itself: its own status is kept.
    ::kill(process_id_, SIGKILL);
    status = status_of_ended(process_id_);
  }
  process_id_ = -1;
  if (socket_ >= 0) ::close(socket_);
  socket_ = -1;
  buffer_ = {};
  return status;
}

void ChildProcess::cancel() {
  if (state_ != State::Running) return;
  static_cast<void>(ended_child());
  failure_.words = "The import was cancelled: nothing was written.";
  state_ = State::Cancelled;
}

}  // namespace arthronaut::importing
