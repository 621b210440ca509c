// The cases that images may be of which were taken after the operation: those of the same patient that have a
// plan. Whose knee a case is stands in its identity.json alone, and is read there each time (cohort.h).
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "planning/cases/identity.h"
#include "planning/images/series_list.h"
#include "planning/library/case_record.h"

namespace arthronaut::library {

// As their files say; what they do not say is empty.
struct TakenImages {
  cases::Identity patient;
  std::string study_date;  // "20260131"
  std::string series_uid;
};
// What a series says of itself; nothing of one that cannot be opened.
[[nodiscard]] TakenImages taken_images(const images::ImageSeries& series);

struct PlannedCase {
  std::filesystem::path folder;
  std::string name;
};

// The newest first. Not a case that was made of these images, or of ones of the same day or a later one:
// where either day is not known it may be. None for images that do not say the patient's number
// (is_same_patient).
[[nodiscard]] std::vector<PlannedCase> planned_cases_of(std::span<const CaseRecord> records,
                                                        const TakenImages& images);

}  // namespace arthronaut::library
