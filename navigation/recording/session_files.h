// The plain files of a session's folder.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "navigation/recording/session.h"

namespace arthronaut::recording {

[[nodiscard]] std::filesystem::path header_file(const std::filesystem::path& session_folder);
[[nodiscard]] std::filesystem::path database_file(const std::filesystem::path& session_folder);

// session.json. `options` gives and takes what the header does not hold: fluid model and whether the lens is
// followed; camera and tools travel in their own files.
void write_session_header(const std::filesystem::path& folder, const SessionHeader& header,
                          const pipeline::PipelineOptions& options);
[[nodiscard]] SessionHeader read_session_header(const std::filesystem::path& folder,
                                                pipeline::PipelineOptions& options);
// Whether session.json says that a chain of hashes is written beside it; older versions wrote none, and the
// first that did closed none and do not say so. Throws IoError or InvalidInput.
[[nodiscard]] bool says_it_has_a_chain(const std::filesystem::path& session_folder);

// guidance.csv: one row a frame; numbers are empty where there is no guidance, and `state` says why.
inline constexpr std::string_view kGuidanceHeader =
    "frame,time_s,state,tip_to_entry_mm,axis_to_entry_mm,angle_deg,offset_anterior_mm,offset_proximal_mm,"
    "depth_mm,remaining_mm,sigma_offset_mm,sigma_angle_deg,point_x_mm,point_y_mm,point_z_mm,direction_x,"
    "direction_y,direction_z,offset_lateral_mm,drill_depth_mm,drill_to_exit_mm,drill\n";
// tools: that name the drill of which the depth is.
void append_guidance_line(std::int64_t frame, std::int64_t timestamp_ns,
                          const guidance::GuidanceNumbers& guidance, const tools::ToolSet& tools,
                          std::string& text);

// The file of the nth registration of a session, from 1.
[[nodiscard]] std::string registration_name(int number);
// The text of a plan event.
[[nodiscard]] std::string plan_to_text(const std::optional<tunnels::Tunnel>& plan, double planned_length_mm);
[[nodiscard]] RecordedSession::PlanChange plan_from_text(const std::string& text,
                                                         const std::filesystem::path& name);

}  // namespace arthronaut::recording
