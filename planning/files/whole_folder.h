// Folders that appear whole or not at all.
#pragma once

#include <filesystem>
#include <functional>
#include <vector>

namespace arthronaut::files {

// Makes a folder of a name of its own beside `folder`, its owner's alone (0700), lets `fill` write into it,
// and renames it to `folder`, which must be absent or empty. When anything throws, nothing is left, and what
// was thrown passes; an IoError then names the folder that was asked for. Throws IoError when it cannot be
// made or renamed.
void make_whole_folder(const std::filesystem::path& folder,
                       const std::function<void(const std::filesystem::path& unfinished)>& fill);

// Into a folder that may be there and hold other files: lets `fill` write into a hidden one within it, then
// moves each file over that of the same name, and last removes those named in `gone` that `fill` did not
// make. `folder` stays the folder that it was, with all else that is in it. Where it was absent it appears
// with all of it in one step, as open as any new folder. When `fill` throws, `folder` is as it was, and
// absent where it was absent. Throws what make_whole_folder() throws; IoError where `folder` is a file,
// before anything is made.
void fill_folder(const std::filesystem::path& folder,
                 const std::function<void(const std::filesystem::path& unfinished)>& fill,
                 const std::vector<std::filesystem::path>& gone = {});

// Before work whose result goes there: throws IoError, which names the folder, where nothing can be made in
// `folder`, or, while it is not there, in the nearest one above it that is; or where the disk does not even
// take 64 KB more. A file that is to be written there is named in its place. Leaves nothing.
void refuse_unwritable(const std::filesystem::path& folder, const std::filesystem::path& file = {});

// The same of a folder that a command makes: throws InvalidInput unless it is absent or empty.
void refuse_taken(const std::filesystem::path& folder);

}  // namespace arthronaut::files
