#include "planning/cases/study.h"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "planning/cases/private_json.h"
#include "planning/files/json_document.h"
#include "planning/files/remove_file.h"

namespace arthronaut::cases {

namespace {

namespace fs = std::filesystem;
using images::DicomOrigin;
constexpr std::string_view kStudyFormat = "arthronaut.study";
constexpr int kStudyVersion = 1;

using Text = std::pair<const char*, std::string DicomOrigin::*>;
// The one list of the texts, for reading and writing.
constexpr std::array<Text, 11> kTexts{{{"study_uid", &DicomOrigin::study_uid},
                                       {"study_id", &DicomOrigin::study_id},
                                       {"study_date", &DicomOrigin::study_date},
                                       {"study_time", &DicomOrigin::study_time},
                                       {"accession_number", &DicomOrigin::accession_number},
                                       {"referring_physician", &DicomOrigin::referring_physician},
                                       {"patient_sex", &DicomOrigin::patient_sex},
                                       {"patient_id_issuer", &DicomOrigin::patient_id_issuer},
                                       {"series_uid", &DicomOrigin::series_uid},
                                       {"frame_of_reference_uid", &DicomOrigin::frame_of_reference_uid},
                                       {"sop_class_uid", &DicomOrigin::sop_class_uid}}};

struct AllStudies {
  Studies of_bones;
  ImageStudies of_images;
};

AllStudies load_all(const fs::path& case_folder) {
  const fs::path file = study_file(case_folder);
  if (!fs::exists(file)) return {};
  AllStudies studies;
  for (const files::JsonObject& study :
       files::read_json(file, kStudyFormat, kStudyVersion).objects("studies")) {
    DicomOrigin origin;
    for (const auto& [key, text] : kTexts) origin.*text = study.text(key);
    if (origin.is_empty()) study.fail("study_uid", "is empty");
    origin.sop_instance_uids = study.texts("sop_instance_uids");
    for (const std::string& bone : study.texts("bones")) {
      if (bone != "femur" && bone != "tibia") study.fail("bones", "names no bone");
      studies.of_bones[bones::bone_kind_from_text(bone)] = origin;
    }
    if (!study.has("images")) continue;  // of an older version
    for (const std::string& image : study.texts("images")) studies.of_images[image] = origin;
  }
  return studies;
}

}  // namespace

bool are_of_two_frames(const Studies& studies) {
  const auto femur = studies.find(bones::BoneKind::Femur), tibia = studies.find(bones::BoneKind::Tibia);
  if (femur == studies.end() || tibia == studies.end()) return false;
  const std::string& of_femur = femur->second.frame_of_reference_uid;
  const std::string& of_tibia = tibia->second.frame_of_reference_uid;
  return !of_femur.empty() && !of_tibia.empty() && of_femur != of_tibia;
}

fs::path study_file(const fs::path& case_folder) { return case_folder / "study.json"; }

Studies load_studies(const fs::path& case_folder) { return load_all(case_folder).of_bones; }

ImageStudies load_image_studies(const fs::path& case_folder) { return load_all(case_folder).of_images; }

DicomOrigin study_of_image(const fs::path& case_folder, const std::string& image_file) {
  const AllStudies studies = load_all(case_folder);
  if (const auto found = studies.of_images.find(image_file); found != studies.of_images.end())
    return found->second;
  if (!studies.of_images.empty()) return {};  // a case of now: this image came from no DICOM study
  const auto is_first = [&](const auto& one) { return one.second == studies.of_bones.begin()->second; };
  if (studies.of_bones.empty() || !std::ranges::all_of(studies.of_bones, is_first)) return {};
  return studies.of_bones.begin()->second;
}

void save_studies(const fs::path& case_folder, const Studies& studies, const ImageStudies& of_images) {
  if (studies.empty() && of_images.empty()) return files::remove_file(study_file(case_folder));
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  std::vector<const DicomOrigin*> listed;
  // Bones and image of a CT are of one series, which lists hundreds of images: once.
  const auto entry_of = [&](const DicomOrigin& origin) -> nlohmann::ordered_json& {
    for (std::size_t i = 0; i < listed.size(); ++i)
      if (*listed[i] == origin) return list[i];
    listed.push_back(&origin);
    nlohmann::ordered_json study = {{"bones", nlohmann::ordered_json::array()},
                                    {"images", nlohmann::ordered_json::array()}};
    for (const auto& [key, text] : kTexts) study[key] = origin.*text;
    study["sop_instance_uids"] = origin.sop_instance_uids;
    return list.emplace_back(std::move(study));
  };
  for (const auto& [kind, origin] : studies)
    entry_of(origin)["bones"].push_back(std::string(bones::to_text(kind)));
  for (const auto& [file, origin] : of_images) entry_of(origin)["images"].push_back(file);
  write_private_json(study_file(case_folder),
                     {{"format", kStudyFormat}, {"version", kStudyVersion}, {"studies", list}});
}

}  // namespace arthronaut::cases
