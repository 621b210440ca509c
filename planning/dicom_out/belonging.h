// Which patient, study and frame of reference an object belongs to. Inner header of dicom_out.
#pragma once

#include <map>
#include <string>

#include "planning/dicom_out/dicom_export.h"

namespace arthronaut::dicom_out {

struct Belonging {
  cases::Identity patient;
  // Study, frame and images; identifiers of study and frame are never empty, all else may be.
  images::DicomOrigin study;
  bool is_of_images = false;  // the study that the images came with; else one of our own, whose times are UTC
  bool is_deidentified = false;
};

// Of every bone of the case.
[[nodiscard]] std::map<bones::BoneKind, Belonging> belongings_of(const ExportContents& contents);

// "20260131" and "120000" of "2026-01-31T12:00:00Z"; both empty for anything else.
struct DicomMoment {
  std::string date, time;
};
[[nodiscard]] DicomMoment moment_from(const std::string& utc);
// The same moment by this machine's clock on the wall.
[[nodiscard]] DicomMoment local_moment_from(const std::string& utc);

}  // namespace arthronaut::dicom_out
