#include "tests/live/sender_process.h"

#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <stdexcept>

namespace arthronaut::test {

SenderProcess::SenderProcess(int port, const std::string& codec) {
  int to[2], from[2];
  if (::pipe2(to, 0) != 0 || ::pipe2(from, 0) != 0) throw std::runtime_error("no pipe");
  const std::string at_port = std::to_string(port);
  process_ = ::fork();
  if (process_ == 0) {
    ::dup2(to[0], STDIN_FILENO);
    ::dup2(from[1], STDOUT_FILENO);
    for (const int end : {to[0], to[1], from[0], from[1]}) ::close(end);
    ::execl(ARTHRONAUT_STREAM_SENDER, "stream_sender", at_port.c_str(), codec.c_str(),
            static_cast<char*>(nullptr));
    ::_exit(127);
  }
  ::close(to[0]);
  ::close(from[1]);
  to_ = to[1];
  from_ = from[0];
  char listening[16];
  if (::read(from_, listening, sizeof listening) <= 0) throw std::runtime_error("the sender does not start");
}

SenderProcess::~SenderProcess() {
  ::kill(process_, SIGKILL);
  ::waitpid(process_, nullptr, 0);
  ::close(to_);
  ::close(from_);
}

void SenderProcess::say(const std::string& word) {
  const std::string line = word + "\n";
  if (::write(to_, line.data(), line.size()) < 0) throw std::runtime_error("the sender is gone");
}

void SenderProcess::stop() { ::kill(process_, SIGSTOP); }
void SenderProcess::go_on() { ::kill(process_, SIGCONT); }

}  // namespace arthronaut::test
