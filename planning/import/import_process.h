// An import in a process of its own: what a file holds can take neither the workstation's memory nor its
// life.
//
// The child is this program once more (import_child.h). It reads the source and makes the surface under a
// limit on its memory, and sends the bones back through a socket: nothing is written until they are whole, by
// add_to_case(), so that there is nothing to clean up after a cancellation, a crash or a kill.
//
//   Running ─► Done        the bones are there
//           ─► Failed, Cancelled   as ChildProcess says
//
// For one thread, which asks it now and then (a window in each of its frames) and never waits unless it wants
// to. What there is to import in a folder is looked for in the same way by SeriesProcess.
#pragma once

#include <filesystem>
#include <string>

#include "planning/import/bone_import.h"
#include "planning/import/child_process.h"

namespace arthronaut::importing {

struct ImportRequest {
  std::filesystem::path source;
  BoneImportOptions options;  // most_bytes is set from the limit below
  double memory_limit_gib = 2.0;
  // The images after an operation, as postop::read_postop() gives them, and no bones: of the options the
  // series alone counts.
  bool is_postop = false;
  // A program that answers kImportChildWord; this one by default.
  std::filesystem::path program = "/proc/self/exe";
};

class ImportProcess {
 public:
  using State = ChildProcess::State;

  // Starts at once. Throws InvalidInput when the limit is not positive, IoError when no process can be
  // started.
  explicit ImportProcess(ImportRequest request);

  // Takes in what the child has sent. poll() returns at once, wait_for() after so long at the latest, earlier
  // when something came.
  State poll() { return wait_for(0); }
  State wait_for(double seconds);
  // Ends the child at once, as letting go of the process does. A result that came before stays.
  void cancel() { child_.cancel(); }

  [[nodiscard]] State state() const { return child_.state(); }
  [[nodiscard]] const ImportProgress& progress() const { return progress_; }
  // Of all its stages, 0 to 1, and never back.
  [[nodiscard]] double done_fraction() const { return done_fraction_; }
  // Why it failed or was cancelled, for a person; empty otherwise.
  [[nodiscard]] const std::string& message() const { return child_.message(); }
  [[nodiscard]] const Failure& failure() const { return child_.failure(); }  // with these words
  // The bones or the images, once; the state must be Done.
  [[nodiscard]] BoneImport take_result();

  [[nodiscard]] int process_id() const { return child_.process_id(); }  // -1 once it has ended

 private:
  bool take(const Message& message);  // true: the last one
  void take_image();

  ImportRequest request_;
  ChildProcess child_;
  ImportProgress progress_;
  double done_fraction_ = 0;
  BoneImport result_;
};

}  // namespace arthronaut::importing
