// Programs that tests start, and kill.
#pragma once

#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace arthronaut::test {

class ChildProcess {
 public:
  explicit ChildProcess(pid_t process) : process_(process) {}
  ~ChildProcess() {
    ::kill(process_, SIGKILL);
    ::waitpid(process_, nullptr, 0);
  }
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

 private:
  pid_t process_;
};

// The words begin with the program. Its standard output and input are ours, or those given.
inline pid_t run_program(std::vector<std::string> words, int output = STDOUT_FILENO,
                         int input = STDIN_FILENO) {
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  const pid_t process = ::fork();
  if (process != 0) return process;
  ::dup2(output, STDOUT_FILENO);
  ::dup2(input, STDIN_FILENO);
  ::execvp(arguments[0], arguments.data());
  ::_exit(127);
}

#ifdef ARTHRONAUT_RTSP_SENDER
// rtsp://127.0.0.1:PORT/scope; see rtsp_sender.cpp. Returns when it can be connected to.
inline std::unique_ptr<ChildProcess> send_by_rtsp(const std::string& port, const std::string& launch,
                                                  int input = STDIN_FILENO) {
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0) throw std::runtime_error("no pipe");
  auto sender =
      std::make_unique<ChildProcess>(run_program({ARTHRONAUT_RTSP_SENDER, port, launch}, ends[1], input));
  ::close(ends[1]);
  char said = 0;
  const bool listens = ::read(ends[0], &said, 1) == 1;
  ::close(ends[0]);
  if (!listens) throw std::runtime_error("no sender at port " + port);
  return sender;
}
inline std::string rtsp_address(const std::string& port) { return "rtsp://127.0.0.1:" + port + "/scope"; }
// H.264 in Matroska, as it is.
inline std::string h264_clip_launch(const std::filesystem::path& clip) {
  return "( filesrc location=" + clip.string() +
         " ! matroskademux ! h264parse config-interval=-1 ! rtph264pay name=pay0 )";
}
#endif

}  // namespace arthronaut::test
