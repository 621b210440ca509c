#include "planning/dicom_out/belonging.h"

#include <algorithm>

#include "planning/bones/mesh_hash.h"
#include "planning/dicom_out/uid.h"
#include "planning/files/local_time.h"

namespace arthronaut::dicom_out {

namespace {

using images::DicomOrigin;

// The case without its plan, so that all plans of a knee come into one study.
std::string name_of_case(const cases::Case& knee) {
  std::string name = knee.created_utc + "\n" + std::string(bones::to_text(knee.side));
  for (const auto& [kind, bone] : knee.bones)
    name += "\n" + std::string(bones::to_text(kind)) + " " + bones::mesh_sha256(bone.mesh);
  return name;
}

bool are_digits(const std::string& text, std::size_t at, std::size_t count) {
  return std::all_of(text.begin() + static_cast<std::ptrdiff_t>(at),
                     text.begin() + static_cast<std::ptrdiff_t>(at + count),
                     [](char c) { return c >= '0' && c <= '9'; });
}

DicomOrigin own_study(const cases::Case& knee, const std::string& case_name) {
  DicomOrigin own;
  own.study_uid = uid_of("study", case_name);
  own.frame_of_reference_uid = uid_of("frame of reference", case_name);
  const DicomMoment created = moment_from(knee.created_utc);
  own.study_date = created.date;
  own.study_time = created.time;
  return own;
}

// A study that nothing leads back from: bones that shared a frame still do.
std::map<bones::BoneKind, Belonging> without_identity(const ExportContents& contents,
                                                      const std::string& case_name) {
  std::map<bones::BoneKind, Belonging> belongings;
  std::vector<std::string> frames;
  for (const auto& [kind, bone] : contents.knee.bones) {
    const auto study = contents.studies.find(kind);
    const std::string frame = study == contents.studies.end() ? "" : study->second.frame_of_reference_uid;
    auto known = std::find(frames.begin(), frames.end(), frame);
    if (known == frames.end()) known = frames.insert(known, frame);
    Belonging belonging;
    belonging.study.study_uid = uid_of("study without identity", case_name);
    belonging.study.frame_of_reference_uid =
        uid_of("frame of reference without identity " + std::to_string(known - frames.begin()), case_name);
    belonging.is_deidentified = true;
    belongings[kind] = belonging;
  }
  return belongings;
}

}  // namespace

DicomMoment moment_from(const std::string& utc) {
  const bool is_moment = utc.size() == 20 && utc[4] == '-' && utc[7] == '-' && utc[10] == 'T' &&
                         utc[13] == ':' && utc[16] == ':' && utc[19] == 'Z';
  if (!is_moment) return {};
  const DicomMoment moment{utc.substr(0, 4) + utc.substr(5, 2) + utc.substr(8, 2),
                           utc.substr(11, 2) + utc.substr(14, 2) + utc.substr(17, 2)};
  if (!are_digits(moment.date, 0, 8) || !are_digits(moment.time, 0, 6)) return {};
  return moment;
}

DicomMoment local_moment_from(const std::string& utc) {
  if (moment_from(utc).date.empty()) return {};
  std::string local = files::local_time_in_words(utc) + "Z";
  local[10] = 'T';
  return moment_from(local);
}

std::map<bones::BoneKind, Belonging> belongings_of(const ExportContents& contents) {
  const std::string case_name = name_of_case(contents.knee);
  if (contents.is_deidentified) return without_identity(contents, case_name);
  Belonging own;
  own.patient = contents.identity.value_or(cases::Identity{});
  own.study = own_study(contents.knee, case_name);
  std::map<bones::BoneKind, Belonging> belongings;
  const Belonging* of_images = nullptr;
  for (const auto& [kind, study] : contents.studies) {
    if (!contents.knee.bones.contains(kind) || !is_uid(study.study_uid)) continue;
    Belonging& belonging = belongings[kind] = own;
    belonging.study = study;
    belonging.is_of_images = true;
    // Images without a frame of reference are in one all the same, which their series stands for.
    if (!is_uid(study.frame_of_reference_uid))
      belonging.study.frame_of_reference_uid =
          uid_of("frame of reference of a series", study.study_uid + "\n" + study.series_uid);
    if (of_images == nullptr) of_images = &belonging;
  }
  for (const auto& [kind, bone] : contents.knee.bones) {
    if (belongings.contains(kind)) continue;
    Belonging belonging = of_images ? *of_images : own;
    belonging.study.frame_of_reference_uid = own.study.frame_of_reference_uid;
    belonging.study.series_uid.clear();  // a mesh is of no image
    belonging.study.sop_class_uid.clear();
    belonging.study.sop_instance_uids.clear();
    belongings[kind] = belonging;
  }
  return belongings;
}

}  // namespace arthronaut::dicom_out
