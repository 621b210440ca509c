#include "tests/app/command_line/program.h"

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <thread>

#include "tests/temporary_folder.h"

namespace arthronaut::test {

namespace fs = std::filesystem;

namespace {

std::string contents_of(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  return std::move(text).str();
}

[[noreturn]] void become_program(const std::vector<std::string>& arguments, const ProgramLimits& limits,
                                 const fs::path& data_home, int output, int errors) {
  ::setenv("XDG_DATA_HOME", data_home.c_str(), 1);
  ::dup2(output, STDOUT_FILENO);
  ::dup2(errors, STDERR_FILENO);
  if (limits.file_size_bytes > 0) {
    const auto bytes = static_cast<rlim_t>(limits.file_size_bytes);
    const rlimit limit{bytes, bytes};
    ::setrlimit(RLIMIT_FSIZE, &limit);
  }
  // Opened before rights are given up: the program may lie in a home that is closed to others.
  const int program = ::open(ARTHRONAUT_PROGRAM, O_RDONLY | O_CLOEXEC);
  constexpr unsigned kNobody = 65534;
  if (limits.as_nobody && ::geteuid() == 0 && (::setgid(kNobody) != 0 || ::setuid(kNobody) != 0))
    ::_exit(126);
  std::vector<char*> words{const_cast<char*>(ARTHRONAUT_PROGRAM)};
  for (const std::string& argument : arguments) words.push_back(const_cast<char*>(argument.c_str()));
  words.push_back(nullptr);
  ::fexecve(program, words.data(), environ);
  ::_exit(127);
}

// Both ends of a terminal.
struct Terminal {
  int ours = -1, theirs = -1;
};

Terminal new_terminal() {
  Terminal terminal;
  terminal.ours = ::posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC);
  if (::grantpt(terminal.ours) == 0 && ::unlockpt(terminal.ours) == 0)
    terminal.theirs = ::open(::ptsname(terminal.ours), O_RDWR | O_NOCTTY | O_CLOEXEC);
  return terminal;
}

// Until nobody has the other end any more.
std::string all_of(int terminal) {
  std::string text;
  char chunk[4096];
  for (ssize_t count = 0; (count = ::read(terminal, chunk, sizeof(chunk))) > 0;)
    text.append(chunk, static_cast<std::size_t>(count));
  ::close(terminal);
  return text;
}

// Nothing is sent to a program that has ended.
void interrupt_when(const std::function<bool()>& is_time, pid_t child, int signal) {
  siginfo_t ended{};
  while (!is_time()) {
    ended.si_pid = 0;
    if (::waitid(P_PID, static_cast<id_t>(child), &ended, WEXITED | WNOHANG | WNOWAIT) != 0 ||
        ended.si_pid != 0)
      return;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  ::kill(child, signal);
}

}  // namespace

ProgramResult run_program(const std::vector<std::string>& arguments, const ProgramLimits& limits) {
  const TemporaryFolder folder;
  const fs::path output_file = limits.output.empty() ? fs::path(folder / "out") : limits.output;
  const int output = ::open(output_file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  const Terminal terminal = limits.errors_on_terminal ? new_terminal() : Terminal{};
  const int errors = limits.errors_on_terminal
                         ? terminal.theirs
                         : ::open((folder / "err").c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  const pid_t child = ::fork();
  if (child == 0)
    become_program(arguments, limits, limits.data_home.empty() ? folder / "data" : limits.data_home, output,
                   errors);
  ::close(errors);  // ours: the terminal has ended when the program has
  ProgramResult result;
  if (limits.errors_on_terminal) result.errors = all_of(terminal.ours);
  int status = 0;
  if (limits.interrupts_when) interrupt_when(limits.interrupts_when, child, limits.interrupted_by);
  ::waitpid(child, &status, 0);
  ::close(output);
  result.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  if (limits.output.empty()) result.output = contents_of(output_file);
  if (!limits.errors_on_terminal) result.errors = contents_of(folder / "err");
  return result;
}

void write_file(const std::filesystem::path& file, const std::string& contents) {
  std::ofstream(file, std::ios::binary) << contents;
}

}  // namespace arthronaut::test
