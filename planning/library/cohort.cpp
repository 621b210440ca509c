#include "planning/library/cohort.h"

#include <nlohmann/json.hpp>

#include "planning/files/csv_cell.h"
#include "planning/files/format.h"
#include "planning/files/json_document.h"
#include "planning/geometry/error.h"
#include "planning/library/case_record_json.h"

namespace arthronaut::library {

namespace {

constexpr const char* kColumns =
    "case,folder,side,state,created_utc,changed_utc,femur_planned,tibia_planned,session,started_utc,bone,"
    "source_kind,outcome,finished,registration_reliable,registration_rms_mm,predicted_tre_mm,verified,"
    "alarms,entry_offset_mm,angle_deg,depth_mm,registering_min,verifying_min,drilling_min,"
    "femur_postop_offset_mm,femur_postop_angle_deg,femur_postop_reliable,femur_postop_reliable_quantities,"
    "tibia_postop_offset_mm,tibia_postop_angle_deg,tibia_postop_reliable,tibia_postop_reliable_quantities,"
    "femur_am_postop_offset_mm,femur_am_postop_angle_deg,femur_am_postop_reliable,"
    "femur_am_postop_reliable_quantities,femur_pl_postop_offset_mm,femur_pl_postop_angle_deg,"
    "femur_pl_postop_reliable,femur_pl_postop_reliable_quantities,tibia_am_postop_offset_mm,"
    "tibia_am_postop_angle_deg,tibia_am_postop_reliable,tibia_am_postop_reliable_quantities,"
    "tibia_pl_postop_offset_mm,tibia_pl_postop_angle_deg,tibia_pl_postop_reliable,"
    "tibia_pl_postop_reliable_quantities,note,problem";

std::string cell(std::string text) { return files::csv_cell(std::move(text)); }
std::string cell(const std::optional<double>& number) {
  return number ? files::format("%.3f", *number) : std::string();
}
std::string cell(bool yes) { return yes ? "yes" : "no"; }
std::string cell(const std::optional<bool>& yes) { return yes ? cell(*yes) : std::string(); }

class Row {
 public:
  template <class T>
  Row& add(const T& value) {
    text_ += (is_begun_ ? "," : "") + cell(value);
    is_begun_ = true;
    return *this;
  }
  Row& add_empty(int count) {
    text_ += std::string(static_cast<std::size_t>(count), ',');
    return *this;
  }
  [[nodiscard]] std::string line() const { return text_ + "\n"; }

 private:
  std::string text_;
  bool is_begun_ = false;
};

void add_session(Row& row, const SessionFacts& session) {
  row.add(session.id).add(session.started_utc).add(word_of(session.bone)).add(session.source_kind);
  row.add(session.outcome()).add(session.was_finished).add(session.registration_is_reliable);
  row.add(session.registration_rms_mm).add(session.predicted_error_mm).add(session.was_verified);
  row.add(std::to_string(session.alarm_count)).add(session.entry_offset_mm).add(session.angle_deg);
  row.add(session.depth_mm).add(session.registering_min).add(session.verifying_min);
  row.add(session.drilling_min);
}
constexpr int kSessionColumns = 17;

void add_postoperative(Row& row, const CaseRecord& record, const tunnels::TunnelKey& tunnel) {
  for (const PostoperativeFacts& facts : record.postoperative) {
    if (facts.tunnel != tunnel) continue;
    row.add(facts.entry_offset_mm).add(facts.angle_deg).add(facts.is_reliable);
    row.add(in_words(facts.is_reliable ? tunnels::all_quantities() : facts.known));
    return;
  }
  row.add_empty(4);
}

std::string row_of(const CaseRecord& record, const SessionFacts* session, const Identities* identities) {
  Row row;
  row.add(record.name).add(record.folder.string()).add(word_of(record.side));
  row.add(std::string(to_text(record.state()))).add(record.created_utc).add(record.changed_utc);
  row.add(record.planned.contains(bones::BoneKind::Femur));
  row.add(record.planned.contains(bones::BoneKind::Tibia));
  if (session != nullptr)
    add_session(row, *session);
  else
    row.add_empty(kSessionColumns);
  using bones::BoneKind;
  using norms::Bundle;
  for (const BoneKind bone : {BoneKind::Femur, BoneKind::Tibia}) add_postoperative(row, record, bone);
  for (const BoneKind bone : {BoneKind::Femur, BoneKind::Tibia})
    for (const Bundle bundle : {Bundle::Anteromedial, Bundle::Posterolateral})
      add_postoperative(row, record, {bone, bundle});
  row.add(record.note)
      .add(session != nullptr && !session->problem.empty() ? session->problem
           : !record.problem.empty()                       ? record.problem
                                                           : record.part_problem);
  if (identities != nullptr) {
    const auto found = identities->find(record.folder);
    const cases::Identity identity = found != identities->end() ? found->second : cases::Identity{};
    row.add(identity.patient_name).add(identity.patient_id).add(identity.birth_date);
  }
  return row.line();
}

}  // namespace

Identities read_identities(std::span<const CaseRecord> records) {
  Identities identities;
  for (const CaseRecord& record : records) {
    if (!record.is_there) continue;
    try {
      if (const auto identity = cases::load_identity(record.folder)) identities[record.folder] = *identity;
    } catch (const InvalidInput&) {  // the header says so
    } catch (const IoError&) {
    }
  }
  return identities;
}

void write_cases_json(const std::filesystem::path& file, std::span<const CaseRecord> records,
                      const Identities* identities, const PlanVerdicts& verdicts) {
  nlohmann::ordered_json document = {{"format", "arthronaut.cases"}, {"version", 1}};
  document["cases"] = nlohmann::ordered_json::array();
  for (const CaseRecord& record : records) {
    auto node = to_json(record);
    if (const auto checked = verdicts.find(record.folder); checked != verdicts.end())
      node["plan_verdict"] = {{"worst", to_text(checked->second.worst())},
                              {"wrong", checked->second.wrong},
                              {"look", checked->second.look}};
    const bool is_named = identities != nullptr && identities->contains(record.folder);
    if (const auto* found = is_named ? &identities->at(record.folder) : nullptr)
      node["identity"] = {{"patient_name", found->patient_name},
                          {"patient_id", found->patient_id},
                          {"birth_date", found->birth_date}};
    document["cases"].push_back(std::move(node));
  }
  files::write_json(file, document);
}

std::string cohort_csv(std::span<const CaseRecord> records, const Identities* identities) {
  std::string text = kColumns;
  text += identities == nullptr ? "\n" : ",patient_name,patient_id,birth_date\n";
  for (const CaseRecord& record : records) {
    if (record.sessions.empty()) text += row_of(record, nullptr, identities);
    for (const SessionFacts& session : record.sessions) text += row_of(record, &session, identities);
  }
  return text;
}

}  // namespace arthronaut::library
