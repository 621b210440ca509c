// Of which study of the hospital the bones of a case are: study.json, which leads to the patient and
// therefore is kept as identity.json is (identity.h): readable by its owner alone, and part of no export
// unless asked for. What is exported as DICOM (dicom_out/dicom_export.h) is filed beside that study.
//
// A case of meshes, a phantom, and a case that was imported by an older version have none.
#pragma once

#include <filesystem>
#include <map>

#include "planning/bones/bone.h"
#include "planning/images/dicom_origin.h"

namespace arthronaut::cases {

// By bone, as bones may come from different series; only those that came from DICOM images.
using Studies = std::map<bones::BoneKind, images::DicomOrigin>;

// Whether both bones are known to be of images whose frames of reference differ. A frame that nobody says may
// be either.
[[nodiscard]] bool are_of_two_frames(const Studies& studies);

[[nodiscard]] std::filesystem::path study_file(const std::filesystem::path& case_folder);

// Empty when the case has no study.json. Throws IoError or InvalidInput (file, place, reason).
[[nodiscard]] Studies load_studies(const std::filesystem::path& case_folder);

// Atomic; the file is 0600 whatever the folder is. Without a study the file is removed. Throws IoError; what
// was there is then as before.
void save_studies(const std::filesystem::path& case_folder, const Studies& studies);

}  // namespace arthronaut::cases
