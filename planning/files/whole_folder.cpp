#include "planning/files/whole_folder.h"

#include <fcntl.h>
#include <stdlib.h>
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

// mkdtemp makes them their owner's alone; nobody can ask for the umask without setting it.
void as_open_as_any_new_one(const fs::path& folder) {
  std::error_code ignored;
  fs::create_directory(folder / "new", ignored);
  fs::permissions(folder, fs::status(folder / "new", ignored).permissions(), ignored);
  fs::remove(folder / "new", ignored);
}

// The system's number of why a file of as many bytes as a case's own files have cannot be written; 0: it can.
// A full disk still makes empty folders and files.
int why_no_bytes_fit(const fs::path& file) {
  const int descriptor = ::open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
  if (descriptor < 0) return errno;
  const std::string bytes(65536, ' ');
  std::size_t written = 0;
  int reason = 0;
  while (reason == 0 && written < bytes.size()) {
    const ssize_t now = ::write(descriptor, bytes.data() + written, bytes.size() - written);
    if (now > 0)
      written += static_cast<std::size_t>(now);
    else if (now == 0 || errno != EINTR)
      reason = now == 0 ? ENOSPC : errno;
  }
  // Over a network it is told only here.
  if (::close(descriptor) != 0 && reason == 0) reason = errno;
  return reason;
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
  const fs::path named = folder.has_filename() ? folder : folder.parent_path();
  if (!fs::exists(named, ignored)) {
    return make_whole_folder(named, [&](const fs::path& unfinished) {
      as_open_as_any_new_one(unfinished);
      fill(unfinished);
    });
  }
  if (!fs::is_directory(named, ignored)) throw IoError(folder, "cannot be written: is a file, not a folder");
  // Within the folder itself: beside it may be another disk. The folder is the user's, who may lay something
  // there at any moment: it is never exchanged, moved or deleted as a whole.
  std::string unfinished = (named / ".unfinished-XXXXXX").string();
  if (!::mkdtemp(unfinished.data()))
    throw IoError(folder, std::string("cannot be written: ") + std::strerror(errno));
  or_leave_nothing(named, unfinished, [&] {
    // Files are no more open than their folder, and no less.
    fs::permissions(unfinished, fs::status(named).permissions(), ignored);
    fill(unfinished);
    std::vector<fs::path> made;
    for (const auto& entry : fs::directory_iterator(unfinished)) made.push_back(entry.path().filename());
    for (const fs::path& name : made) {
      fs::rename(unfinished / name, named / name, error);
      if (error) throw IoError(named / name, "cannot be replaced: " + error.message());
    }
    // Last: where a file cannot be replaced nothing is lost.
    for (const fs::path& name : gone)
      if (std::ranges::find(made, name) == made.end()) remove_file(named / name);
  });
  fs::remove(unfinished, ignored);  // empty by now
}

void refuse_unwritable(const fs::path& folder, const fs::path& file) {
  std::error_code error;
  fs::path there = fs::absolute(folder);
  while (!fs::exists(there, error) && there.has_relative_path()) there = there.parent_path();
  // Rights alone do not tell: of a medium that is read-only, or a file system that makes no folders.
  std::string probe = (there / ".arthronaut-XXXXXX").string();
  const auto refuse = [&](int reason) {
    throw IoError(file.empty() ? folder : file, std::string("cannot be written: ") + std::strerror(reason));
  };
  if (!::mkdtemp(probe.data())) refuse(errno);
  const int reason = why_no_bytes_fit(fs::path(probe) / "probe");
  fs::remove_all(probe, error);
  if (reason != 0) refuse(reason);
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
