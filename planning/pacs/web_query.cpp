#include "planning/pacs/web_query.h"

#include <algorithm>
#include <charconv>
#include <chrono>
#include <map>

#include "planning/geometry/error.h"
#include "planning/pacs/checks.h"

namespace arthronaut::pacs {

namespace {

using nlohmann::json;

// 100,000 images of some 600 bytes each.
constexpr std::int64_t kLargestList_bytes = 64 * 1024 * 1024;
constexpr int kMostSeriesOfAStudy = 10000, kMostSeries = 100000, kMostImages = 100000;

// DICOM's JSON has this depth at most in what is asked for; a deeper one is no answer.
bool is_too_deep(int depth, json::parse_event_t event, json& /*parsed*/) {
  constexpr int kDeepest = 32;
  if (depth > kDeepest &&
      (event == json::parse_event_t::object_start || event == json::parse_event_t::array_start))
    throw DeviceError("is nested too deeply");
  return true;
}

void append(std::string& query, const char* key, const std::string& value) {
  if (value.empty()) return;
  query += (query.empty() ? "?" : "&") + std::string(key) + "=" + url_encoded(value);
}

int count_of(const json& object, const char* tag) {
  const std::string text = web_text(object, tag);
  int value = -1;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size() && value >= 0 ? value : -1;
}

std::vector<std::string> texts_of(const json& object, const char* tag) {
  std::vector<std::string> texts;
  if (!object.contains(tag) || !object[tag].is_object() || !object[tag].contains("Value")) return texts;
  for (const json& value : object[tag]["Value"])
    if (value.is_string()) texts.push_back(value.get<std::string>());
  return texts;
}

FoundStudy study_of(const json& object) {
  FoundStudy study;
  study.uid = web_text(object, "0020000D");
  study.date = web_text(object, "00080020");
  study.time = web_text(object, "00080030");
  study.description = web_text(object, "00081030");
  study.accession_number = web_text(object, "00080050");
  study.modalities = texts_of(object, "00080061");
  study.series_count = count_of(object, "00201206");
  study.image_count = count_of(object, "00201208");
  return study;
}

FoundSeries series_of(const json& object) {
  FoundSeries series;
  series.uid = web_text(object, "0020000E");
  series.number = web_text(object, "00200011");
  series.modality = web_text(object, "00080060");
  series.description = web_text(object, "0008103E");
  series.body_part = web_text(object, "00180015");
  series.date = web_text(object, "00080021");
  series.image_count = count_of(object, "00201209");
  return series;
}

// False when stopped.
bool add_series(HttpClient& client, const FindKeys& keys, int most, bool& is_cut, FoundStudy& study) {
  if (!is_uid(study.uid)) client.fail("names a study by what is no UID");
  std::string query;
  append(query, "Modality", keys.modality);
  append(query, "limit", std::to_string(std::min(most, kMostSeriesOfAStudy) + 1));
  for (const char* tag : {"0008103E", "00180015", "00080021", "00201209"}) append(query, "includefield", tag);
  bool was_stopped = false;
  for (const json& object : web_objects(client, "/studies/" + study.uid + "/series" + query, was_stopped))
    study.series.push_back(series_of(object));
  const auto room = static_cast<std::size_t>(std::min(most, kMostSeriesOfAStudy));
  if (study.series.size() > room) {
    study.series.resize(room);
    is_cut = true;
  }
  std::sort(study.series.begin(), study.series.end(), [](const FoundSeries& a, const FoundSeries& b) {
    return std::pair(a.number.size(), a.number + a.uid) < std::pair(b.number.size(), b.number + b.uid);
  });
  return !was_stopped;
}

HttpAnswer answer_to_search(HttpClient& client, const std::string& path) {
  return client.perform({.path = path,
                         .accept = "application/dicom+json",
                         .most_bytes = kLargestList_bytes,
                         .complaint = "answers a search with more than 64 MB"});
}

json objects_in(HttpClient& client, const HttpAnswer& answer) {
  if (answer.was_stopped || answer.status == 204) return json::array();
  if (answer.status == 404) client.fail("has no DICOMweb search there (HTTP 404)");
  if (answer.status != 200) client.fail("answers a search with HTTP " + std::to_string(answer.status));
  json objects;
  std::string reason;
  try {  // the library's exception is none of ours
    objects = json::parse(answer.body, is_too_deep);
  } catch (const json::exception&) {
    reason = "answers a search with what is no JSON";
  } catch (const DeviceError& error) {
    reason = std::string("answers a search with JSON that ") + error.what();
  }
  if (reason.empty() && !objects.is_array()) reason = "answers a search with what is no list";
  if (!reason.empty()) client.fail(reason);
  for (const json& object : objects)
    if (!object.is_object()) client.fail("lists what is no object");
  return objects;
}

// Servers end a list at a maximum of theirs, whatever limit is asked for: the rest is asked for page by page,
// until all that the server counts is listed, or a page brings nothing new. One that refuses pages has none.
void list_images(HttpClient& client, const std::string& path, SeriesImages& found) {
  std::size_t offset = 0;
  for (bool is_new = true; is_new;) {
    const std::string page = offset > 0 ? "&offset=" + std::to_string(offset) : "";
    const HttpAnswer answer = answer_to_search(client, path + page);
    found.was_stopped = answer.was_stopped;
    const bool is_no_page = offset > 0 && answer.status >= 400 && answer.status < 500;
    if (found.was_stopped || is_no_page) return;
    is_new = offset == 0;
    const json objects = objects_in(client, answer);
    for (const json& object : objects) {
      const std::string uid = web_text(object, "00080018");
      if (is_uid(uid))
        is_new |= found.class_by_uid.insert_or_assign(uid, web_text(object, "00080016")).second;
      else if (offset == 0)
        ++found.nameless_count;
    }
    if (found.class_by_uid.size() > kMostImages) client.fail("lists more than 100000 images for one series");
    if (static_cast<int>(found.class_by_uid.size()) == found.said_count) return;
    offset += objects.size();
  }
}

}  // namespace

std::string web_text(const json& object, const char* tag) {
  if (!object.contains(tag) || !object[tag].is_object() || !object[tag].contains("Value")) return "";
  const json& values = object[tag]["Value"];
  if (!values.is_array() || values.empty()) return "";
  const json& value = values.front();
  if (value.is_string()) return value.get<std::string>();
  if (value.is_number_integer()) return std::to_string(value.get<std::int64_t>());
  if (value.is_object() && value.contains("Alphabetic") && value["Alphabetic"].is_string())
    return value["Alphabetic"].get<std::string>();
  return "";
}

json web_objects(HttpClient& client, const std::string& path, bool& was_stopped) {
  const HttpAnswer answer = answer_to_search(client, path);
  was_stopped = answer.was_stopped;
  return objects_in(client, answer);
}

double echo(const WebServer& server, const ConnectionOptions& connection, const std::stop_token& stop) {
  HttpClient client(server, connection, stop);
  const auto before = std::chrono::steady_clock::now();
  bool was_stopped = false;
  (void)web_objects(client, "/studies?limit=1", was_stopped);
  const std::chrono::duration<double, std::milli> taken = std::chrono::steady_clock::now() - before;
  return was_stopped ? -1 : taken.count();
}

FindSummary find(const WebServer& server, const ConnectionOptions& connection, const FindKeys& keys,
                 const FindOptions& options, const std::stop_token& stop) {
  check(keys, options);
  HttpClient client(server, connection, stop);
  std::string query;
  append(query, "PatientID", keys.patient_id);
  append(query, "PatientName", keys.patient_name);
  append(query, "AccessionNumber", keys.accession_number);
  append(query, "StudyDate", keys.study_date);
  append(query, "StudyInstanceUID", keys.study_uid);
  append(query, "ModalitiesInStudy", keys.modality);
  append(query, "limit", std::to_string(options.most_studies + 1));
  for (const char* tag : {"00081030", "00080061", "00100030", "00100040", "00201206", "00201208"})
    append(query, "includefield", tag);
  FindSummary summary;
  std::map<std::pair<std::string, std::string>, FoundPatient> patients;
  int count = 0, series_left = kMostSeries;
  for (const json& object : web_objects(client, "/studies" + query, summary.was_stopped)) {
    if (++count > options.most_studies) {
      summary.is_cut = true;
      break;
    }
    const std::string name = web_text(object, "00100010"), id = web_text(object, "00100020");
    FoundPatient& patient = patients[{name, id}];
    patient.name = name;
    patient.id = id;
    patient.birth_date = web_text(object, "00100030");
    patient.sex = web_text(object, "00100040");
    patient.studies.push_back(study_of(object));
  }
  for (auto& [key, patient] : patients) {
    patient.study_count = static_cast<int>(patient.studies.size());
    std::sort(patient.studies.begin(), patient.studies.end(), [](const FoundStudy& a, const FoundStudy& b) {
      return std::tuple(b.date, b.time, b.uid) < std::tuple(a.date, a.time, a.uid);
    });
    if (options.level == FindLevel::Series) {
      for (FoundStudy& study : patient.studies) {
        if (summary.was_stopped) break;
        summary.was_stopped = !add_series(client, keys, series_left, summary.is_cut, study);
        series_left -= static_cast<int>(study.series.size());
      }
      if (!keys.modality.empty())
        std::erase_if(patient.studies, [](const FoundStudy& study) { return study.series.empty(); });
    }
    if (options.level == FindLevel::Patient) patient.studies.clear();
    if (options.level == FindLevel::Patient || !patient.studies.empty())
      summary.patients.push_back(std::move(patient));
  }
  return summary;
}

SeriesImages ask_web_series_images(HttpClient& client, const std::string& series_uid,
                                   const std::string& study_uid) {
  SeriesImages found;
  std::string query;
  append(query, "SeriesInstanceUID", series_uid);
  for (const char* tag : {"00100020", "00201209"}) append(query, "includefield", tag);
  const std::string series = study_uid.empty() ? "/series" : "/studies/" + study_uid + "/series";
  for (const json& object : web_objects(client, series + query, found.was_stopped)) {
    if (web_text(object, "0020000E") != series_uid) continue;
    found.is_known = true;
    found.study_uid = web_text(object, "0020000D");
    found.patient_id = web_text(object, "00100020");
    found.said_count = std::max(found.said_count, count_of(object, "00201209"));
  }
  if (found.study_uid.empty()) found.study_uid = study_uid;
  if (!found.is_known || found.was_stopped) return found;
  if (!is_uid(found.study_uid)) client.fail("does not say which study the series is of; name it");
  const std::string path = "/studies/" + found.study_uid + "/series/" + series_uid +
                           "/instances?limit=" + std::to_string(kMostImages + 1);
  list_images(client, path, found);
  if (found.nameless_count > 0)
    client.fail("lists " + std::to_string(found.nameless_count) +
                " images of the series without a valid UID");
  return found;
}

}  // namespace arthronaut::pacs
