// A case as DICOM objects that a hospital files beside the images that the case was made from.
//
//   femur.dcm, tibia.dcm           Encapsulated STL (PS3.3, A.85.1): the bones
//   femur_drilled.dcm, tibia_...   the same, less the planned tunnel
//   plan.dcm                       Spatial Fiducials (A.40): entry, exit and axis of each tunnel
//   report.dcm                     Encapsulated PDF (A.45.1)
//   image_001.dcm, ...             Secondary Capture (A.8.1), 8 bit RGB
//
// Part 10 files, explicit VR little endian, text in UTF-8. Models are in mm, in the frame of reference of the
// images (LPS), and name the images that they were made from.
//
// Of which study: a bone from DICOM images belongs to their study and frame of reference (cases/study.h), for
// the patient that identity.json names. A bone that was a mesh belongs to the study of the case's other bone,
// but to a frame of its own, as nobody says that the mesh lies where the images do. Without any study (a
// phantom, meshes, a case of an older version) there is a new one. Plan, report and pictures belong to the
// study of the first bone, and each tunnel to the frame of its own. No patient's data are made up: what is
// not known is empty. What the images say against DICOM's rules is written as these allow, but for what
// identifies, and is told (lawful.h).
//
// De-identified, patient and study are new, dates are empty (1900 where one is asked for), no image is named,
// and pictures are left out, since a name may be drawn into them. The report must then name nobody: that is
// for who makes it.
//
// The same contents give the same bytes: identifiers follow from what they name (uid.h), and no clock is
// asked. Anything that changes gives other identifiers of object and series, so that nothing in an archive is
// replaced. Times of objects beside images are by this machine's time zone, as DICOM reads what says no
// offset from UTC; those of a new study are UTC, and say so. Those of the images' study are as they came with
// them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "planning/cases/case.h"
#include "planning/cases/identity.h"
#include "planning/cases/study.h"

namespace arthronaut::dicom_out {

struct KeyPicture {
  std::string title;  // names nobody
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb;  // 3 * width * height, top row first
};

struct ExportContents {
  cases::Case knee;
  std::optional<cases::Identity> identity;
  cases::Studies studies;
  std::string moment_utc;  // of the newest that is told, ISO 8601; empty: not known
  std::string report_pdf;  // the file's bytes; empty: no report
  std::vector<KeyPicture> pictures;
  bool is_deidentified = false;
};

struct ExportSummary {
  std::vector<std::filesystem::path> files;  // written, in the order above
  std::vector<std::string> notes;            // of which study, what was left out, for a person
  std::vector<std::string> doubts;           // a bone that is not there drilled, though it is planned on
};

// Writes the objects into `folder`, which appears whole, by renaming, as its owner's alone (0700), or not at
// all. Throws InvalidInput: a folder that holds something, a case without a bone, a picture whose bytes do
// not fit its size. Throws IoError.
[[nodiscard]] ExportSummary export_dicom(const ExportContents& contents, const std::filesystem::path& folder);

}  // namespace arthronaut::dicom_out
