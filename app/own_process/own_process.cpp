#include "app/own_process/own_process.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <fstream>
#include <thread>

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

pid_t spawn(const fs::path& program, std::vector<std::string> arguments, const fs::path& log) {
  std::vector<char*> words;
  for (std::string& argument : arguments) words.push_back(argument.data());
  words.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, log.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  pid_t process = -1;
  const int error = ::posix_spawn(&process, program.c_str(), &actions, nullptr, words.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (error != 0) throw IoError(program, std::string("cannot be started: ") + std::strerror(error));
  return process;
}

}  // namespace

CommandOutcome run_command(const fs::path& program, std::vector<std::string> arguments, const fs::path& log,
                           const std::function<bool()>& stops) {
  arguments.insert(arguments.begin(), "arthronaut");
  const pid_t process = spawn(program, std::move(arguments), log);
  std::error_code ignored;
  int status = 0;
  pid_t ended = 0;
  while ((ended = ::waitpid(process, &status, WNOHANG)) == 0 || (ended < 0 && errno == EINTR)) {
    if (stops()) {
      ::kill(process, SIGKILL);
      ::waitpid(process, nullptr, 0);
      fs::remove(log, ignored);
      return {CommandOutcome::End::Stopped, "Stopped"};
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(30));
  }
  const std::string words = words_of(log);
  fs::remove(log, ignored);
  const bool has_exited = ended == process && WIFEXITED(status);
  if (has_exited && WEXITSTATUS(status) == 0) return {CommandOutcome::End::Done, words};
  if (has_exited && WEXITSTATUS(status) == kUnreliableExit) return {CommandOutcome::End::Unreliable, words};
  return {CommandOutcome::End::Failed, words};
}

}  // namespace arthronaut::own_process
