// The library: all cases that this workstation knows, with what is to be said of each.
//
//   library-4.sqlite    what is known of them (library_index.h): a cache, made anew when damaged or gone
//   case_folders.json   which folders they are (known_folders.h)
//   cases/              where imported cases go: whatever lies there is known without being added
//
// All three in the user's data folder, which is his alone (0700, files 0600). The facts themselves, and notes
// and thumbnails, are in the folders of the cases. A case whose folder is gone stays in the list as missing
// until somebody forgets it.
//
// One thread at a time; any number of programs.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "planning/library/case_record.h"

namespace arthronaut::library {

class Library {
 public:
  // Makes what is missing. An index that is damaged is put aside as library-4.sqlite.damaged and made anew
  // from the folders: see notices(). Throws IoError when the folder cannot be written; InvalidInput when
  // case_folders.json is broken.
  Library(std::filesystem::path data_folder, SessionReader read_session);
  ~Library();
  Library(const Library&) = delete;
  Library& operator=(const Library&) = delete;

  // What the user should know: that the index had to be made anew, and why. Empty else.
  [[nodiscard]] const std::vector<std::string>& notices() const;

  // As they were when they were looked at last, in no order; those that have not been read yet are left out.
  // Reads the index alone.
  [[nodiscard]] std::vector<CaseRecord> known() const;
  // The same with a look at every folder: what has changed is read again, what is gone is missing. on_case is
  // called before each case that is read, with how many have been looked at of how many; false stops, and
  // what was read until then is kept.
  std::vector<CaseRecord> look(const std::function<bool(std::size_t done, std::size_t all)>& on_case = {});

  // Cases to know from now on, absolute or relative to here. How many of them were new. Throws InvalidInput
  // for a folder that is no case: none is added then.
  std::size_t add(std::span<const std::filesystem::path> case_folders);
  // The same for folders that other lists name (recent cases): what is no case now is passed over.
  void add_those_there(std::span<const std::filesystem::path> case_folders);
  // The case is no more in the list; its folder stays as it is. Throws InvalidInput when it is not known.
  // One in cases/ comes again while its folder lies there.
  void forget(const std::filesystem::path& case_folder);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace arthronaut::library
