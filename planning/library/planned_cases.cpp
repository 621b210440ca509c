#include "planning/library/planned_cases.h"

#include <algorithm>
#include <functional>

#include "planning/cases/same_patient.h"
#include "planning/cases/study.h"
#include "planning/geometry/error.h"

namespace arthronaut::library {

namespace {

bool may_be_before(const images::DicomOrigin& of_case, const TakenImages& images) {
  if (!images.series_uid.empty() && of_case.series_uid == images.series_uid) return false;
  return of_case.study_date.empty() || images.study_date.empty() || of_case.study_date < images.study_date;
}

bool may_be_before(const std::filesystem::path& case_folder, const TakenImages& images) {
  const auto of_case = [&](const auto& studies) {
    return std::ranges::all_of(studies, [&](const auto& one) { return may_be_before(one.second, images); });
  };
  return of_case(cases::load_studies(case_folder)) && of_case(cases::load_image_studies(case_folder));
}

bool is_of(const CaseRecord& record, const TakenImages& images) {
  try {
    const auto patient = cases::load_identity(record.folder);
    return patient && cases::is_same_patient(*patient, images.patient) &&
           may_be_before(record.folder, images);
  } catch (const InvalidInput&) {  // whose it is, or of which day, cannot be read
  } catch (const IoError&) {
  }
  return false;
}

}  // namespace

TakenImages taken_images(const images::ImageSeries& series) {
  if (!series.is_readable()) return {};
  return {{series.patient_name, series.patient_id, ""}, series.study_date, series.uid};
}

std::vector<PlannedCase> planned_cases_of(std::span<const CaseRecord> records, const TakenImages& images) {
  std::vector<const CaseRecord*> found;
  if (images.patient.patient_id.empty()) return {};
  for (const CaseRecord& record : records)
    if (record.is_there && !record.planned.empty() && is_of(record, images)) found.push_back(&record);
  std::ranges::stable_sort(found, std::greater<>(), &CaseRecord::created_utc);
  std::vector<PlannedCase> cases;
  for (const CaseRecord* record : found) cases.push_back({record->folder, record->name});
  return cases;
}

}  // namespace arthronaut::library
