// An import in a process of its own: what a file holds can take neither the workstation's memory nor its
// life.
//
// The child is this program once more (import_child.h). It reads the source and makes the surface under a
// limit on its memory, and sends the bones back through a socket: nothing is written until they are whole, by
// add_to_case(), so that there is nothing to clean up after a cancellation, a crash or a kill.
//
//   Running ─► Done        the bones are there
//           ─► Failed      the source is refused (file, place, reason), needs too much memory, or ended the
//           child ─► Cancelled   by cancel()
//
// For one thread, which asks it now and then (a window in each of its frames) and never waits unless it wants
// to.
#pragma once

#include <filesystem>
#include <string>

#include "planning/import/bone_import.h"

namespace arthronaut::importing {

struct ImportRequest {
  std::filesystem::path source;
  BoneImportOptions options;  // most_bytes is set from the limit below
  double memory_limit_gib = 2.0;
  // A program that answers kImportChildWord; this one by default.
  std::filesystem::path program = "/proc/self/exe";
};

class ImportProcess {
 public:
  enum class State { Running, Done, Failed, Cancelled };

  // Starts at once. Throws InvalidInput when the limit is not positive, IoError when no process can be
  // started.
  explicit ImportProcess(ImportRequest request);
  // Cancels what still runs; the child is gone when this returns.
  ~ImportProcess();
  ImportProcess(const ImportProcess&) = delete;
  ImportProcess& operator=(const ImportProcess&) = delete;

  // Takes in what the child has sent. poll() returns at once, wait_for() after so long at the latest, earlier
  // when something came.
  State poll() { return wait_for(0); }
  State wait_for(double seconds);

  [[nodiscard]] State state() const { return state_; }
  [[nodiscard]] const ImportProgress& progress() const { return progress_; }
  // Why it failed or was cancelled, for a person; empty otherwise.
  [[nodiscard]] const std::string& message() const { return message_; }
  // The bones, once; the state must be Done.
  [[nodiscard]] BoneImport take_result();

  // Ends the child at once. A result that came before stays.
  void cancel();

  [[nodiscard]] int process_id() const { return process_id_; }  // -1 once it has ended

 private:
  void take_in(const std::string& bytes);
  void take_image();
  void end_by_itself();  // the child has closed its end
  int ended_child();     // its status
  void fail(const std::string& reason);

  ImportRequest request_;
  int socket_ = -1, process_id_ = -1, shared_ = -1;
  State state_ = State::Running;
  std::string buffer_, message_;
  ImportProgress progress_;
  BoneImport result_;
};

}  // namespace arthronaut::importing
