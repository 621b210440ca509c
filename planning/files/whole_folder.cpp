#include "planning/files/whole_folder.h"

#include <stdlib.h>

#include <cerrno>
#include <cstring>
#include <string>
#include <system_error>

#include "planning/geometry/error.h"

namespace arthronaut::files {

namespace fs = std::filesystem;

void make_whole_folder(const fs::path& folder, const std::function<void(const fs::path& unfinished)>& fill) {
  const fs::path named = folder.has_filename() ? folder : folder.parent_path();
  const fs::path parent = named.has_parent_path() ? named.parent_path() : ".";
  std::error_code error;
  fs::create_directories(parent, error);
  std::string unfinished = (parent / ("." + named.filename().string() + "-XXXXXX")).string();
  if (error || !::mkdtemp(unfinished.data()))
    throw IoError(folder,
                  std::string("cannot be created: ") + (error ? error.message() : std::strerror(errno)));
  std::error_code ignored;
  try {
    fill(unfinished);
    fs::rename(unfinished, named, error);
    if (error) throw IoError(folder, "cannot be created: " + error.message());
  } catch (const IoError& failure) {
    fs::remove_all(unfinished, ignored);
    // Of the folder that was asked for, not of the name it had meanwhile.
    std::string reason = failure.what();
    if (const auto at = reason.find(unfinished); at != std::string::npos)
      reason.replace(at, unfinished.size(), named.string());
    throw IoError(reason);
  } catch (...) {
    fs::remove_all(unfinished, ignored);
    throw;
  }
}

void refuse_unwritable(const fs::path& folder, const fs::path& file) {
  std::error_code error;
  fs::path there = fs::absolute(folder);
  while (!fs::exists(there, error) && there.has_relative_path()) there = there.parent_path();
  // Rights alone do not tell: of a medium that is read-only, or a file system that makes no folders.
  std::string probe = (there / ".arthronaut-XXXXXX").string();
  if (!::mkdtemp(probe.data()))
    throw IoError(file.empty() ? folder : file, std::string("cannot be written: ") + std::strerror(errno));
  fs::remove(probe, error);
}

void refuse_taken(const fs::path& folder) {
  std::error_code error;
  if (!fs::exists(folder, error)) return;
  if (!fs::is_directory(folder, error))
    throw InvalidInput(folder, "", "is a file, not a folder: nothing was written");
  if (!fs::is_empty(folder, error) || error)
    throw InvalidInput(folder, "", "exists and is not empty: nothing was written");
}

}  // namespace arthronaut::files
