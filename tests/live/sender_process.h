// The sender of the marker scene as a process that can be told, stopped and killed.
#pragma once

#include <sys/types.h>

#include <cstdio>
#include <string>

namespace arthronaut::test {

class SenderProcess {
 public:
  // Returns when it can be connected to.
  SenderProcess(int port, const std::string& codec);
  ~SenderProcess();  // kills it
  SenderProcess(const SenderProcess&) = delete;
  SenderProcess& operator=(const SenderProcess&) = delete;

  void say(const std::string& word);  // see stream_sender.cpp
  void stop();                        // it hangs
  void go_on();

 private:
  pid_t process_ = -1;
  int to_ = -1, from_ = -1;
};

}  // namespace arthronaut::test
