// What a folder holds, for one who looks for a case or for images.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace arthronaut::folders {

struct FolderEntry {
  enum class Kind {
    Case,     // a folder with case.json
    Folder,   // any other
    Image,    // a file that may be a volume, by its extension; DICOM files often have none and are taken with
              // their folder
    Mesh,     // by its extension
    Markups,  // 3D Slicer's, .mrk.json
  } kind = Kind::Folder;
  std::filesystem::path path;
  std::string name;
  std::string detail;  // size of a file
};

struct FolderListing {
  std::filesystem::path folder;      // absolute
  std::vector<FolderEntry> entries;  // cases, then folders, then files, each by name
  std::size_t other_files = 0;       // that are none of these; a folder full of slices has many
  std::string failure;               // why it cannot be listed; empty when it can
};

// Hidden names are left out. Never throws.
[[nodiscard]] FolderListing list_folder(const std::filesystem::path& folder);

[[nodiscard]] bool is_markups_name(const std::filesystem::path& file);
// By extension: a volume, or a DICOM file or directory.
[[nodiscard]] bool is_image_name(const std::filesystem::path& file);

}  // namespace arthronaut::folders
