#include "app/folders/folder_listing.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>

#include "planning/bones/mesh_file.h"
#include "planning/files/format.h"
#include "planning/library/folder_search.h"

namespace arthronaut::folders {

namespace {

namespace fs = std::filesystem;

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

template <std::size_t N>
bool ends_with_one(const fs::path& file, const std::array<std::string_view, N>& endings) {
  const std::string name = lower(file.filename().string());
  return std::any_of(endings.begin(), endings.end(),
                     [&](std::string_view ending) { return name.ends_with(ending); });
}

std::string size_text(std::uintmax_t bytes) {
  if (bytes < 1'000'000) return files::format("%.0f kB", static_cast<double>(bytes) / 1e3);
  return files::format("%.1f MB", static_cast<double>(bytes) / 1e6);
}

}  // namespace

bool is_markups_name(const fs::path& file) { return lower(file.filename().string()).ends_with(".mrk.json"); }

bool is_image_name(const fs::path& file) {
  if (lower(file.filename().string()) == "dicomdir") return true;
  return ends_with_one(file, std::array<std::string_view, 9>{".nii", ".nii.gz", ".nrrd", ".nhdr", ".mha",
                                                             ".mhd", ".dcm", ".ima", ".dicom"});
}

FolderListing list_folder(const fs::path& folder) {
  FolderListing listing;
  std::error_code error;
  listing.folder = fs::absolute(folder, error).lexically_normal();
  if (!listing.folder.has_filename()) listing.folder = listing.folder.parent_path();
  if (listing.folder.empty()) listing.folder = "/";
  fs::directory_iterator it(listing.folder, fs::directory_options::skip_permission_denied, error);
  if (error) {
    listing.failure = error.message();
    return listing;
  }
  for (const fs::directory_iterator end; it != end; it.increment(error)) {
    if (error) break;
    const std::string name = it->path().filename().string();
    if (name.empty() || name.front() == '.') continue;
    std::error_code none;
    FolderEntry entry{FolderEntry::Kind::Folder, it->path(), name, ""};
    if (it->is_directory(none)) {
      if (library::is_case_folder(it->path())) entry.kind = FolderEntry::Kind::Case;
    } else if (bones::is_mesh_file(name) || is_image_name(name) || is_markups_name(name)) {
      entry.kind = bones::is_mesh_file(name) ? FolderEntry::Kind::Mesh
                   : is_image_name(name)     ? FolderEntry::Kind::Image
                                             : FolderEntry::Kind::Markups;
      entry.detail = size_text(it->file_size(none));
    } else {
      ++listing.other_files;
      continue;
    }
    listing.entries.push_back(std::move(entry));
  }
  const auto rank = [](const FolderEntry& e) {
    return e.kind == FolderEntry::Kind::Case ? 0 : e.kind == FolderEntry::Kind::Folder ? 1 : 2;
  };
  std::sort(listing.entries.begin(), listing.entries.end(), [&](const FolderEntry& a, const FolderEntry& b) {
    if (rank(a) != rank(b)) return rank(a) < rank(b);
    const std::string x = lower(a.name), y = lower(b.name);
    return x != y ? x < y : a.name < b.name;
  });
  return listing;
}

}  // namespace arthronaut::folders
