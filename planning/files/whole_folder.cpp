#include "planning/files/whole_folder.h"

#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <string>
#include <system_error>

#include "planning/files/remove_file.h"
#include "planning/geometry/error.h"

namespace arthronaut::files {

namespace fs = std::filesystem;

namespace {

// Lets `work` go on; when it throws, `unfinished` is gone, and the disk's words are of `named`, the folder
// that was asked for, not of the name it had meanwhile.
void or_leave_nothing(const fs::path& named, const std::string& unfinished,
                      const std::function<void()>& work) {
  std::error_code ignored;
  try {
    work();
  } catch (const IoError& failure) {
    fs::remove_all(unfinished, ignored);
    std::string reason = failure.what();
    if (const auto at = reason.find(unfinished); at != std::string::npos)
      reason.replace(at, unfinished.size(), named.string());
    throw IoError(reason);
  } catch (...) {
    fs::remove_all(unfinished, ignored);
    throw;
  }
}

// A new folder to write in, on the disk of `folder`: beside it, where it can be exchanged with it, else
// within it. Empty, with errno, where there can be none.
std::string beside(const fs::path& folder) {
  std::string made = (folder.parent_path() / ("." + folder.filename().string() + "-XXXXXX")).string();
  struct stat here {
  }, there{};
  if (::mkdtemp(made.data()) != nullptr) {
    if (::stat(folder.c_str(), &here) == 0 && ::stat(made.c_str(), &there) == 0 &&
        here.st_dev == there.st_dev)
      return made;
    ::rmdir(made.c_str());
  }
  made = (folder / ".unfinished-XXXXXX").string();
  return ::mkdtemp(made.data()) != nullptr ? made : "";
}

bool holds_nothing_else(const fs::path& folder, const fs::path& unfinished,
                        const std::vector<fs::path>& gone) {
  for (const auto& entry : fs::directory_iterator(folder)) {
    const fs::path name = entry.path().filename();
    if (!fs::exists(unfinished / name) && std::ranges::find(gone, name) == gone.end()) return false;
  }
  return true;
}

// mkdtemp makes them their owner's alone; nobody can ask for the umask without setting it.
void as_open_as_any_new_one(const fs::path& folder) {
  std::error_code ignored;
  fs::create_directory(folder / "new", ignored);
  fs::permissions(folder, fs::status(folder / "new", ignored).permissions(), ignored);
  fs::remove(folder / "new", ignored);
}

// In one step, so that nobody ever sees half of each. False where the file system cannot.
bool exchange(const fs::path& folder, const fs::path& unfinished) {
  return ::renameat2(AT_FDCWD, folder.c_str(), AT_FDCWD, unfinished.c_str(), RENAME_EXCHANGE) == 0;
}

}  // namespace

void make_whole_folder(const fs::path& folder, const std::function<void(const fs::path& unfinished)>& fill) {
  const fs::path named = folder.has_filename() ? folder : folder.parent_path();
  const fs::path parent = named.has_parent_path() ? named.parent_path() : ".";
  std::error_code error;
  fs::create_directories(parent, error);
  std::string unfinished = (parent / ("." + named.filename().string() + "-XXXXXX")).string();
  if (error || !::mkdtemp(unfinished.data()))
    throw IoError(folder,
                  std::string("cannot be created: ") + (error ? error.message() : std::strerror(errno)));
  or_leave_nothing(named, unfinished, [&] {
    fill(unfinished);
    fs::rename(unfinished, named, error);
    if (error) throw IoError(folder, "cannot be created: " + error.message());
  });
}

void fill_folder(const fs::path& folder, const std::function<void(const fs::path& unfinished)>& fill,
                 const std::vector<fs::path>& gone) {
  std::error_code error, ignored;
  const fs::path asked = folder.has_filename() ? folder : folder.parent_path();
  if (!fs::exists(asked, ignored)) {
    return make_whole_folder(asked, [&](const fs::path& unfinished) {
      as_open_as_any_new_one(unfinished);
      fill(unfinished);
    });
  }
  const fs::path named = fs::canonical(asked, error);  // what a link leads to is what is exchanged
  std::string unfinished = beside(named);
  if (error || !fs::is_directory(named, ignored) || unfinished.empty())
    throw IoError(folder,
                  std::string("cannot be written: ") + (error ? error.message() : std::strerror(errno)));
  or_leave_nothing(named, unfinished, [&] {
    // Files are no more open than their folder, and no less.
    fs::permissions(unfinished, fs::status(named).permissions(), ignored);
    fill(unfinished);
    if (holds_nothing_else(named, unfinished, gone) && exchange(named, unfinished)) return;
    for (const fs::path& name : gone)
      if (!fs::exists(unfinished / name)) remove_file(named / name);
    for (const auto& entry : fs::directory_iterator(unfinished)) {
      fs::rename(entry.path(), named / entry.path().filename(), error);
      if (error) throw IoError(named / entry.path().filename(), "cannot be replaced: " + error.message());
    }
  });
  fs::remove_all(unfinished, ignored);  // what was there before, or nothing
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
