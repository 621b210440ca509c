// What an operation left behind that was cut off, by a crash or by a window that was closed, or that nobody
// has finished: what "Resume" offers.
#pragma once

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "navigation/operation/command.h"
#include "navigation/recording/session.h"

namespace arthronaut::recording {

// Of a tunnel that is drilled by the surgeon's word alone.
struct SaidDrilled {
  std::string tunnel;  // as tunnels::name_of() names it
  std::chrono::system_clock::time_point when;
};

struct Resumable {
  operation::ResumeOperation operation;  // to be given to a new operation as it is
  // Why no registration is brought back: "it was in doubt at the end: ...", "nothing was registered". Empty
  // when one is.
  std::string refusal;
  bool was_verified = false;   // the registration, by touches; one touch has to confirm it all the same
  double drawn_length_mm = 0;  // of all strokes, along their samples
  // Of two bundles' tunnels those that the surgeon said he had drilled, AM before PL.
  std::vector<tunnels::TunnelKey> drilled;
  // In the order in which it was said. The operation is not at its end by that: no pose shows where they run.
  std::vector<SaidDrilled> said_drilled;
  SessionHeader header;                                // of the newest session of it
  std::chrono::system_clock::time_point last_written;  // when that was
  bool was_finished = false;                           // false: it was cut off, as by a crash; or it goes on:
  bool is_being_recorded = false;                      // now, in another window or program
  bool was_declined = false;                           // see declined_resume.h
  std::filesystem::path folder;                        // of that newest session
};

struct ResumeSearch {
  std::optional<Resumable> left;
  std::string why_none;                  // nothing is left: "session 0003-...: its tunnels are drilled"
  std::vector<std::string> passed_over;  // newer sessions that cannot be read, with the reason each
};

// Of the newest session of this bone (by its number, see cases::session_folders) and of those that it goes on
// from. That session decides, as in find_registration(): what was in doubt at its end brings no older
// registration back, and after an alarm nothing that rests on the world marker. Nothing is left: there is
// none; it is of another mesh (mesh_sha256 as bones::mesh_sha256; empty: not known, matches any); nobody was
// at its pedal; its tunnels were drilled, so it came to its end; or it had come to nothing. Sessions without
// a frame say nothing. planned: the bone's planned tunnels, as the case has them now; after one of two
// bundles' tunnels was drilled the operation goes on while the other one is planned and not drilled. Reads
// all of it, seconds after an hour of operation: not for the window's thread. Throws what reading the case's
// folder throws.
[[nodiscard]] ResumeSearch find_resumable(const std::filesystem::path& case_folder, bones::BoneKind bone,
                                          const std::string& mesh_sha256,
                                          const std::vector<tunnels::TunnelKey>& planned);

}  // namespace arthronaut::recording
