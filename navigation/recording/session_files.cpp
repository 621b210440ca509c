#include "navigation/recording/session_files.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "planning/bones/bone_json.h"
#include "planning/files/atomic_file.h"
#include "planning/files/csv_cell.h"
#include "planning/files/json_document.h"
#include "planning/files/sha256.h"
#include "planning/tunnels/tunnel_json.h"

namespace arthronaut::recording {

namespace {

constexpr const char* kSessionFormat = "arthronaut.session";
constexpr const char* kPlanFormat = "arthronaut.session-plan";
constexpr int kFilesVersion = 1;

void append_number(std::string& line, double value) {
  char text[32];
  std::snprintf(text, sizeof text, ",%.6f", value);
  line += text;
}

// Empty where the drill is not seen, or the number is not known.
void append_drill(std::string& line, const guidance::GuidanceNumbers& numbers,
                  double guidance::DrillDepth::*value) {
  if (numbers.drill && std::isfinite((*numbers.drill).*value))
    append_number(line, (*numbers.drill).*value);
  else
    line += ',';
}

nlohmann::ordered_json to_json(const landmarks::AnatomicalAxes& axes) {
  const auto numbers = [](const Eigen::Vector3d& v) { return nlohmann::ordered_json{v.x(), v.y(), v.z()}; };
  return {{"from", landmarks::to_text(axes.origin)},
          {"anterior", numbers(axes.anterior)},
          {"proximal", numbers(axes.proximal)},
          {"lateral", numbers(axes.lateral)}};
}

// To the bit as they were written: offsets that are found again have to be those that were recorded.
landmarks::AnatomicalAxes axes_of(const files::JsonObject& json) {
  using Origin = landmarks::AnatomicalAxes::Origin;
  constexpr std::array kOrigins{Origin::FromLandmarks, Origin::FromShaft, Origin::FromScanner};
  const std::string from = json.text("from");
  const auto* const origin =
      std::ranges::find_if(kOrigins, [&](Origin one) { return landmarks::to_text(one) == from; });
  if (origin == kOrigins.end()) json.fail("from", "names nothing that tells a bone's axes");
  landmarks::AnatomicalAxes axes;
  axes.origin = *origin;
  axes.anterior = json.vector3("anterior");
  axes.proximal = json.vector3("proximal");
  axes.lateral = json.vector3("lateral");
  Eigen::Matrix3d across;
  across << axes.anterior, axes.proximal, axes.lateral;
  if (!(across.transpose() * across).isIdentity(1e-6))
    json.fail("anterior", "must be unit and at right angles to proximal and lateral");
  return axes;
}

std::vector<VideoPart> video_parts_of(const files::JsonObject& json) {
  std::vector<VideoPart> parts;
  for (const files::JsonObject& object : json.objects("video_parts")) {
    VideoPart part;
    part.file = object.text("file");
    part.first_picture = object.integer("first_picture");
    part.as = pictures_as_from_option(object.text("pictures"));
    part.codec = object.text("codec");
    part.held_back = object.int32("held_back");
    // A part that lies anywhere else is no part of this record.
    if (part.file.find('/') != std::string::npos || part.held_back < 0 || part.held_back > 16 ||
        part.first_picture < (parts.empty() ? 0 : parts.back().first_picture) ||
        (parts.empty() && part.first_picture != 0))
      object.fail("video_parts", "is no part of a video");
    parts.push_back(part);
  }
  return parts;
}

}  // namespace

const std::string& build_identity() {
  static const std::string kIdentity = files::sha256_of_file("/proc/self/exe");
  return kIdentity;
}

std::filesystem::path header_file(const std::filesystem::path& folder) { return folder / "session.json"; }
std::filesystem::path database_file(const std::filesystem::path& folder) { return folder / "session.sqlite"; }

void write_session_header(const std::filesystem::path& folder, const SessionHeader& header,
                          const pipeline::PipelineOptions& options) {
  nlohmann::ordered_json json;
  json["format"] = kSessionFormat;
  json["version"] = kFilesVersion;
  json["id"] = header.id;
  json["started_utc"] = header.started_utc;
  json["bone"] = bones::to_text(header.bone);
  json["side"] = bones::to_text(header.side);
  json["refractive_index"] = header.refractive_index;
  json["probe"] = header.probe_name;
  json["guide"] = header.guide_name;
  json["source"] = header.source;
  json["video"] = header.video;
  json["video_is_reencoded"] = header.video_is_reencoded;
  json["video_has_exact_luma"] = header.video_has_exact_luma;
  for (const VideoPart& part : header.video_parts)
    json["video_parts"].push_back({{"file", part.file},
                                   {"first_picture", part.first_picture},
                                   {"pictures", to_option(part.as)},
                                   {"codec", part.codec},
                                   {"held_back", part.held_back}});
  if (header.source_kind) {
    json["source_kind"] = sources::to_text(*header.source_kind);
    json["probe_drew_at_start"] = header.probe_drew_at_start;
    json["time_out_first"] = header.time_out_first;
  }
  if (!header.mesh_sha256.empty()) json["mesh_sha256"] = header.mesh_sha256;
  if (!header.continues.empty()) json["continues"] = header.continues;
  if (header.registers_after_mm > 0) json["registers_after_mm"] = header.registers_after_mm;
  json["follow_lens"] = options.follow_lens;
  json["flat_port"] = options.fluid_model == camera::FluidModel::FlatPort;
  if (options.axes) json["axes"] = to_json(*options.axes);
  json["program_version"] = header.program_version;
  if (!header.build.empty()) json["build"] = header.build;
  json["hash_chain"] = true;
  files::write_json(header_file(folder), json);
}

SessionHeader read_session_header(const std::filesystem::path& folder, pipeline::PipelineOptions& options) {
  const files::JsonObject json = files::read_json(header_file(folder), kSessionFormat, kFilesVersion);
  SessionHeader header;
  header.id = json.text("id");
  header.started_utc = json.text("started_utc");
  header.bone = bones::read_bone_kind(json, "bone");
  header.side = bones::read_side(json, "side");
  header.refractive_index = json.positive_number("refractive_index");
  header.probe_name = json.text("probe");
  header.guide_name = json.text("guide");
  header.source = json.text("source");
  header.video = json.text("video");
  header.video_is_reencoded = json.boolean("video_is_reencoded");
  header.video_has_exact_luma = json.has("video_has_exact_luma") && json.boolean("video_has_exact_luma");
  if (json.has("video_parts")) header.video_parts = video_parts_of(json);
  header.program_version = json.text("program_version");
  if (json.has("build")) header.build = json.text("build");
  if (json.has("source_kind")) {
    header.source_kind = sources::source_kind_from_text(json.text("source_kind"));
    if (!header.source_kind) json.fail("source_kind", "must be live, recording or simulation");
  }
  if (json.has("probe_drew_at_start")) header.probe_drew_at_start = json.boolean("probe_drew_at_start");
  if (json.has("time_out_first")) header.time_out_first = json.boolean("time_out_first");
  if (json.has("mesh_sha256")) header.mesh_sha256 = json.text("mesh_sha256");
  if (json.has("continues")) header.continues = json.text("continues");
  if (json.has("registers_after_mm")) header.registers_after_mm = json.positive_number("registers_after_mm");
  options.bone = header.bone;
  options.side = header.side;
  options.refractive_index = header.refractive_index;
  options.probe_name = header.probe_name;
  options.guide_name = header.guide_name;
  options.follow_lens = json.boolean("follow_lens");
  options.fluid_model =
      json.boolean("flat_port") ? camera::FluidModel::FlatPort : camera::FluidModel::FocalRule;
  if (json.has("axes")) options.axes = axes_of(json.object("axes"));
  return header;
}

bool says_it_has_a_chain(const std::filesystem::path& folder) {
  const files::JsonObject json = files::read_json(header_file(folder), kSessionFormat, kFilesVersion);
  return json.has("hash_chain") && json.boolean("hash_chain");
}

void append_guidance_line(std::int64_t frame, std::int64_t timestamp_ns, const guidance::GuidanceNumbers& g,
                          const tools::ToolSet& tools, std::string& text) {
  text += std::to_string(frame);
  append_number(text, static_cast<double>(timestamp_ns) * 1e-9);
  text += ',';
  text += guidance::to_text(g.state);
  const auto append_of_guide = [&](std::initializer_list<double> values) {
    for (const double value : values) {
      if (g.is_valid())
        append_number(text, value);
      else
        text += ',';
    }
  };
  append_of_guide({g.tip_to_entry_mm, g.axis_to_entry_mm, g.angle_deg, g.offset_anterior_mm,
                   g.offset_proximal_mm, g.depth_mm});
  append_drill(text, g, &guidance::DrillDepth::remaining_mm);
  append_of_guide({g.sigma_offset_mm, g.sigma_angle_deg, g.guide_point_mm.x(), g.guide_point_mm.y(),
                   g.guide_point_mm.z(), g.guide_direction.x(), g.guide_direction.y(), g.guide_direction.z(),
                   g.offset_lateral_mm});
  append_drill(text, g, &guidance::DrillDepth::depth_mm);
  append_drill(text, g, &guidance::DrillDepth::to_exit_mm);
  text += ',';
  for (const tools::Tool& tool : tools.tools)
    if (g.drill && g.drill->marker_id == tool.marker_id) text += files::csv_cell(tool.name);
  text += '\n';
}

std::string registration_name(int number) { return "registration_" + std::to_string(number) + ".json"; }

std::string plan_to_text(const std::optional<tunnels::Tunnel>& plan, double planned_length_mm) {
  if (!plan) return "";
  nlohmann::ordered_json json;
  json["format"] = kPlanFormat;
  json["version"] = kFilesVersion;
  tunnels::put_key(plan->key(), json);
  json.update(tunnels::to_json(*plan));
  json["length_mm"] = planned_length_mm;
  return json.dump();
}

RecordedSession::PlanChange plan_from_text(const std::string& text, const std::filesystem::path& name) {
  RecordedSession::PlanChange change;
  if (text.empty()) return change;
  const files::JsonObject json = files::parse_json(text, name, kPlanFormat, kFilesVersion);
  change.plan = tunnels::read_tunnel(json, tunnels::read_key(json));
  change.planned_length_mm = json.number("length_mm");
  return change;
}

}  // namespace arthronaut::recording
