#include "app/start/results_process.h"

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
#include <vector>

#include "planning/files/private_folder.h"
#include "planning/geometry/error.h"

namespace arthronaut::start {

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

ResultsOutcome write_dicom_results(const fs::path& program, const fs::path& case_folder,
                                   const fs::path& folder, bool is_deidentified,
                                   const std::stop_token& stop) {
  files::create_private_folder(folder.parent_path());
  std::error_code error;
  fs::remove_all(folder, error);
  if (error) throw IoError(folder, "cannot be emptied: " + error.message());
  const fs::path log = folder.parent_path() / (folder.filename().string() + ".log");
  std::vector<std::string> arguments{"arthronaut", "dicom", case_folder.string(), "-o", folder.string()};
  if (is_deidentified) arguments.emplace_back("--deidentified");
  const pid_t process = spawn(program, std::move(arguments), log);
  int status = 0;
  pid_t ended = 0;
  while ((ended = ::waitpid(process, &status, WNOHANG)) == 0 || (ended < 0 && errno == EINTR)) {
    if (stop.stop_requested()) {
      ::kill(process, SIGKILL);
      ::waitpid(process, nullptr, 0);
      fs::remove_all(folder, error);
      fs::remove(log, error);
      return {ResultsOutcome::End::Stopped, "Stopped"};
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(30));
  }
  const std::string words = words_of(log);
  fs::remove(log, error);
  if (ended == process && WIFEXITED(status) && WEXITSTATUS(status) == 0)
    return {ResultsOutcome::End::Written, words};
  if (ended == process && WIFEXITED(status) && WEXITSTATUS(status) == kUnreliableExit)
    return {ResultsOutcome::End::Unreliable, words};
  fs::remove_all(folder, error);
  return {ResultsOutcome::End::Failed, words.empty() ? "the results could not be written" : words};
}

}  // namespace arthronaut::start
