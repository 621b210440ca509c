#include "app/command_line/named_session.h"

#include "planning/cases/case.h"
#include "planning/geometry/error.h"

namespace arthronaut::command_line {

std::vector<std::filesystem::path> sessions_named(const std::filesystem::path& case_folder,
                                                  const std::string& name) {
  std::error_code ignored;
  if (!std::filesystem::is_directory(case_folder, ignored))
    throw InvalidInput(case_folder, "", "is not a case folder");
  std::vector<std::filesystem::path> folders = cases::session_folders(case_folder);
  if (folders.empty()) throw InvalidInput(case_folder, "", "the case has no session");
  if (name.empty()) return folders;
  for (const std::filesystem::path& folder : folders)
    if (folder.filename() == name) return {folder};
  throw InvalidInput(case_folder, "", "the case has no session \"" + name + "\"");
}

}  // namespace arthronaut::command_line
