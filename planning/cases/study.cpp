#include "planning/cases/study.h"

#include <array>
#include <nlohmann/json.hpp>
#include <utility>

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

}  // namespace

bool are_of_two_frames(const Studies& studies) {
  const auto femur = studies.find(bones::BoneKind::Femur), tibia = studies.find(bones::BoneKind::Tibia);
  if (femur == studies.end() || tibia == studies.end()) return false;
  const std::string& of_femur = femur->second.frame_of_reference_uid;
  const std::string& of_tibia = tibia->second.frame_of_reference_uid;
  return !of_femur.empty() && !of_tibia.empty() && of_femur != of_tibia;
}

fs::path study_file(const fs::path& case_folder) { return case_folder / "study.json"; }

Studies load_studies(const fs::path& case_folder) {
  const fs::path file = study_file(case_folder);
  if (!fs::exists(file)) return {};
  Studies studies;
  for (const files::JsonObject& study :
       files::read_json(file, kStudyFormat, kStudyVersion).objects("studies")) {
    DicomOrigin origin;
    for (const auto& [key, text] : kTexts) origin.*text = study.text(key);
    if (origin.is_empty()) study.fail("study_uid", "is empty");
    origin.sop_instance_uids = study.texts("sop_instance_uids");
    for (const std::string& bone : study.texts("bones")) {
      if (bone != "femur" && bone != "tibia") study.fail("bones", "names no bone");
      studies[bones::bone_kind_from_text(bone)] = origin;
    }
  }
  return studies;
}

void save_studies(const fs::path& case_folder, const Studies& studies) {
  if (studies.empty()) return files::remove_file(study_file(case_folder));
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  const DicomOrigin* before = nullptr;
  for (const auto& [kind, origin] : studies) {
    // Both bones of a CT are of one series, which lists hundreds of images: once.
    if (before == nullptr || *before != origin) {
      nlohmann::ordered_json study = {{"bones", nlohmann::ordered_json::array()}};
      for (const auto& [key, text] : kTexts) study[key] = origin.*text;
      study["sop_instance_uids"] = origin.sop_instance_uids;
      list.push_back(std::move(study));
    }
    before = &origin;
    list.back()["bones"].push_back(std::string(bones::to_text(kind)));
  }
  write_private_json(study_file(case_folder),
                     {{"format", kStudyFormat}, {"version", kStudyVersion}, {"studies", list}});
}

}  // namespace arthronaut::cases
