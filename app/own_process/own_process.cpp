#include "app/own_process/own_process.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <csignal>
#include <cstring>
#include <fstream>
#include <optional>
#include <thread>
#include <utility>

#include "planning/files/format.h"
#include "planning/geometry/error.h"

namespace arthronaut::own_process {

namespace fs = std::filesystem;

namespace {

constexpr int kUnreliableExit = 4;

// Its complaints alone, in one line.
std::string words_of(const fs::path& log) {
  std::ifstream stream(log);
  std::string words, line;
  while (std::getline(stream, line) && words.size() < 2000) {
    if (const std::string ours = "arthronaut: "; line.starts_with(ours)) line.erase(0, ours.size());
    words += (words.empty() ? "" : " ") + line;
  }
  return words;
}

constexpr int kProgressDescriptor = 3;

// The lines of another process, as far as they have come.
class ProgressPipe {
 public:
  ProgressPipe() {
    if (::pipe2(ends_.data(), O_CLOEXEC) != 0)
      throw IoError("a pipe", std::string("cannot be made: ") + std::strerror(errno));
    ::fcntl(ends_[0], F_SETFL, O_NONBLOCK);
  }
  ~ProgressPipe() {
    ::close(ends_[0]);
    close_writing();
  }
  ProgressPipe(const ProgressPipe&) = delete;
  ProgressPipe& operator=(const ProgressPipe&) = delete;
  [[nodiscard]] int writing() const { return ends_[1]; }
  void close_writing() {
    if (ends_[1] >= 0) ::close(std::exchange(ends_[1], -1));
  }
  // Tells the newest whole line, where there is one.
  void follow(const OnProgress& on_progress) {
    std::array<char, 512> part{};
    ssize_t size = 0;
    while ((size = ::read(ends_[0], part.data(), part.size())) > 0)
      unread_.append(part.data(), static_cast<std::size_t>(size));
    const std::size_t end = unread_.rfind('\n');
    if (end == std::string::npos) return;
    const std::size_t before = end == 0 ? std::string::npos : unread_.rfind('\n', end - 1);
    const std::size_t begin = before == std::string::npos ? 0 : before + 1;
    const std::string line = unread_.substr(begin, end - begin);
    unread_.erase(0, end + 1);
    const std::size_t space = line.find(' ');
    double share = 0;
    const auto read = std::from_chars(line.data(), line.data() + std::min(space, line.size()), share);
    if (space != std::string::npos && read.ec == std::errc()) on_progress(line.substr(space + 1), share);
  }

 private:
  std::array<int, 2> ends_{-1, -1};
  std::string unread_;
};

pid_t spawn(const fs::path& program, std::vector<std::string> arguments, const fs::path& log,
            const ProgressPipe* progress) {
  std::vector<char*> words;
  for (std::string& argument : arguments) words.push_back(argument.data());
  words.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, log.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  if (progress != nullptr)
    posix_spawn_file_actions_adddup2(&actions, progress->writing(), kProgressDescriptor);
  pid_t process = -1;
  const int error = ::posix_spawn(&process, program.c_str(), &actions, nullptr, words.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (error != 0) throw IoError(program, std::string("cannot be started: ") + std::strerror(error));
  return process;
}

}  // namespace

CommandOutcome run_command(const fs::path& program, std::vector<std::string> arguments, const fs::path& log,
                           const std::function<bool()>& stops, const OnProgress& on_progress) {
  arguments.insert(arguments.begin(), "arthronaut");
  std::optional<ProgressPipe> progress;
  if (on_progress) {
    progress.emplace();
    arguments.insert(arguments.end(), {"--progress-fd", std::to_string(kProgressDescriptor)});
  }
  const pid_t process = spawn(program, std::move(arguments), log, progress ? &*progress : nullptr);
  if (progress) progress->close_writing();
  std::error_code ignored;
  int status = 0;
  pid_t ended = 0;
  bool was_killed = false;
  while ((ended = ::waitpid(process, &status, WNOHANG)) == 0 || (ended < 0 && errno == EINTR)) {
    if (stops()) {
      ::kill(process, SIGKILL);
      while ((ended = ::waitpid(process, &status, 0)) < 0 && errno == EINTR) {
      }
      was_killed = true;
      break;
    }
    if (progress) progress->follow(on_progress);
    std::this_thread::sleep_for(std::chrono::milliseconds(30));
  }
  const std::string words = words_of(log);
  fs::remove(log, ignored);
  // It may have come to its end just before it was to be stopped: then what it wrote is there.
  const bool has_exited = ended == process && WIFEXITED(status);
  if (was_killed && !has_exited) return {CommandOutcome::End::Stopped, "Stopped"};
  if (has_exited && WEXITSTATUS(status) == 0) return {CommandOutcome::End::Done, words};
  if (has_exited && WEXITSTATUS(status) == kUnreliableExit) return {CommandOutcome::End::Unreliable, words};
  return {CommandOutcome::End::Failed, words};
}

void tell_progress(int descriptor, const std::string& what, double share) {
  // Whoever read it may be gone: that is no reason to end.
  ::signal(SIGPIPE, SIG_IGN);
  const std::string line = files::format("%.3f ", share) + what + "\n";
  (void)!::write(descriptor, line.data(), line.size());
}

}  // namespace arthronaut::own_process
