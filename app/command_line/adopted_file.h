// A file that is given to a command and becomes the case's own when that is done.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "app/command_line/command.h"
#include "navigation/tools/tool_set.h"

namespace arthronaut::command_line {

class AdoptedFile {
 public:
  // As it is now, whatever becomes of it while the command runs. Nothing is adopted where none is given
  // (empty), or the case's own. Throws IoError.
  AdoptedFile(std::string given, std::filesystem::path of_case);
  // Atomically; that another one is replaced is said. Where there is a reason to keep the case's (not empty)
  // it stays, and that is said. Throws IoError, the case's is then as before.
  void write(const Context& context, const std::string& kept_because) const;

 private:
  std::string given_;
  std::filesystem::path of_case_;
  std::optional<std::string> text_;
};

// What was given to a run on a case becomes the case's, but for what is simulated: as in the window, it takes
// the place of nothing that is real.
struct GivenFile {
  const AdoptedFile& file;
  bool is_simulated = false;
};
[[nodiscard]] bool has_simulated(const tools::ToolSet& tools);
void adopt(const Context& context, const GivenFile& camera, const GivenFile& tools,
           const std::filesystem::path& case_folder);

}  // namespace arthronaut::command_line
