// Which tunnels of a case its records say are drilled, and whose world markers are out: what a program that
// is started again between the bones has to know. Of live sources with somebody at the pedal alone: a
// rehearsal and a recording say nothing of the patient.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "navigation/operation/drilled_tunnels.h"

namespace arthronaut::recording {

struct DrilledBefore {
  operation::DrilledTunnels tunnels;
  // The newest session of each bone that was read, and is not being written: what is said of the end of that
  // operation before another source begins belongs into it (theatre::OperationRun::goes_on_after).
  std::map<bones::BoneKind, std::filesystem::path> newest;
  std::vector<std::string> passed_over;  // sessions that cannot be read, with the reason each
};

// The sessions are read in the order of their numbers, each after what the ones before it had come to; those
// on another surface of the bone than this one (bones::mesh_sha256, for each bone of the case) are passed
// over. Reads their events: not for the window's thread. Throws what reading the case's folder throws.
[[nodiscard]] DrilledBefore drilled_before(const std::filesystem::path& case_folder,
                                           const std::map<bones::BoneKind, std::string>& mesh_sha256);

}  // namespace arthronaut::recording
