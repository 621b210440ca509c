#include "app/command_line/pacs_report.h"

#include <nlohmann/json.hpp>

#include "planning/cases/identity.h"

namespace arthronaut::command_line {

namespace {

using Json = nlohmann::ordered_json;

Json document(const char* format, const std::string& where) {
  return {{"format", format}, {"version", 1}, {"peer", where}};
}

// What the peer did not say is null.
Json count(int value) { return value >= 0 ? Json(value) : Json(nullptr); }

// A vendor that declares one character set and writes another leaves bytes that are no UTF-8.
Json text(const std::string& value) {
  const Json as_is(value);
  const std::string valid = as_is.dump(-1, ' ', false, Json::error_handler_t::replace);
  return Json::parse(valid);
}

Json json_of(const pacs::FoundSeries& series) {
  return {{"uid", series.uid},
          {"number", text(series.number)},
          {"modality", text(series.modality)},
          {"description", text(series.description)},
          {"body_part", text(series.body_part)},
          {"date", text(series.date)},
          {"images", count(series.image_count)}};
}

Json json_of(const pacs::FoundStudy& study) {
  Json series = Json::array(), modalities = Json::array();
  for (const auto& one : study.series) series.push_back(json_of(one));
  for (const auto& one : study.modalities) modalities.push_back(text(one));
  return {{"uid", study.uid},
          {"date", text(study.date)},
          {"time", text(study.time)},
          {"description", text(study.description)},
          {"accession_number", text(study.accession_number)},
          {"modalities", std::move(modalities)},
          {"series_count", count(study.series_count)},
          {"images", count(study.image_count)},
          {"series", std::move(series)}};
}

std::string with_count(int count, const char* one, const char* many) {
  if (count < 0) return std::string("? ") + many;
  return std::to_string(count) + " " + (count == 1 ? one : many);
}

std::string quoted(const std::string& text) { return text.empty() ? "" : " \"" + text + "\""; }

}  // namespace

Json json_of(const std::string& where, const pacs::FindSummary& found) {
  Json all = document("arthronaut.pacs_find", where);
  all["complete"] = !found.is_cut && !found.was_stopped;
  all["patients"] = Json::array();
  for (const auto& patient : found.patients) {
    Json studies = Json::array();
    for (const auto& study : patient.studies) studies.push_back(json_of(study));
    all["patients"].push_back({{"id", text(patient.id)},
                               {"name", text(patient.name)},
                               {"birth_date", text(patient.birth_date)},
                               {"sex", text(patient.sex)},
                               {"study_count", patient.study_count},
                               {"studies", std::move(studies)}});
  }
  return all;
}

std::vector<std::string> lines_of(const pacs::FindSummary& found) {
  std::vector<std::string> lines;
  for (const auto& patient : found.patients) {
    const std::string born =
        cases::Identity{patient.name, patient.id, patient.birth_date}.birth_date_in_words();
    lines.push_back((patient.name.empty() ? "no name" : patient.name) +
                    (patient.id.empty() ? ", no ID" : ", ID " + patient.id) +
                    (born.empty() ? "" : ", born " + born) + (patient.sex.empty() ? "" : ", " + patient.sex) +
                    ": " + with_count(patient.study_count, "study", "studies"));
    for (const auto& study : patient.studies) {
      std::string modalities;
      for (const auto& modality : study.modalities) modalities += " " + modality;
      const std::string date = cases::date_in_words(study.date);
      lines.push_back("  " + (date.empty() ? "undated" : date) + modalities + quoted(study.description) +
                      ": " + with_count(study.series_count, "series", "series") + ", " +
                      with_count(study.image_count, "image", "images"));
      lines.push_back("    study UID " + study.uid);
      for (const auto& series : study.series) {
        lines.push_back("    " + series.modality + " series " + series.number + quoted(series.description) +
                        ": " + with_count(series.image_count, "image", "images"));
        lines.push_back("      UID " + series.uid);
      }
    }
  }
  return lines;
}

Json json_of(const std::string& where, const std::string& series_uid, const std::string& folder,
             const pacs::RetrieveSummary& summary) {
  Json all = document("arthronaut.pacs_get", where);
  all["series_uid"] = series_uid;
  all["study_uid"] = summary.study_uid;
  all["folder"] = folder;
  all["images"] = summary.image_count;
  all["images_there_before"] = summary.kept_count;
  all["received_bytes"] = summary.received_bytes;
  all["way"] = summary.way;
  return all;
}

Json json_of(const std::string& where, const pacs::SendSummary& summary) {
  Json all = document("arthronaut.pacs_send", where);
  all["stored"] = summary.is_usable();
  all["commitment"] = pacs::to_text(summary.commitment);
  all["commitment_note"] = text(summary.commitment_note);
  if (!summary.failure.empty()) all["failure"] = text(summary.failure);
  all["files"] = Json::array();
  for (const auto& file : summary.files)
    all["files"].push_back({{"file", file.file.string()},
                            {"sop_class_uid", file.sop_class_uid},
                            {"sop_instance_uid", file.sop_instance_uid},
                            {"stored", file.is_stored},
                            {"committed", file.is_committed},
                            {"note", text(file.note)}});
  return all;
}

}  // namespace arthronaut::command_line
