// A program that does something else than to import, for those who start one.
#pragma once

#include <filesystem>
#include <string>

#include "tests/planning/bones/mesh_text_forms.h"

namespace arthronaut::test {

// Its standard input is the socket: what it writes to ">&0" is its answer.
inline std::filesystem::path child_script(const std::filesystem::path& folder, const std::string& line) {
  write_bytes(folder / "child.sh", "#!/bin/sh\n" + line + "\n");
  std::filesystem::permissions(folder / "child.sh", std::filesystem::perms{0755});
  return folder / "child.sh";
}

}  // namespace arthronaut::test
