// library-4.sqlite in the user's data: the records of all known cases, so that a list of a thousand needs no
// thousand folders read. A cache: nothing in it is anywhere's only copy. Inner header of library.
//
// The number in the name is that of its layout; another version of the program has an index of its own.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <unordered_set>
#include <vector>

#include "planning/library/case_record.h"

namespace arthronaut::library {

struct IndexedCase {
  std::int64_t fingerprint = 0;  // of the folder when the record was read; 0: not read yet
  CaseRecord record;             // before it was read: the folder alone
};

// What is wrong with the file itself, as against a disk that is full: it must be made anew.
class IndexIsDamaged : public std::exception {
 public:
  explicit IndexIsDamaged(std::string reason) : reason_(std::move(reason)) {}
  [[nodiscard]] const char* what() const noexcept override { return reason_.c_str(); }

 private:
  std::string reason_;
};

[[nodiscard]] std::filesystem::path index_file(const std::filesystem::path& data_folder);

// One thread at a time; several programs may have it open, and wait for each other's changes (10 s).
class LibraryIndex {
 public:
  // Makes the file where there is none, 0600. Every member throws IoError with SQLite's reason, or
  // IndexIsDamaged.
  explicit LibraryIndex(const std::filesystem::path& file);
  ~LibraryIndex();
  LibraryIndex(const LibraryIndex&) = delete;
  LibraryIndex& operator=(const LibraryIndex&) = delete;

  // Both in no order.
  [[nodiscard]] std::unordered_set<std::string> folders() const;
  [[nodiscard]] std::vector<IndexedCase> cases() const;
  // All or nothing. Replaces what is known of the same folder.
  void put(std::span<const IndexedCase> cases);
  void add(std::span<const std::filesystem::path> folders);     // those it knows stay as they are
  void forget(std::span<const std::filesystem::path> folders);  // those that it does not know are nothing

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace arthronaut::library
