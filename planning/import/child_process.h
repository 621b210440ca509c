// This program once more, in a process of its own, for one piece of work on files from elsewhere: what they
// hold can take neither the workstation's memory nor its life.
//
// The child (import_child.h) works under a limit on its memory and says what it found through a socket. What
// the work is, and what is made of the messages, is for the owner to know: ImportProcess, SeriesProcess.
//
//   Running ─► Done        the owner has taken the last message
//           ─► Failed      the child refuses (file, place, reason), needs too much memory,
//                          has ended, is silent for too long, or says what cannot be
//           ─► Cancelled   by cancel()
//
// For one thread, which asks it now and then (a window in each of its frames) and never waits unless it wants
// to.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

#include "planning/import/failure_reason.h"

namespace arthronaut::importing {

struct Message;  // import_messages.h

struct ChildProcessOptions {
  std::filesystem::path source;                       // for messages
  std::filesystem::path program = "/proc/self/exe";   // one that answers kImportChildWord
  double memory_limit_gib = 2.0;                      // for messages: the child is told by the request
  std::uint64_t longest_message_bytes = 64ULL << 20;  // a longer one is not believed
  double longest_silence_s = 0;                       // then it is taken to hang; 0: it may think for ever
  std::uint64_t shared_bytes = 0;                     // memory that both see (shared_voxels.h); 0: none
};

// Throws InvalidInput when the limit is not above 0, or above 1024 GiB.
[[nodiscard]] std::uint64_t memory_limit_bytes(double memory_limit_gib);

class ChildProcess {
 public:
  enum class State { Running, Done, Failed, Cancelled };
  // Given every message but a failure's; true: it was the last. What it throws as InvalidInput is why the
  // child is believed no longer.
  using Take = std::function<bool(const Message&)>;

  // Starts at once, with the request's message. Throws IoError when no process can be started.
  ChildProcess(ChildProcessOptions options, const std::string& request);
  // Cancels what still runs. The child is gone when this returns, but for one that a disc holds: it does
  // nothing any more, and goes when the disc lets it.
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  // Takes in what the child has sent: at once with 0 seconds, else after so long at the latest, earlier when
  // something came. A child that never stops talking does not hold it up.
  State wait_for(double seconds, const Take& take);
  // Ends the child at once. What came before stays.
  void cancel();

  [[nodiscard]] State state() const { return state_; }
  // Why it failed or was cancelled, for a person; empty otherwise.
  [[nodiscard]] const std::string& message() const { return failure_.words; }
  [[nodiscard]] const Failure& failure() const { return failure_; }  // with these words
  [[nodiscard]] int process_id() const { return process_id_; }       // -1 once it has ended
  [[nodiscard]] int shared() const { return shared_; }               // the memory's descriptor; -1: none

 private:
  [[nodiscard]] double patience_s() const;  // until its silence has been too long
  void take_in(const std::string& bytes, const Take& take);
  void end_by_itself();  // the child has closed its end
  int ended_child();     // its status
  void fail(Failure failure);

  ChildProcessOptions options_;
  int socket_ = -1, process_id_ = -1, shared_ = -1;
  State state_ = State::Running;
  std::string buffer_;
  Failure failure_;  // or the cancellation
  // Something, the last time.
  std::chrono::steady_clock::time_point heard_ = std::chrono::steady_clock::now();
};

}  // namespace arthronaut::importing
