// Sends a file as it is by RTSP over the loopback, from a process of its own, whose time is not ours.
#pragma once

#include <sys/types.h>

#include <string>

namespace arthronaut {

class FileSender {
 public:
  // file: H.264 in Matroska. From its beginning for everyone who connects. Start it before any thread.
  FileSender(const std::string& file, int port);
  ~FileSender();
  FileSender(const FileSender&) = delete;
  FileSender& operator=(const FileSender&) = delete;
  [[nodiscard]] std::string address() const;

 private:
  int port_;
  pid_t process_ = -1;
};

}  // namespace arthronaut
