// Records a stream until it is killed, and tells on standard output of every picture (test::GivenPicture).
//   recording_program FOLDER ADDRESS LARGEST_FILE_BYTES
#include <signal.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cstdlib>

#include "tests/navigation/recording/given_picture.h"
#include "tests/navigation/recording/streams.h"

int main(int count, char** arguments) {
  using namespace arthronaut;
  if (count != 4) return 2;
  try {
    const auto source = test::open_when_there(arguments[2]);
    ::signal(SIGXFSZ, SIG_IGN);
    const auto largest_file = static_cast<rlim_t>(std::strtoull(arguments[3], nullptr, 10));
    const rlimit limit{largest_file, largest_file};
    ::setrlimit(RLIMIT_FSIZE, &limit);
    const recording::DiskLimits nobody_watches{
        .free_bytes = [](const std::filesystem::path&) { return std::uintmax_t{100} << 30; }};
    recording::SessionRecorder recorder(arguments[1], test::session_header(), test::scripted_options(),
                                        nobody_watches);
    test::record(*source, recorder, [&](const test::GivenPicture& picture) {
      // A video that the disk does not take ends alone, and is told: of pictures that come later nothing is
      // promised.
      const bool is_told =
          ::write(STDOUT_FILENO, &picture, sizeof picture) == static_cast<ssize_t>(sizeof picture);
      return !is_told || !recorder.video_trouble().empty();
    });
  } catch (const std::exception&) {
    // What is there is looked at.
  }
  std::_Exit(0);
}
