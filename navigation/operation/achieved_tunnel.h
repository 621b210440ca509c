// The tunnel as drilled, in a session's achieved.json (format "arthronaut.achieved", version 1), of a tunnel
// of one bundle in achieved_am.json or achieved_pl.json, so that a session holds both: as navigation measured
// it, what was planned, and, from the simulator alone, what was true. Version 2 is of one that was said to be
// drilled too early and was taken back: it stays as part of the record, and nobody tells of it as achieved.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "planning/tunnels/tunnel.h"

namespace arthronaut::operation {

struct AchievedTunnel {
  tunnels::Tunnel planned;
  tunnels::Tunnel measured;  // by navigation, in the bone's frame
  // Of the drill beyond the entry: of one with a marker of its own, else as the surgeon read it off the depth
  // stop. Empty: nobody knows it.
  std::optional<double> depth_mm;
  std::int64_t timestamp_ns = 0;  // of the last pose it rests on
  int pose_count = 0;             // it is the median of so many poses
  double sigma_offset_mm = 0;     // predicted, one sigma
  double sigma_angle_deg = 0;
  std::optional<tunnels::Tunnel> truth;
  bool is_taken_back = false;
};

// How one tunnel lies to another of the same bone.
struct TunnelDifference {
  double entry_mm = 0;          // between the entries
  double axis_to_entry_mm = 0;  // reference entry to the other's axis
  double angle_deg = 0;         // between the axes
};
[[nodiscard]] TunnelDifference compare(const tunnels::Tunnel& reference, const tunnels::Tunnel& other);

[[nodiscard]] std::string achieved_file_name(const tunnels::TunnelKey& key);
// Those that the session holds and that were not taken back: of its single tunnel, of AM, of PL. One that
// cannot be read is among them: who reads it says so.
[[nodiscard]] std::vector<std::filesystem::path> achieved_files(const std::filesystem::path& session_folder);

// Throws IoError or InvalidInput (file, place, reason).
[[nodiscard]] AchievedTunnel read_achieved_file(const std::filesystem::path& file);
// Atomic. Throws IoError.
void write_achieved_file(const std::filesystem::path& file, const AchievedTunnel& achieved);

}  // namespace arthronaut::operation
