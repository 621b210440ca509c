// A disk that takes no more, for as long as it lives: by the limit on the size of files, which ends a write
// as a full disk does. Of the whole process.
#pragma once

#include <sys/resource.h>

#include <csignal>

namespace arthronaut::test {

class FullDisk {
 public:
  FullDisk() {
    ::signal(SIGXFSZ, SIG_IGN);  // the write fails instead
    ::getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit full{1000, before_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &full);
  }
  ~FullDisk() { ::setrlimit(RLIMIT_FSIZE, &before_); }
  FullDisk(const FullDisk&) = delete;
  FullDisk& operator=(const FullDisk&) = delete;

 private:
  rlimit before_{};
};

}  // namespace arthronaut::test
