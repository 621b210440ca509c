// Of which study, series and frame of reference the images of a DICOM series are: what has to be known to put
// something beside them. All of it leads to a patient: it is kept apart, as his name is (cases/study.h).
#pragma once

#include <string>
#include <vector>

namespace arthronaut::images {

// As the first slice says, in UTF-8; each may be empty.
struct DicomOrigin {
  std::string study_uid, study_id, accession_number, referring_physician;
  std::string study_date, study_time;  // "20260131", "120000.000", in the hospital's time
  std::string patient_sex;             // "F", "M", "O"
  std::string patient_id_issuer;
  std::string series_uid;
  std::string frame_of_reference_uid;  // of the coordinates of what was made from the images
  // The images themselves, in the order of the slices: those that are of one SOP class with the first.
  std::string sop_class_uid;
  std::vector<std::string> sop_instance_uids;

  [[nodiscard]] bool is_empty() const { return study_uid.empty(); }
  bool operator==(const DicomOrigin&) const = default;
};

}  // namespace arthronaut::images
