#include "planning/pacs/query.h"

#include <algorithm>
#include <chrono>
#include <map>

#include "planning/geometry/error.h"
#include "planning/images/dicom_file.h"
#include "planning/pacs/association.h"
#include "planning/pacs/checks.h"
#include "planning/pacs/finding.h"

namespace arthronaut::pacs {

namespace {

using images::text_of;
using images::utf8_text_of;

constexpr int kMostSeriesOfAStudy = 10000, kMostSeries = 100000;

std::vector<std::string> values_of(const std::string& text) {
  std::vector<std::string> values;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\\', at), text.size());
    if (end > at) values.push_back(text.substr(at, end - at));
    at = end + 1;
  }
  return values;
}

// A PACS that does not know who calls takes some at their word, and ends the connection when they ask.
[[noreturn]] void fail(const Peer& peer, const ConnectionOptions& connection, const FindOutcome& outcome) {
  throw DeviceError(
      to_text(peer) + ": " + outcome.refusal +
      (outcome.refusal == kPeerEnded ? "; it may not know us as " + connection.our_ae_title : ""));
}

// Asks, and once more on a new connection when that broke. False when stopped.
class Asker {
 public:
  Asker(const Peer& peer, const ConnectionOptions& connection, const std::stop_token& stop)
      : peer_(peer), connection_(connection), stop_(stop) {}
  // `start` forgets what an attempt that broke has brought.
  bool ask(DcmDataset& query, int most, bool& is_cut, const std::function<void()>& start,
           const std::function<void(DcmDataset&)>& take) {
    for (int attempt = 0;; ++attempt) {
      if (!association_) {
        std::vector<Proposal> proposals;
        propose_find(proposals);
        association_ = Association::connect(peer_, connection_, proposals, stop_);
      }
      if (!association_) return false;
      start();
      const FindOutcome outcome = send_find(*association_, query, most, take);
      if (stop_.stop_requested()) return false;
      if (outcome.refusal.empty()) {
        if (outcome.is_over) association_.reset();
        is_cut = outcome.is_cut;
        return true;
      }
      if (!outcome.is_broken || attempt >= connection_.retries) fail(peer_, connection_, outcome);
      association_.reset();
      pause_before_retry(connection_, attempt, outcome.refusal, stop_);
    }
  }
  void end() {
    if (association_) association_->release();
  }

 private:
  const Peer& peer_;
  const ConnectionOptions& connection_;
  const std::stop_token& stop_;
  std::unique_ptr<Association> association_;
};

void put_study_query(DcmDataset& query, const FindKeys& keys) {
  put_key(query, DCM_QueryRetrieveLevel, "STUDY");
  put_key(query, DCM_PatientID, keys.patient_id);
  put_key(query, DCM_PatientName, keys.patient_name);
  put_key(query, DCM_PatientBirthDate, "");
  put_key(query, DCM_PatientSex, "");
  put_key(query, DCM_StudyInstanceUID, keys.study_uid);
  put_key(query, DCM_StudyDate, keys.study_date);
  put_key(query, DCM_StudyTime, "");
  put_key(query, DCM_StudyDescription, "");
  put_key(query, DCM_AccessionNumber, keys.accession_number);
  put_key(query, DCM_ModalitiesInStudy, keys.modality);
  put_key(query, DCM_NumberOfStudyRelatedSeries, "");
  put_key(query, DCM_NumberOfStudyRelatedInstances, "");
}

FoundStudy study_of(DcmDataset& answer) {
  FoundStudy study;
  study.uid = text_of(answer, DCM_StudyInstanceUID);
  study.date = text_of(answer, DCM_StudyDate);
  study.time = text_of(answer, DCM_StudyTime);
  study.description = utf8_text_of(answer, DCM_StudyDescription);
  study.accession_number = utf8_text_of(answer, DCM_AccessionNumber);
  study.modalities = values_of(text_of(answer, DCM_ModalitiesInStudy));
  study.series_count = count_of(answer, DCM_NumberOfStudyRelatedSeries);
  study.image_count = count_of(answer, DCM_NumberOfStudyRelatedInstances);
  return study;
}

FoundSeries series_of(DcmDataset& answer) {
  FoundSeries series;
  series.uid = text_of(answer, DCM_SeriesInstanceUID);
  series.number = text_of(answer, DCM_SeriesNumber);
  series.modality = text_of(answer, DCM_Modality);
  series.description = utf8_text_of(answer, DCM_SeriesDescription);
  series.body_part = text_of(answer, DCM_BodyPartExamined);
  series.date = text_of(answer, DCM_SeriesDate);
  series.image_count = count_of(answer, DCM_NumberOfSeriesRelatedInstances);
  return series;
}

using Patients = std::map<std::pair<std::string, std::string>, FoundPatient>;  // by name and ID

void add_study(Patients& patients, DcmDataset& answer) {
  const std::string name = utf8_text_of(answer, DCM_PatientName), id = utf8_text_of(answer, DCM_PatientID);
  FoundPatient& patient = patients[{name, id}];
  patient.name = name;
  patient.id = id;
  patient.birth_date = text_of(answer, DCM_PatientBirthDate);
  patient.sex = text_of(answer, DCM_PatientSex);
  patient.studies.push_back(study_of(answer));
}

// What a peer without these optional keys leaves open, as far as its series tell it.
void complete(FoundStudy& study) {
  if (study.series_count < 0) study.series_count = static_cast<int>(study.series.size());
  if (!study.modalities.empty()) return;
  for (const FoundSeries& series : study.series)
    if (std::find(study.modalities.begin(), study.modalities.end(), series.modality) ==
        study.modalities.end())
      study.modalities.push_back(series.modality);
}

// False when stopped.
bool add_series(Asker& asker, const FindKeys& keys, const FoundPatient& patient, int most, bool& is_cut,
                FoundStudy& study) {
  DcmDataset query;
  put_key(query, DCM_QueryRetrieveLevel, "SERIES");
  // The patient root model wants it; the other takes it as one more key.
  put_key(query, DCM_PatientID, patient.id);
  put_key(query, DCM_StudyInstanceUID, study.uid);
  put_key(query, DCM_SeriesInstanceUID, "");
  put_key(query, DCM_Modality, keys.modality);
  for (const DcmTagKey& key : {DCM_SeriesNumber, DCM_SeriesDescription, DCM_BodyPartExamined, DCM_SeriesDate,
                               DCM_NumberOfSeriesRelatedInstances})
    put_key(query, key, "");
  bool is_study_cut = false;
  const bool is_done = asker.ask(
      query, std::min(kMostSeriesOfAStudy, most), is_study_cut, [&] { study.series.clear(); },
      [&](DcmDataset& answer) { study.series.push_back(series_of(answer)); });
  is_cut |= is_study_cut;
  std::sort(study.series.begin(), study.series.end(), [](const FoundSeries& a, const FoundSeries& b) {
    return std::pair(a.number.size(), a.number + a.uid) < std::pair(b.number.size(), b.number + b.uid);
  });
  if (is_done && keys.modality.empty()) complete(study);
  return is_done;
}

// 20260131, or a range, of which one end may be open (PS3.5, DA).
bool is_date_or_range(std::string_view text) {
  const auto is_date = [](std::string_view part) {
    constexpr std::size_t kDigits = 8;
    return part.size() == kDigits && part.find_first_not_of("0123456789") == std::string_view::npos;
  };
  const auto dash = text.find('-');
  if (dash == std::string_view::npos) return is_date(text);
  const std::string_view from = text.substr(0, dash), to = text.substr(dash + 1);
  return (from.empty() || is_date(from)) && (to.empty() || is_date(to)) && text.size() > 1;
}

}  // namespace

void check(const FindKeys& keys, const FindOptions& options) {
  if (keys.patient_id.empty() && keys.patient_name.empty() && keys.accession_number.empty() &&
      keys.study_date.empty() && keys.study_uid.empty())
    throw InvalidInput("the search names no patient, study, accession number or date");
  if (!keys.study_uid.empty() && !is_uid(keys.study_uid))
    throw InvalidInput("\"" + keys.study_uid + "\" is no UID: it has digits and dots, at most 64");
  for (const std::string* text :
       {&keys.patient_id, &keys.patient_name, &keys.accession_number, &keys.modality})
    if (text->find('\\') != std::string::npos)
      throw InvalidInput("\"" + *text + "\" holds a backslash, which DICOM keeps for lists");
  if (!keys.study_date.empty() && !is_date_or_range(keys.study_date))
    throw InvalidInput("\"" + keys.study_date + "\" is no date: it is written 20260131 or 20260101-20260131");
  if (options.most_studies < 1) throw InvalidInput("most_studies: must be at least 1");
}

double echo(const Peer& peer, const ConnectionOptions& connection, const std::stop_token& stop) {
  const auto association = Association::connect(
      peer, connection,
      {{.sop_class = UID_VerificationSOPClass, .transfer_syntaxes = uncompressed_syntaxes()}}, stop);
  if (!association) return -1;
  if (association->accepted(UID_VerificationSOPClass) == 0)
    throw DeviceError(to_text(peer) + ": does not offer C-ECHO to us");
  const auto before = std::chrono::steady_clock::now();
  association->expect_command();
  DIC_US status = 0;
  DcmDataset* detail = nullptr;
  const OFCondition outcome =
      DIMSE_echoUser(&association->get(), association->next_message_id(), DIMSE_NONBLOCKING,
                     association->answer_timeout_s(), &status, &detail);
  const std::string comment = take_comment(detail);
  if (stop.stop_requested()) return -1;
  if (outcome.bad()) throw DeviceError(to_text(peer) + ": " + association->why(outcome));
  if (status != STATUS_Success)
    throw DeviceError(to_text(peer) + ": refused C-ECHO with " + status_text(status, comment));
  const std::chrono::duration<double, std::milli> taken = std::chrono::steady_clock::now() - before;
  association->release();
  return taken.count();
}

FindSummary find(const Peer& peer, const ConnectionOptions& connection, const FindKeys& keys,
                 const FindOptions& options, const std::stop_token& stop) {
  check(keys, options);
  FindSummary summary;
  Asker asker(peer, connection, stop);
  DcmDataset query;
  put_study_query(query, keys);
  Patients patients;
  summary.was_stopped = !asker.ask(
      query, options.most_studies, summary.is_cut, [&] { patients.clear(); },
      [&](DcmDataset& answer) { add_study(patients, answer); });
  int series_left = kMostSeries;
  for (auto& [key, patient] : patients) {
    patient.study_count = static_cast<int>(patient.studies.size());
    std::sort(patient.studies.begin(), patient.studies.end(), [](const FoundStudy& a, const FoundStudy& b) {
      return std::tuple(b.date, b.time, b.uid) < std::tuple(a.date, a.time, a.uid);
    });
    for (FoundStudy& study : patient.studies)
      if (options.level == FindLevel::Series && !summary.was_stopped) {
        summary.was_stopped = !add_series(asker, keys, patient, series_left, summary.is_cut, study);
        series_left -= static_cast<int>(study.series.size());
      }
    // Not every peer narrows studies by modality.
    if (options.level == FindLevel::Series && !keys.modality.empty())
      std::erase_if(patient.studies, [](const FoundStudy& study) { return study.series.empty(); });
    if (options.level == FindLevel::Patient) patient.studies.clear();
    if (options.level == FindLevel::Patient || !patient.studies.empty())
      summary.patients.push_back(std::move(patient));
  }
  asker.end();
  return summary;
}

}  // namespace arthronaut::pacs
