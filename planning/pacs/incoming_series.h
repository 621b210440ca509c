// The images of one series while they come, and the folder that they end in. Inner header of pacs.
//
// They gather in a hidden folder beside the one that was asked for ("scan" -> ".scan-0f3a….incoming", its
// owner's alone), each under a temporary name until it is whole. What is whole there outlives a broken
// connection, a crash and a power cut, and is not fetched again. The folder that was asked for appears when
// all is there, by one renaming. Where it was there already, with images of this series, what was missing is
// moved into it.
//
// keep() and the questions may be asked by several threads; the rest by one.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "planning/files/free_space.h"

namespace arthronaut::pacs {

class IncomingSeries {
 public:
  // What is asked for; empty: not known, anything will do.
  struct Expected {
    std::string study_uid, patient_id;                     // UTF-8
    std::map<std::string, std::string> class_by_uid = {};  // by SOP instance
  };
  struct Limits {
    std::int64_t most_bytes;        // of the series, this time
    std::int64_t least_free_bytes;  // that are left on the disk
    std::function<std::uintmax_t(const std::filesystem::path&)> free_bytes = files::free_bytes_at;
  };
  // What the next image may take; `complaint`: what is said of one that takes more.
  struct Room {
    std::int64_t bytes;
    bool is_of_disk;
    std::string complaint;
  };

  // Reads what is whole already, in both folders, to its last byte; removes what is not. Throws InvalidInput
  // when the folder holds something that is not of this series; IoError when one cannot be read or made.
  // Also when the waiting room is a link or somebody else's, which nothing is read from or written to.
  IncomingSeries(std::filesystem::path folder, std::string series_uid, const Limits& limits);

  // Before anything is received. What waits already and is of another patient or study is fetched anew.
  void expect(const Expected& expected);

  // False for an image that was not asked for, and for one that was sent again and again.
  [[nodiscard]] bool admits(const std::string& sop_uid);
  // Throws IoError when there is none.
  [[nodiscard]] Room room() const;
  // What was refused of what the peer sent, and why ("image UID is of another patient"); empty: nothing.
  [[nodiscard]] std::string refusal() const;
  // So much was refused that the peer is not listened to any longer.
  [[nodiscard]] bool is_fed_up() const;

  [[nodiscard]] bool has(const std::string& sop_uid) const;
  [[nodiscard]] int count() const;
  [[nodiscard]] std::int64_t received_bytes() const;
  [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }  // that was asked for

  // Where the next image may be written; gone when the process ends without keep().
  [[nodiscard]] std::filesystem::path begin(const std::string& sop_uid);
  // Throws IoError: folder, the system's reason, and how much room there is.
  [[noreturn]] void fail_to_write(int error_number) const;
  // The temporary file is whole: it becomes the image of that UID. False, and the file is gone, when it is of
  // another patient, study or series, of another UID, or cannot be read. Throws IoError.
  bool keep(const std::filesystem::path& temporary, const std::string& sop_uid);

  // Everything is there: on the disk for good, then under its name. Throws IoError; the waiting room then
  // stays.
  void finish();
  // Removes the waiting room when it holds nothing, so that a refused request leaves none.
  void leave() noexcept;

 private:
  [[nodiscard]] std::int64_t free_bytes() const;
  void check_waiting_room() const;
  void create_waiting_room() const;
  void refuse(const std::string& sop_uid, const std::string& reason);
  void take_stock(const std::filesystem::path& folder, bool is_ours);

  const std::filesystem::path folder_;
  const std::string series_uid_;
  const Limits limits_;
  std::filesystem::path waiting_room_;
  Expected expected_;
  mutable std::mutex mutex_;
  std::map<std::string, std::filesystem::path> files_;  // by SOP instance UID
  std::vector<std::filesystem::path> cut_off_;          // in the folder that was there
  std::int64_t received_bytes_ = 0;
  unsigned begun_ = 0;
  int refused_count_ = 0, again_count_ = 0;
  int had_count_ = 0;  // when it began
  std::string refusal_;
};

}  // namespace arthronaut::pacs
