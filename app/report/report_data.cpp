#include "app/report/report_data.h"

#include <nlohmann/json.hpp>

#include "app/report/plans_in_force.h"
#include "app/report/report_words.h"
#include "app/report/result_summary.h"
#include "app/report/session_rows.h"
#include "app/report/source_faults.h"
#include "app/report/versions.h"
#include "navigation/camera/medium.h"
#include "planning/cases/plan_file.h"
#include "planning/files/csv_cell.h"
#include "planning/files/json_document.h"
#include "planning/plan_review/tunnel_verdict.h"
#include "planning/postop/achieved_file.h"
#include "planning/tunnels/check_numbers.h"
#include "planning/tunnels/tunnel_json.h"

namespace arthronaut::report {

namespace {

using nlohmann::ordered_json;

ordered_json json_of(const operation::TunnelDifference& difference) {
  return {{"entry_mm", difference.entry_mm},
          {"axis_to_entry_mm", difference.axis_to_entry_mm},
          {"angle_deg", difference.angle_deg}};
}

ordered_json tunnels_of(const Content& content) {
  const cases::Case& knee = content.knee;
  const plan_review::CaseReview& review = *content.review;
  ordered_json all = ordered_json::array();
  for (const auto& [key, tunnel] : knee.plan.tunnels) {
    ordered_json node = {{"tunnel", tunnels::name_of(key)}};
    node.update(tunnels::to_json(tunnel));
    const cases::PlanFit fit = cases::plan_fit(knee, key);
    node["valid"] = fit.is_valid();
    if (!fit.is_valid()) node["reason"] = fit.reason;
    const auto measured = review.tunnels().find(key);
    if (measured != review.tunnels().end() && measured->second.geometry.enters_bone) {
      const tunnels::TunnelGeometry& geometry = measured->second.geometry;
      node["exit_mm"] = files::to_json(geometry.exit_mm);
      node["length_mm"] = geometry.length_mm;
      node["wall_mm"] = geometry.wall_mm;
    }
    node["checks"] = ordered_json::array();
    for (const tunnels::PlanCheck& check : review.checks(key)) {
      ordered_json entry = {{"name", check.name}, {"verdict", to_text(check.verdict)}, {"text", check.text}};
      tunnels::put_numbers(check, entry);
      if (!check.source.empty()) entry["source"] = check.source;
      node["checks"].push_back(std::move(entry));
    }
    all.push_back(std::move(node));
  }
  return all;
}

ordered_json json_of(const registration::RegistrationSummary& registration) {
  return {{"reliable", registration.reliable},
          {"reasons", registration.reasons},
          {"points", registration.point_count},
          {"rms_mm", registration.has_pose ? ordered_json(registration.rms_mm) : ordered_json()},
          {"inlier_fraction",
           registration.has_pose ? ordered_json(registration.inlier_fraction) : ordered_json()},
          {"predicted_tre_mm",
           registration.has_pose ? ordered_json(registration.predicted_tre_mm) : ordered_json()}};
}

// What names a session or a day; for strangers it is empty, and null here.
ordered_json if_told(const std::string& value) {
  return value.empty() ? ordered_json() : ordered_json(value);
}

ordered_json json_of(const camera::CalibrationRecord& camera) {
  return {{"scope", if_told(camera.scope_name)},
          {"head", if_told(camera.head_name)},
          {"date_utc", if_told(camera.date_utc == kNotTold ? "" : camera.date_utc)},
          {"medium", camera::medium_to_text(camera.calibration.refractive_index)},
          {"rms_px", camera.rms_px >= 0 ? ordered_json(camera.rms_px) : ordered_json()},
          {"origin", provenance::to_text(camera.provenance.origin)}};
}

ordered_json others_of(const Content& content) {
  ordered_json all = ordered_json::array();
  for (const Content::Other& other : content.others) {
    ordered_json node = {{"id", if_told(other.session)}, {"bone", bones::to_text(other.bone)}};
    node["registration"] = other.registration ? json_of(*other.registration) : ordered_json();
    node["registration_is_broken"] = other.has_broken_registration;
    node["plans"] = other.plans;
    node["plan_warnings"] = other.plan_warnings;
    node["safety"] = ordered_json::object();
    for (const auto& row : rows_of(other.safety)) node["safety"][row[0]] = row[1];
    all.push_back(std::move(node));
  }
  return all;
}

ordered_json session_of(const Content& content) {
  if (!content.session) return nullptr;
  const recording::RecordedSession& session = *content.session;
  const recording::SessionHeader& header = session.header();
  const SessionFigures figures = figures_of(session);
  ordered_json node = {{"id", if_told(content.session_name)},
                       {"started_utc", if_told(content.started_utc)},
                       {"bone", bones::to_text(header.bone)},
                       {"side", bones::to_text(header.side)},
                       {"is_of_another_surface", content.is_of_another_surface},
                       {"source_kind", header.source_kind ? sources::to_text(*header.source_kind) : ""},
                       {"medium", camera::medium_to_text(header.refractive_index)},
                       {"was_finished", nullptr},
                       {"frames", figures.frames},
                       {"world_marker_tracked_percent", figures.world_percent},
                       {"lens_mark_found_percent", figures.mark_percent},
                       {"medium_contradicted_percent", figures.other_medium_percent},
                       {"is_as_recorded", nullptr},  // no hashes tell
                       {"record", recording::check_words(content.check)},
                       {"last_hash", content.last_hash}};
  if (session.was_finished() || session.problems().empty()) node["was_finished"] = session.was_finished();
  if (content.check.outcome != recording::SessionCheck::Outcome::NoChain)
    node["is_as_recorded"] = content.check.is_unbroken();
  node["camera"] = content.camera ? json_of(*content.camera) : ordered_json();
  node["registration"] = nullptr;
  if (content.registration) node["registration"] = json_of(*content.registration);
  if (!content.registration_problem.empty()) node["registration_problem"] = content.registration_problem;
  node["without_picture_s"] = figures.without_picture_s;
  node["source_faults"] = ordered_json::array();
  for (const SourceFault& fault : source_faults(session))
    node["source_faults"].push_back(
        {{"what", theatre::to_text(fault.trouble)}, {"from_s", fault.from_s}, {"for_s", fault.for_s}});
  node["plans"] = ordered_json::array();
  for (const PlanInForce& in_force : plans_in_force(session)) {
    ordered_json plan = {{"tunnel", tunnels::name_of(in_force.plan.tunnel.key())},
                         {"since_s", in_force.since_s}};
    plan.update(tunnels::to_json(in_force.plan.tunnel));
    plan["length_mm"] = in_force.plan.length_mm;
    node["plans"].push_back(std::move(plan));
  }
  node["plan_warnings"] = plan_warnings(session, content);
  node["safety"] = ordered_json::object();
  for (const auto& row : rows_of(content.safety)) node["safety"][row[0]] = row[1];
  node["steps"] = ordered_json::array();
  for (const Step& step : steps_of(session))
    node["steps"].push_back({{"time_s", step.time_s}, {"what", step.words}});
  node["marks"] = ordered_json::array();
  for (const recording::SessionMark& mark : content.marks)
    node["marks"].push_back(
        {{"time_s", time_s(session, mark.timestamp_ns)}, {"frame", mark.frame}, {"note", mark.note}});
  if (!content.marks_problem.empty()) node["marks_problem"] = content.marks_problem;
  return node;
}

ordered_json json_of(const Content& content, const operation::AchievedTunnel& achieved,
                     ordered_json session) {
  ordered_json node = {{"tunnel", tunnels::name_of(achieved.planned.key())}, {"session", std::move(session)}};
  node["planned"] = tunnels::to_json(achieved.planned);
  node["measured"] = tunnels::to_json(achieved.measured);
  node["difference"] = json_of(operation::compare(achieved.planned, achieved.measured));
  if (const auto place = place_of(content, achieved)) postop::put_place(node, *place);
  node["depth_mm"] = nullptr;
  if (achieved.depth_mm) node["depth_mm"] = *achieved.depth_mm;
  node["sigma_offset_mm"] = achieved.sigma_offset_mm;
  node["sigma_angle_deg"] = achieved.sigma_angle_deg;
  node["poses"] = achieved.pose_count;
  if (achieved.truth) {
    node["truth"] = tunnels::to_json(*achieved.truth);
    node["difference_of_truth"] = json_of(operation::compare(achieved.planned, *achieved.truth));
  }
  return node;
}

// Numbers of what was not found, or is not known, are null.
ordered_json postoperative_of(const Content& content) {
  ordered_json all = ordered_json::array();
  const std::vector<TunnelResult> results = results_of(content);
  for (const auto& [key, comparison] : content.postoperative) {
    const postop::AchievedTunnel& found = comparison.tunnel;
    const auto number = [&](double value) {
      return found.is_found && std::isfinite(value) ? ordered_json(value) : ordered_json();
    };
    const postop::ComparisonVerdict verdict = verdict_of(content, key);
    ordered_json node = {{"tunnel", tunnels::name_of(key)}, {"verdict", to_text(verdict)}};
    node["reliable"] = verdict == postop::ComparisonVerdict::Reliable;
    node["reasons"] = doubts_of(content, key);
    node["reliable_quantities"] = ordered_json::array();
    if (verdict != postop::ComparisonVerdict::OfAnEarlierPlan)
      for (const tunnels::Quantity quantity : relied_on(comparison))
        node["reliable_quantities"].push_back(tunnels::to_text(quantity));
    if (!comparison.kept_because.empty()) node["kept_because"] = comparison.kept_because;
    node["planned"] = nullptr;
    // Of an earlier plan the differences alone are known, not what they are from.
    if (const auto plan = content.knee.plan.tunnels.find(key);
        plan != content.knee.plan.tunnels.end() && verdict != postop::ComparisonVerdict::OfAnEarlierPlan)
      node["planned"] = tunnels::to_json(plan->second);
    node["achieved"] = nullptr;
    if (found.is_found) node["achieved"] = tunnels::to_json(found.tunnel);
    node["offset_mm"] = number(found.offset_mm);
    node["offset_across_mm"] = number(found.offset_across_mm);
    node["angle_deg"] = number(geometry::deg_from_rad(found.angle_rad));
    node["length_mm"] = number(found.length_mm);
    node["comes_out"] = found.is_found ? ordered_json(found.comes_out) : ordered_json();
    node["end_is_seen"] = found.is_found ? ordered_json(found.end_is_seen) : ordered_json();
    node["beyond_mm"] = number(found.beyond_mm);
    node["entry_sigma_mm"] = number(found.entry_sigma_mm);
    node["direction_sigma_deg"] = number(geometry::deg_from_rad(found.direction_sigma_rad));
    node["diameter_sigma_mm"] = number(found.diameter_sigma_mm);
    node["length_sigma_mm"] = number(found.length_sigma_mm);
    node["metal_share"] = number(found.metal_share);
    node["widths"] = ordered_json::array();
    for (const postop::Width& width : found.widths)
      node["widths"].push_back({{"from_entry_mm", width.from_entry_mm}, {"diameter_mm", width.diameter_mm}});
    if (const auto place = content.places.find(key); place != content.places.end()) {
      postop::put_place(node, place->second);
      if (verdict == postop::ComparisonVerdict::Reliable && postop::is_wall_known(place->second))
        node["reliable_quantities"].push_back("wall");
    }
    node["off_navigation"] = nullptr;  // what was drilled, by the CT, from what navigation measured
    for (const TunnelResult& result : results)
      if (result.key == key && result.navigated_to_imaged)
        node["off_navigation"] = {{"entry_mm", result.navigated_to_imaged->entry_mm},
                                  {"axis_to_entry_mm", result.navigated_to_imaged->axis_to_entry_mm},
                                  {"angle_deg", result.navigated_to_imaged->angle_deg}};
    node["bone_rms_mm"] = comparison.bone.is_found ? ordered_json(comparison.bone.rms_mm) : ordered_json();
    all.push_back(std::move(node));
  }
  return all;
}

ordered_json document_of(const Content& content, const ReportOptions& options) {
  ordered_json json;
  json["format"] = "arthronaut.report";
  json["version"] = 1;
  if (!options.made_utc.empty() && !options.is_deidentified) json["made_utc"] = options.made_utc;
  json["case"] = {{"name", content.knee.name},
                  {"side", bones::to_text(content.knee.side)},
                  {"created_utc", if_told(content.knee.created_utc)}};
  if (content.identity)
    json["patient"] = {{"name", content.identity->patient_name},
                       {"id", content.identity->patient_id},
                       {"birth_date", content.identity->birth_date}};
  json["bone_doubts"] = ordered_json::object();
  for (const auto& [kind, doubts] : content.bone_doubts)
    json["bone_doubts"][std::string(bones::to_text(kind))] = words_of(doubts);
  json["proposed_landmarks"] = ordered_json::array();  // bones whose grid and axes follow from such
  for (const auto& [kind, bone] : content.knee.bones)
    if (content.review->has_bone(kind) && content.review->bone(kind).surroundings.has_grid() &&
        plan_review::grid_state(content.knee, kind) == landmarks::GridState::Proposed)
      json["proposed_landmarks"].push_back(bones::to_text(kind));
  json["plan_sha256"] = cases::plan_sha256(cases::with_named_meshes(content.knee));
  json["tunnels"] = tunnels_of(content);
  json["session"] = session_of(content);
  json["other_sessions"] = others_of(content);
  const auto put = [&json](const char* name, const auto& sessions) {
    json[name] = ordered_json::array();
    for (const auto& [session, reason] : sessions)
      json[name].push_back({{"id", if_told(session)}, {"reason", if_told(reason)}});
  };
  put("unreadable_sessions", content.unreadable);
  put("damaged_sessions", content.damaged);
  json["achieved"] = ordered_json::array();
  for (const operation::AchievedTunnel& achieved : content.achieved)
    json["achieved"].push_back(json_of(content, achieved, if_told(content.session_name)));
  for (const Content::Earlier& earlier : content.earlier)
    json["achieved"].push_back(json_of(content, earlier.achieved, if_told(earlier.session)));
  json["drilled_by_word"] = ordered_json::array();
  for (const Content::ByWord& said : content.by_word)
    json["drilled_by_word"].push_back(
        {{"tunnel", said.tunnel}, {"session", if_told(said.session)}, {"reason", said.why}});
  json["postoperative"] = postoperative_of(content);
  if (!content.postoperative_problem.empty()) json["postoperative_problem"] = content.postoperative_problem;
  json["versions"] = ordered_json::object();
  for (const auto& [name, version] : versions()) json["versions"][name] = version;
  json["note"] = "research software, not a medical device";
  return json;
}

void add_rows(const ordered_json& node, const std::string& path, std::string& text) {
  if (node.is_structured()) {
    for (const auto& [key, value] : node.items())
      add_rows(value, path.empty() ? key : path + "/" + key, text);
    return;
  }
  const std::string value = node.is_null()     ? ""
                            : node.is_string() ? files::csv_cell(node.get<std::string>())
                                               : node.dump();
  text += files::csv_cell(path) + "," + value + "\n";
}

}  // namespace

std::string report_json(const Content& content, const ReportOptions& options) {
  return document_of(content, options).dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

std::string report_csv(const Content& content, const ReportOptions& options) {
  std::string text = "quantity,value\n";
  add_rows(document_of(content, options), "", text);
  return text;
}

}  // namespace arthronaut::report
