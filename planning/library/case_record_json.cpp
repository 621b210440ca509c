#include "planning/library/case_record_json.h"

#include <nlohmann/json.hpp>

namespace arthronaut::library {

namespace {

using nlohmann::json;
using nlohmann::ordered_json;

template <class T>
void put(ordered_json& node, const char* key, const std::optional<T>& value) {
  if (value) node[key] = *value;
}

template <class T>
void take(const json& node, const char* key, std::optional<T>& value) {
  if (const auto found = node.find(key); found != node.end()) value = found->get<T>();
}

ordered_json kinds_to_json(const std::set<bones::BoneKind>& kinds) {
  auto names = ordered_json::array();
  for (const bones::BoneKind kind : kinds) names.push_back(bones::to_text(kind));
  return names;
}

std::set<bones::BoneKind> kinds_from(const json& names) {
  std::set<bones::BoneKind> kinds;
  for (const auto& name : names) kinds.insert(bones::bone_kind_from_text(name.get<std::string>()));
  return kinds;
}

std::optional<bones::BoneKind> bone_from(const json& node) {
  const std::string word = node.at("bone");
  return word.empty() ? std::nullopt : std::optional(bones::bone_kind_from_text(word));
}

ordered_json to_json(const SessionFacts& facts) {
  ordered_json node = {{"id", facts.id},
                       {"started_utc", facts.started_utc},
                       {"bone", word_of(facts.bone)},
                       {"source_kind", facts.source_kind},
                       {"finished", facts.was_finished},
                       {"verified", facts.was_verified},
                       {"alarms", facts.alarm_count},
                       {"outcome", facts.outcome()}};
  put(node, "registration_reliable", facts.registration_is_reliable);
  put(node, "registration_rms_mm", facts.registration_rms_mm);
  put(node, "predicted_tre_mm", facts.predicted_error_mm);
  put(node, "length_min", facts.length_min);
  put(node, "entry_offset_mm", facts.entry_offset_mm);
  put(node, "angle_deg", facts.angle_deg);
  put(node, "depth_mm", facts.depth_mm);
  put(node, "registering_min", facts.registering_min);
  put(node, "verifying_min", facts.verifying_min);
  put(node, "drilling_min", facts.drilling_min);
  if (!facts.problem.empty()) node["problem"] = facts.problem;
  if (facts.is_being_recorded) node["being_recorded"] = true;
  if (facts.is_drilled_by_word) node["drilled_by_word"] = true;
  return node;
}

SessionFacts session_from(const json& node) {
  SessionFacts facts;
  facts.id = node.at("id");
  facts.started_utc = node.at("started_utc");
  facts.bone = bone_from(node);
  facts.source_kind = node.at("source_kind");
  facts.was_finished = node.at("finished");
  facts.was_verified = node.at("verified");
  facts.alarm_count = node.at("alarms");
  take(node, "registration_reliable", facts.registration_is_reliable);
  take(node, "registration_rms_mm", facts.registration_rms_mm);
  take(node, "predicted_tre_mm", facts.predicted_error_mm);
  take(node, "length_min", facts.length_min);
  take(node, "entry_offset_mm", facts.entry_offset_mm);
  take(node, "angle_deg", facts.angle_deg);
  take(node, "depth_mm", facts.depth_mm);
  take(node, "registering_min", facts.registering_min);
  take(node, "verifying_min", facts.verifying_min);
  take(node, "drilling_min", facts.drilling_min);
  facts.problem = node.value("problem", std::string());
  facts.is_being_recorded = node.value("being_recorded", false);
  facts.is_drilled_by_word = node.value("drilled_by_word", false);
  return facts;
}

ordered_json to_json(const PostoperativeFacts& facts) {
  ordered_json node = {{"bone", bones::to_text(facts.tunnel.bone)}, {"reliable", facts.is_reliable}};
  if (facts.tunnel.bundle != norms::Bundle::Whole) node["bundle"] = norms::to_text(facts.tunnel.bundle);
  put(node, "entry_offset_mm", facts.entry_offset_mm);
  put(node, "angle_deg", facts.angle_deg);
  put(node, "diameter_mm", facts.diameter_mm);
  if (facts.known.empty()) return node;
  for (const tunnels::Quantity quantity : facts.known)
    node["reliable_quantities"].push_back(tunnels::to_text(quantity));
  return node;
}

PostoperativeFacts postoperative_from(const json& node) {
  PostoperativeFacts facts;
  facts.tunnel = {bones::bone_kind_from_text(node.at("bone").get<std::string>()),
                  norms::bundle_from_text(node.value("bundle", "single"))};
  facts.is_reliable = node.at("reliable");
  take(node, "entry_offset_mm", facts.entry_offset_mm);
  take(node, "angle_deg", facts.angle_deg);
  take(node, "diameter_mm", facts.diameter_mm);
  for (const json& name : node.value("reliable_quantities", json::array()))
    if (const auto quantity = tunnels::quantity_from_text(name.get<std::string>()))
      facts.known.insert(*quantity);
  return facts;
}

}  // namespace

ordered_json to_json(const CaseRecord& record) {
  ordered_json node = {{"folder", record.folder.string()},
                       {"name", record.name},
                       {"side", word_of(record.side)},
                       {"state", to_text(record.state())},
                       {"there", record.is_there},
                       {"created_utc", record.created_utc},
                       {"changed_utc", record.changed_utc},
                       {"bones", kinds_to_json(record.bones)},
                       {"planned", kinds_to_json(record.planned)},
                       {"note", record.note},
                       {"last_outcome", record.last_outcome()}};
  if (!record.problem.empty()) node["problem"] = record.problem;
  if (!record.part_problem.empty()) node["part_problem"] = record.part_problem;
  node["sessions"] = ordered_json::array();
  for (const SessionFacts& facts : record.sessions) node["sessions"].push_back(to_json(facts));
  node["postoperative"] = ordered_json::array();
  for (const PostoperativeFacts& facts : record.postoperative)
    node["postoperative"].push_back(to_json(facts));
  return node;
}

CaseRecord record_from(const json& node) {
  CaseRecord record;
  record.folder = node.at("folder").get<std::string>();
  record.is_there = node.at("there");
  record.problem = node.value("problem", std::string());
  record.part_problem = node.value("part_problem", std::string());
  record.name = node.at("name");
  if (const std::string side = node.at("side"); !side.empty()) record.side = bones::side_from_text(side);
  record.created_utc = node.at("created_utc");
  record.changed_utc = node.at("changed_utc");
  record.bones = kinds_from(node.at("bones"));
  record.planned = kinds_from(node.at("planned"));
  record.note = node.at("note");
  for (const auto& one : node.at("sessions")) record.sessions.push_back(session_from(one));
  for (const auto& one : node.at("postoperative")) record.postoperative.push_back(postoperative_from(one));
  return record;
}

}  // namespace arthronaut::library
