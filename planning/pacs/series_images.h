// What a peer says that a series holds. Inner header of pacs.
#pragma once

#include <map>
#include <stop_token>
#include <string>

#include "planning/pacs/connection.h"

namespace arthronaut::pacs {

struct SeriesImages {
  bool was_stopped = false;
  bool is_known = false;                            // the peer has the series
  std::string study_uid, patient_id;                // UTF-8
  std::map<std::string, std::string> class_by_uid;  // SOP class by SOP instance; class empty where not said
  int nameless_count = 0;                           // images under no UID, which no fetch would bring
  int said_count = -1;  // as the peer counts the series (0020,1209); -1: it does not say

  // Many peers end a list at a maximum of theirs, and call it whole.
  [[nodiscard]] bool is_cut_off() const {
    return !class_by_uid.empty() && said_count > static_cast<int>(class_by_uid.size());
  }
  // In words, with what can be done; for a list that is cut off.
  [[nodiscard]] std::string cut_off_words() const;
};

// Throws DeviceError, also for a series of which an image has no valid UID: it could not be called whole.
[[nodiscard]] SeriesImages ask_series_images(const Peer& peer, const ConnectionOptions& connection,
                                             const std::string& series_uid, const std::string& study_uid,
                                             const std::stop_token& stop);

}  // namespace arthronaut::pacs
