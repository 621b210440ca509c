#include "navigation/recording/frame_record.h"

#include <algorithm>
#include <exception>
#include <iterator>

#include "planning/geometry/error.h"

namespace arthronaut::recording {

namespace {

void bind_vector(Statement& statement, int first, const Eigen::Vector3d& v) {
  statement.bind(first, v.x()).bind(first + 1, v.y()).bind(first + 2, v.z());
}

Eigen::Vector3d vector_at(const Statement& statement, int first) {
  return {statement.number(first), statement.number(first + 1), statement.number(first + 2)};
}

RecordedFrame frame_at(const Statement& row) {
  RecordedFrame frame;
  frame.index = row.integer(0);
  frame.timestamp_ns = row.integer(1);
  lens::LensObservation& lens = frame.lens;
  lens.timestamp_ns = frame.timestamp_ns;
  lens.circle_found = row.boolean(2);
  lens.circle.center_px = {row.number(3), row.number(4)};
  lens.circle.radius_px = row.number(5);
  lens.circle_coverage_deg = row.number(6);
  lens.mark = row.one_of(7, lens::MarkState::NotSeen);
  lens.polarity = row.one_of(8, lens::MarkPolarity::BrightOutward);
  lens.mark_angle_deg = row.number(9);
  lens.mark_sigma_deg = row.number(10);
  lens.is_stale = row.boolean(11);
  lens.zoom_or_slip = row.boolean(12);
  frame.intrinsics_are_known = row.boolean(13);
  frame.is_frozen = row.boolean(14);
  frame.tip_is_valid = row.boolean(15);
  if (frame.tip_is_valid) frame.tip_in_world_mm = vector_at(row, 16);
  return frame;
}

strokes::PoseRow pose_at(const Statement& row, const RecordedFrame& frame) {
  strokes::PoseRow pose;
  pose.frame = frame.index;
  pose.time_s = static_cast<double>(frame.timestamp_ns) * 1e-9;
  pose.marker_id = row.int32(1);
  pose.camera_from_marker.rotation = {row.number(4), row.number(5), row.number(6), row.number(7)};
  pose.camera_from_marker.translation_mm = vector_at(row, 8);
  pose.rms_px = row.number(11);
  if (frame.lens.mark == lens::MarkState::Found) pose.mark_angle_deg = frame.lens.mark_angle_deg;
  return pose;
}

// remaining_mm stands in column 14, all else from 18 on.
std::optional<guidance::DrillDepth> drill_at(const Statement& row) {
  // Of before 2026-11-22 none: what they call remaining was the guide's, nobody saw the drill.
  constexpr int kColumns = 21, kColumnsWithPlace = 30, kColumnsWithExit = 31, kColumnsWithMarker = 32;
  if (row.column_count() < kColumns || row.is_null(18)) return std::nullopt;
  guidance::DrillDepth drill;
  drill.depth_mm = row.number(18);
  drill.remaining_mm = row.number(14);
  drill.to_exit_mm = row.is_null(19) ? geometry::kNotKnown : row.number(19);
  drill.sigma_mm = row.number(20);
  drill.breakout = guidance::breakout_of(drill.to_exit_mm, drill.sigma_mm);
  // Of before 2026-11-27 nobody knows where the drill was, so that nothing can rest on it.
  drill.lateral_mm = drill.exit_lateral_mm = geometry::kNotKnown;
  if (row.column_count() < kColumnsWithPlace) return drill;
  drill.lateral_mm = row.number(21);
  if (!row.is_null(22)) drill.sigma_offset_mm = row.number(22);
  if (!row.is_null(23)) drill.sigma_angle_deg = row.number(23);
  drill.tip_mm = vector_at(row, 24);
  drill.direction = vector_at(row, 27);
  if (row.column_count() >= kColumnsWithExit) drill.exit_lateral_mm = row.number(30);
  if (row.column_count() >= kColumnsWithMarker && !row.is_null(31)) drill.marker_id = row.int32(31);
  // The plan's exit, as records kept it that knew no other, is none beside the plan.
  if (drill.is_beside_plan() && drill.to_exit_mm == drill.remaining_mm) {
    drill.to_exit_mm = geometry::kNotKnown;
    drill.breakout = guidance::Breakout::Far;
  }
  return drill;
}

guidance::GuidanceNumbers guidance_at(const Statement& row, const RecordedFrame& frame) {
  guidance::GuidanceNumbers g;
  g.timestamp_ns = frame.timestamp_ns;
  g.state = row.one_of(1, guidance::kLastGuidanceState);
  g.drill = drill_at(row);  // seen without its guide, too
  if (!g.is_valid()) return g;
  g.guide_point_mm = vector_at(row, 2);
  g.guide_direction = vector_at(row, 5);
  g.tip_to_entry_mm = row.number(8);
  g.axis_to_entry_mm = row.number(9);
  g.angle_deg = row.number(10);
  g.offset_anterior_mm = row.number(11);
  g.offset_proximal_mm = row.number(12);
  g.depth_mm = row.number(13);
  g.sigma_offset_mm = row.number(15);
  g.sigma_angle_deg = row.number(16);
  if (constexpr int kLateral = 17; row.column_count() > kLateral) g.offset_lateral_mm = row.number(kLateral);
  g.offset_mm = Eigen::Vector3d(g.offset_anterior_mm, g.offset_proximal_mm, g.offset_lateral_mm).norm();
  return g;
}

tracker::BodyPose outside_at(const Statement& row) {
  tracker::BodyPose body;
  body.id = row.int32(2);
  body.state = row.one_of(3, tracker::BodyState::OtherWorld);
  body.tracker_from_body.rotation = {row.number(4), row.number(5), row.number(6), row.number(7)};
  body.tracker_from_body.translation_mm = vector_at(row, 8);
  body.stamp_utc_s = row.number(11);
  body.age_s = row.number(12);
  return body;
}

// Rows of another table, in the order of frames, each with its frame.
template <typename Visit>
void for_each_row(Statement& rows, std::vector<RecordedFrame>& frames, const Visit& visit) {
  auto frame = frames.begin();
  while (rows.step()) {
    frame =
        std::find_if(frame, frames.end(), [&](const RecordedFrame& f) { return f.index == rows.integer(0); });
    if (frame == frames.end()) return;
    visit(rows, *frame);
  }
}

}  // namespace

FrameInserter::FrameInserter(SessionDatabase& database, const tools::ToolSet& tools)
    : frame_(database.prepare("INSERT INTO frames VALUES(?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?)")),
      marker_(database.prepare("INSERT INTO markers VALUES(?,?,?,?,?,?,?,?,?,?,?,?)")),
      body_(database.prepare("INSERT INTO bodies VALUES(?,?,?,?,?,?,?,?,?)")),
      outside_(database.prepare("INSERT INTO outside VALUES(?,?,?,?,?,?,?,?,?,?,?,?,?,?)")),
      guidance_(database.prepare("INSERT INTO guidance "
                                 "VALUES(?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?)")) {
  const auto add = [&](const auto& body) {
    if (!body.markers.empty()) bodies_of_several_.push_back(body.marker_id);
  };
  for (const tools::WorldMarker& world : tools.world_markers) add(world);
  for (const tools::Tool& tool : tools.tools) add(tool);
}

void FrameInserter::insert(const pipeline::FrameResult& result) {
  const lens::LensObservation& lens = result.lens;
  frame_.bind(1, result.frame_index).bind(2, result.timestamp_ns).bind(3, lens.circle_found);
  frame_.bind(4, lens.circle.center_px.x()).bind(5, lens.circle.center_px.y()).bind(6, lens.circle.radius_px);
  frame_.bind(7, lens.circle_coverage_deg).bind(8, static_cast<int>(lens.mark));
  frame_.bind(9, static_cast<int>(lens.polarity)).bind(10, lens.mark_angle_deg).bind(11, lens.mark_sigma_deg);
  frame_.bind(12, lens.is_stale).bind(13, lens.zoom_or_slip).bind(14, result.intrinsics_are_known);
  // Of either no pose stood: run again without its picture, none must stand.
  frame_.bind(15, result.is_frozen || result.is_repeating).bind(16, result.tip_is_valid);
  bind_vector(frame_, 17, result.tip_in_world_mm);
  frame_.bind(20, result.processing_ms).run();

  for (const markers::MarkerObservation& marker : result.markers) {
    const bool has_pose = result.stands_for(marker);
    marker_.bind(1, result.frame_index).bind(2, marker.id).bind(3, static_cast<int>(marker.state));
    marker_.bind(4, has_pose);
    for (int position = 5; position <= 12; ++position) marker_.bind_null(position);
    if (has_pose) {
      const Eigen::Quaterniond& q = marker.camera_from_marker.rotation;
      marker_.bind(5, q.w()).bind(6, q.x()).bind(7, q.y()).bind(8, q.z());
      bind_vector(marker_, 9, marker.camera_from_marker.translation_mm);
      marker_.bind(12, marker.rms_px);
    }
    marker_.run();
  }

  for (const markers::BodyObservation& body : result.bodies) {
    const bool is_of_several =
        std::find(bodies_of_several_.begin(), bodies_of_several_.end(), body.id) != bodies_of_several_.end();
    if (!is_of_several || !body.is_tracked() || !result.poses_stand()) continue;
    const Eigen::Quaterniond& q = body.camera_from_body.rotation;
    body_.bind(1, result.frame_index).bind(2, body.id);
    body_.bind(3, q.w()).bind(4, q.x()).bind(5, q.y()).bind(6, q.z());
    bind_vector(body_, 7, body.camera_from_body.translation_mm);
    body_.run();
  }

  insert_outside(result);

  const guidance::GuidanceNumbers& g = result.guidance;
  guidance_.bind(1, result.frame_index).bind(2, static_cast<int>(g.state));
  for (int position = 3; position <= 32; ++position) guidance_.bind_null(position);
  if (g.is_valid()) {
    bind_vector(guidance_, 3, g.guide_point_mm);
    bind_vector(guidance_, 6, g.guide_direction);
    guidance_.bind(9, g.tip_to_entry_mm).bind(10, g.axis_to_entry_mm).bind(11, g.angle_deg);
    guidance_.bind(12, g.offset_anterior_mm).bind(13, g.offset_proximal_mm).bind(14, g.depth_mm);
    guidance_.bind(16, g.sigma_offset_mm).bind(17, g.sigma_angle_deg);
    guidance_.bind(18, g.offset_lateral_mm);
  }
  if (g.drill) {
    const guidance::DrillDepth& drill = *g.drill;
    guidance_.bind(15, drill.remaining_mm).bind(19, drill.depth_mm).bind(20, drill.to_exit_mm);
    guidance_.bind(21, drill.sigma_mm).bind(22, drill.lateral_mm);
    guidance_.bind(23, drill.sigma_offset_mm).bind(24, drill.sigma_angle_deg);  // not a number: NULL
    bind_vector(guidance_, 25, drill.tip_mm);
    bind_vector(guidance_, 28, drill.direction);
    guidance_.bind(31, drill.exit_lateral_mm);
    if (drill.marker_id) guidance_.bind(32, *drill.marker_id);
  }
  guidance_.run();
}

void FrameInserter::insert_outside(const pipeline::FrameResult& result) {
  for (std::size_t i = 0; i < result.outside.bodies.size(); ++i) {
    const tracker::BodyPose& body = result.outside.bodies[i];
    const Eigen::Quaterniond& q = body.tracker_from_body.rotation;
    outside_.bind(1, result.frame_index).bind(2, static_cast<int>(i)).bind(3, body.id);
    outside_.bind(4, static_cast<int>(body.state))
        .bind(5, q.w())
        .bind(6, q.x())
        .bind(7, q.y())
        .bind(8, q.z());
    bind_vector(outside_, 9, body.tracker_from_body.translation_mm);
    outside_.bind(12, body.stamp_utc_s).bind(13, body.age_s).bind(14, result.outside.times_are_arrivals);
    outside_.run();
  }
}

std::vector<RecordedFrame> read_frames(SessionDatabase& database, std::int64_t first, std::int64_t last) {
  const auto among = [&](const std::string& select, const std::string& order) {
    return select + " WHERE frame BETWEEN " + std::to_string(first) + " AND " + std::to_string(last) +
           " ORDER BY " + order;
  };
  std::vector<RecordedFrame> frames;
  Statement rows = database.prepare(
      among("SELECT frame, timestamp_ns, circle_found, circle_x_px, circle_y_px, circle_radius_px, "
            "circle_coverage_deg,"
            " mark_state, mark_polarity, mark_angle_deg, mark_sigma_deg, lens_is_stale, zoom_or_slip, "
            "intrinsics_are_known,"
            " is_frozen, tip_is_valid, tip_x_mm, tip_y_mm, tip_z_mm FROM frames",
            "frame"));
  while (rows.step()) frames.push_back(frame_at(rows));

  Statement markers = database.prepare(among("SELECT * FROM markers", "frame, marker_id"));
  for_each_row(markers, frames, [](const Statement& row, RecordedFrame& frame) {
    frame.markers.push_back({row.int32(1), row.one_of(2, markers::MarkerState::Disagreeing)});
    if (row.boolean(3)) frame.poses.push_back(pose_at(row, frame));
  });
  Statement guidance = database.prepare(among("SELECT * FROM guidance", "frame"));
  for_each_row(guidance, frames,
               [](const Statement& row, RecordedFrame& frame) { frame.guidance = guidance_at(row, frame); });
  // Records that are older than a table lack it.
  const auto has_table = [&](const char* name) {
    return database.prepare("SELECT 1 FROM sqlite_master WHERE name = ?")
        .bind(1, std::string_view(name))
        .step();
  };
  if (has_table("bodies")) {
    Statement bodies = database.prepare(among("SELECT * FROM bodies", "frame, body_id"));
    for_each_row(bodies, frames, [](const Statement& row, RecordedFrame& frame) {
      RecordedBody body{row.int32(1), {}};
      body.camera_from_body.rotation = {row.number(2), row.number(3), row.number(4), row.number(5)};
      body.camera_from_body.translation_mm = vector_at(row, 6);
      frame.bodies.push_back(body);
    });
  }
  if (has_table("outside")) {
    Statement outside = database.prepare(among("SELECT * FROM outside", "frame, place"));
    for_each_row(outside, frames, [](const Statement& row, RecordedFrame& frame) {
      frame.outside.bodies.push_back(outside_at(row));
      frame.outside.times_are_arrivals = row.boolean(13);
    });
  }
  if (!has_table("digests")) return frames;
  Statement digests = database.prepare(among("SELECT * FROM digests", "frame"));
  for_each_row(digests, frames, [](const Statement& row, RecordedFrame& frame) {
    frame.digests = {static_cast<std::uint64_t>(row.integer(1)), static_cast<std::uint64_t>(row.integer(2))};
  });
  return frames;
}

bool for_each_frame(SessionDatabase& database, const std::function<bool(RecordedFrame&)>& use) {
  std::vector<std::int64_t> indices;
  std::exception_ptr damage;
  try {
    Statement rows = database.prepare("SELECT frame FROM frames ORDER BY frame");
    while (rows.step()) indices.push_back(rows.integer(0));
  } catch (const IoError&) {
    damage = std::current_exception();
  }
  // In blocks, which get smaller up to the frame of which something cannot be read.
  std::size_t many = 1024;
  for (std::size_t at = 0; at < indices.size();) {
    const std::size_t end = std::min(at + many, indices.size());
    std::vector<RecordedFrame> block;
    try {
      block = read_frames(database, indices[at], indices[end - 1]);
    } catch (const std::exception&) {
      if (many == 1) throw;
      many /= 2;
      continue;
    }
    at = end;
    for (RecordedFrame& frame : block)
      if (!use(frame)) return false;
  }
  if (damage) std::rethrow_exception(damage);
  return true;
}

}  // namespace arthronaut::recording
