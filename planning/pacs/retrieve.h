// One series from a PACS into a folder: C-GET, or C-MOVE where the peer refuses that.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <stop_token>
#include <string>
#include <vector>

#include "planning/files/free_space.h"
#include "planning/pacs/connection.h"

namespace arthronaut::pacs {

struct RetrieveRequest {
  std::string series_uid;
  std::string study_uid = {};    // empty: the peer is asked; some answer that only where the study is named
  std::filesystem::path folder;  // absent, empty, or with images of this series alone
  // What is received at most, and what must stay free on the disk; whoever needs more says so.
  std::int64_t most_bytes = std::int64_t{32} << 30;
  std::int64_t least_free_bytes = std::int64_t{512} << 20;
  // What is free where a folder lies; for tests another than the system's answer.
  std::function<std::uintmax_t(const std::filesystem::path& folder)> free_bytes = files::free_bytes_at;
};

struct RetrieveSummary {
  enum class Outcome { NotRun, Whole, Stopped, UnknownSeries, Incomplete } outcome = Outcome::NotRun;
  std::string message = "retrieve_series was not called.";
  std::string study_uid;  // of the series, where the peer said it
  std::string way;        // "C-GET", "C-MOVE" or "WADO-RS"; empty: nothing had to be fetched
  int image_count = 0;    // whole ones, now
  int kept_count = 0;     // of these, there before
  std::int64_t received_bytes = 0;
  [[nodiscard]] bool is_usable() const { return outcome == Outcome::Whole; }
};

// Fetches the images that are not in the folder yet, each as the peer keeps it where it may (files "UID.dcm",
// folder 0700). The folder appears, or is completed, when all images that the peer has of the series are
// there; until then, and after every failure, what came whole waits beside it (".NAME-HASH.incoming") and is
// not fetched again by the next call with the same folder and series. A connection that breaks is begun
// anew `retries` times without progress.
//
// The peer is not trusted: an image of another patient (as its answers name it), study or series, or one that
// it does not list, is refused and told; so is more than `most_bytes`, and a list of more than 100,000
// images.
//
// Throws InvalidInput (UID, folder, options), IoError (disk; a full one with the room that it has) and
// DeviceError (peer, with its reason); what came whole then stays, as when stopped.
[[nodiscard]] RetrieveSummary retrieve_series(const Peer& peer, const ConnectionOptions& connection,
                                              const RetrieveRequest& request,
                                              const OnProgress& on_progress = {},
                                              const std::stop_token& stop = {});

}  // namespace arthronaut::pacs
