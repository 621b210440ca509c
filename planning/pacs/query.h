// What a PACS has of a patient: C-FIND in the study root model, or the patient root model where the peer has
// that alone. All texts are UTF-8, whatever character set the peer answers in.
#pragma once

#include <stop_token>
#include <string>
#include <vector>

#include "planning/pacs/connection.h"

namespace arthronaut::pacs {

// A question to the peer whether it is there (C-ECHO); returns how long the answer took, in ms, and a
// negative number when stopped. Throws as find() does.
[[nodiscard]] double echo(const Peer& peer, const ConnectionOptions& connection,
                          const std::stop_token& stop = {});

enum class FindLevel { Patient, Study, Series };

// At least one but the modality must be given. "*" and "?" stand for anything in the first three (PS3.4
// C.2.2.2.4); dates are "20260131" or a range "20260101-20260131".
struct FindKeys {
  std::string patient_id = {}, patient_name = {}, accession_number = {};  // UTF-8
  std::string study_date = {}, study_uid = {};
  std::string modality = {};  // narrows the answer further
};

struct FindOptions {
  FindLevel level = FindLevel::Series;  // how deep the answer goes
  int most_studies = 500;               // the peer is asked to stop after these
};

// Empty, and -1, is what the peer does not say. Dates as DICOM has them: "20260131", "081500.25".
struct FoundSeries {
  std::string uid, number, modality, description, body_part, date;
  int image_count = -1;
};
struct FoundStudy {
  std::string uid, date, time, description, accession_number;
  std::vector<std::string> modalities;
  int series_count = -1, image_count = -1;
  std::vector<FoundSeries> series;  // by number; empty above FindLevel::Series
};
struct FoundPatient {
  std::string id, name, birth_date, sex;  // the name as DICOM has it: "Muster^Anna"
  int study_count = 0;
  std::vector<FoundStudy> studies;  // newest first; empty at FindLevel::Patient
};

struct FindSummary {
  bool was_stopped = false;
  bool is_cut =
      false;  // there are more studies than most_studies, or series than 10,000 in one or 100,000 in all
  std::vector<FoundPatient> patients;  // by name
};

// Throws InvalidInput (keys, options) and DeviceError (the peer is not reachable, not trusted, refuses, or
// broke off: the message names it and its reason). A peer that has nothing of the kind is no error.
[[nodiscard]] FindSummary find(const Peer& peer, const ConnectionOptions& connection, const FindKeys& keys,
                               const FindOptions& options = {}, const std::stop_token& stop = {});

}  // namespace arthronaut::pacs
