// Of which study of the hospital the bones and the images of a case are: study.json, which leads to the
// patient and therefore is kept as identity.json is (identity.h): readable by its owner alone, and part of no
// export unless asked for. What is exported as DICOM (dicom_out/dicom_export.h) is filed beside that study.
//
// A case of meshes, a phantom, and a case that was imported by an older version have none.
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "planning/bones/bone.h"
#include "planning/images/dicom_origin.h"

namespace arthronaut::cases {

// By bone, as bones may come from different series; only those that came from DICOM images.
using Studies = std::map<bones::BoneKind, images::DicomOrigin>;

// By the image's file (CaseImage::file): a bone that is painted in one is of that one's series, whatever the
// case's other images are. Only those that came from DICOM, and of cases of older versions none.
using ImageStudies = std::map<std::string, images::DicomOrigin>;

// Whether both bones are known to be of images whose frames of reference differ. A frame that nobody says may
// be either.
[[nodiscard]] bool are_of_two_frames(const Studies& studies);

[[nodiscard]] std::filesystem::path study_file(const std::filesystem::path& case_folder);

// Empty when the case has no study.json. Throws IoError or InvalidInput (file, place, reason).
[[nodiscard]] Studies load_studies(const std::filesystem::path& case_folder);
[[nodiscard]] ImageStudies load_image_studies(const std::filesystem::path& case_folder);

// Of which study a bone is that is made in this image of the case. Where the case does not say it of the
// image, that of its bones, if they are of one; else an empty one: none rather than another image's. Throws
// as load_studies() does.
[[nodiscard]] images::DicomOrigin study_of_image(const std::filesystem::path& case_folder,
                                                 const std::string& image_file);

// Atomic; the file is 0600 whatever the folder is. Without a study the file is removed. Throws IoError; what
// was there is then as before.
void save_studies(const std::filesystem::path& case_folder, const Studies& studies,
                  const ImageStudies& of_images = {});

}  // namespace arthronaut::cases
