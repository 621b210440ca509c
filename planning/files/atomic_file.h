// Files that are there whole or not at all.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

namespace arthronaut::files {

// Writes beside the target, fsyncs, renames over it and fsyncs the folder: after a crash at any moment the
// target holds its old contents or the new. "-" writes to standard output. Throws IoError with the system's
// reason; the target is then as before and nothing is left beside it. A device or a pipe is written to.
//
// A file is no more open than its folder: in one that is private (private_folder.h) it is 0600, elsewhere as
// the umask has it. What the target's rights were before does not count.
void write_atomically(const std::filesystem::path& target, std::string_view contents);

// The same for a writer that needs a path of its own (a video, a PDF): `write` gets a temporary path in the
// target's folder that carries the target's extension; when it throws, the temporary file is removed and the
// exception passes.
void write_atomically(const std::filesystem::path& target,
                      const std::function<void(const std::filesystem::path& temporary)>& write);

// The whole file. Throws IoError.
[[nodiscard]] std::string read_text(const std::filesystem::path& file);

}  // namespace arthronaut::files
