// Folders that their owner alone may look into: what lies in a case is a patient's.
//
// Folders are 0700, files 0600. A file that is written into such a folder is private from the start
// (atomic_file.h), and so is what a library writes there after begin_private_file(); make_private() mends the
// rights of what others left.
#pragma once

#include <filesystem>

namespace arthronaut::files {

// Makes the folder as 0700, and what is missing above it as the user's habits (umask) have it. One that is
// there already becomes 0700 where it is the user's own. Throws IoError.
void create_private_folder(const std::filesystem::path& folder);

// For what a library is to write there by itself: an empty file, 0600 where its folder is private. Nothing
// happens to one that exists; where none can be made, whoever opens it says why.
void begin_private_file(const std::filesystem::path& file) noexcept;

// Nobody but its owner has any right in it; false for what does not exist.
[[nodiscard]] bool is_private(const std::filesystem::path& folder);

// Takes all rights of group and others from the folder and from everything in it. Gives nobody a right. Left
// alone: what belongs to another user, what links point to, and file systems that know no rights. Never
// throws.
void make_private(const std::filesystem::path& folder) noexcept;

}  // namespace arthronaut::files
