// Which folders of this workstation hold cases: case_folders.json in the user's data (format
// "arthronaut.case_folders"). The index is made from it again when it is lost.
//
// Writers take turns by a lock on library.lock beside it, which goes with its process.
#pragma once

#include <filesystem>
#include <span>
#include <vector>

namespace arthronaut::library {

[[nodiscard]] std::filesystem::path known_folders_file(const std::filesystem::path& data_folder);
// In the order in which they were added. None where there is no file. Throws IoError or InvalidInput (file,
// place, reason).
[[nodiscard]] std::vector<std::filesystem::path> load_known_folders(const std::filesystem::path& data_folder);

// Holds library.lock while it lives; waits for whoever has it. Where the file system knows no locks it is
// nothing.
class LibraryTurn {
 public:
  explicit LibraryTurn(const std::filesystem::path& data_folder);
  ~LibraryTurn();
  LibraryTurn(const LibraryTurn&) = delete;
  LibraryTurn& operator=(const LibraryTurn&) = delete;

 private:
  int descriptor_;
};

// Those that are not in it yet are added; those to be forgotten go. Atomic. Throws IoError; InvalidInput when
// the file is broken: it is then left as it is.
void change_known_folders(const std::filesystem::path& data_folder,
                          std::span<const std::filesystem::path> added,
                          std::span<const std::filesystem::path> forgotten, const LibraryTurn& turn);

}  // namespace arthronaut::library
