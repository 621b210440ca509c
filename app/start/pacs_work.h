// What the window asks of a PACS, one thing at a time, beside the screen.
//
//   Idle ─► Running ─► Done, Unreliable, Failed, Stopped   with the reason
//
// One thread calls, and polls once a frame; the work is that of planning/pacs and runs on a worker's.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <stop_token>
#include <string>
#include <vector>

#include "app/start/pacs_peers.h"
#include "navigation/worker/worker.h"
#include "planning/pacs/query.h"
#include "planning/pacs/retrieve.h"
#include "planning/pacs/send.h"

namespace arthronaut::start {

struct PacsJob {
  enum class Kind { Echo, Find, Fetch, WriteResults, Send } kind = Kind::Echo;
  PacsPeer peer;
  pacs::FindKeys keys = {};                                     // Find
  pacs::RetrieveRequest request = {};                           // Fetch; its folder's parent is made
  std::filesystem::path case_folder = {}, results_folder = {};  // WriteResults: emptied first
  bool is_deidentified = false;
  std::vector<pacs::SentFile> files = {};  // Send
  std::stop_token stop = {};               // set by PacsWork
};

struct PacsNews {
  enum class State { Idle, Running, Done, Unreliable, Failed, Stopped } state = State::Idle;
  PacsJob::Kind kind = PacsJob::Kind::Echo;
  // What came of it, in a sentence or two; while it runs that it is tried again, and why.
  std::string words;
  pacs::TransferProgress progress;
  pacs::FindSummary found;            // Find
  pacs::RetrieveSummary retrieved;    // Fetch
  std::vector<pacs::SentFile> files;  // WriteResults: what goes out
  pacs::SendSummary sent;             // Send
};

// Does it, on the thread that calls; what it throws is in the news. `program`: this one, which writes the
// results in a process of its own (`arthronaut dicom`).
[[nodiscard]] PacsNews do_pacs_job(const PacsJob& job, const std::filesystem::path& program,
                                   const pacs::OnProgress& on_progress = {});

class PacsWork {
 public:
  explicit PacsWork(std::function<void()> wake, std::filesystem::path program = "/proc/self/exe");
  ~PacsWork();  // cancels
  PacsWork(const PacsWork&) = delete;
  PacsWork& operator=(const PacsWork&) = delete;

  void start(PacsJob job);  // nothing while one runs
  void cancel();            // asked for: it ends within a second or two
  void end();               // the same, and waits for it
  // Takes over what the worker has published; true when it is new.
  bool poll();
  [[nodiscard]] const PacsNews& news() const { return *news_; }
  [[nodiscard]] bool is_busy() const { return news_->state == PacsNews::State::Running; }

 private:
  std::stop_source stop_;
  std::shared_ptr<const PacsNews> news_, taken_;
  worker::Worker<PacsJob, PacsNews> worker_;
};

// Where a fetched series goes: its own folder for each, so that the same again goes on where it was.
[[nodiscard]] std::filesystem::path fetched_folder(const std::filesystem::path& data_folder,
                                                   const pacs::FoundSeries& series);

}  // namespace arthronaut::start
