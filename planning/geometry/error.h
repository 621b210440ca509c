// The whole list of exceptions that Arthronaut throws on purpose. Each message is one line whatever it
// quotes: a control character in a file's own words or name is written as in C (a line feed as \n, an escape
// as \x1b).
//
// They are caught in four places alone: command dispatch, the top of a worker thread, the frame guard of the
// window, and main(). The outcome of a computation is never an exception: it is a summary (see
// navigation/registration/registration.h for the pattern).
#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>

namespace arthronaut {

// A file or an argument breaks its contract. The message names the file, the place and the reason:
// "camera.json: focal_px: is missing". The command line ends with exit code 3.
class InvalidInput : public std::runtime_error {
 public:
  explicit InvalidInput(const std::string& message);
  InvalidInput(const std::filesystem::path& file, const std::string& place, const std::string& reason);
};

// The operating system refused: no such file, disk full, read-only folder. Exit code 3 too.
class IoError : public std::runtime_error {
 public:
  explicit IoError(const std::string& message);
  IoError(const std::filesystem::path& file, const std::string& reason);
};

// A camera, display or GPU failed or is absent.
class DeviceError : public std::runtime_error {
 public:
  explicit DeviceError(const std::string& message);
};

}  // namespace arthronaut
