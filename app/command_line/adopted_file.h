// A file that is given to a command and becomes the case's own when that is done.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "app/command_line/command.h"

namespace arthronaut::command_line {

class AdoptedFile {
 public:
  // As it is now, whatever becomes of it while the command runs. Nothing is adopted where none is given
  // (empty), or the case's own. Throws IoError.
  AdoptedFile(std::string given, std::filesystem::path of_case);
  // Atomically; that another one is replaced is said. Throws IoError, the case's is then as before.
  void write(const Context& context) const;

 private:
  std::string given_;
  std::filesystem::path of_case_;
  std::optional<std::string> text_;
};

}  // namespace arthronaut::command_line
