#include "planning/import/case_import.h"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <set>

#include "planning/cases/bone_doubts.h"
#include "planning/cases/same_patient.h"
#include "planning/cases/study.h"
#include "planning/files/local_time.h"
#include "planning/files/pipe.h"
#include "planning/files/remove_file.h"
#include "planning/files/utc_clock.h"
#include "planning/files/whole_folder.h"
#include "planning/geometry/error.h"
#include "planning/images/volume_bytes.h"
#include "planning/import/failure_reason.h"
#include "planning/import/import_side.h"

namespace arthronaut::importing {

namespace {

namespace fs = std::filesystem;

[[noreturn]] void refuse_unknown_side(const fs::path& source) {
  throw InvalidInput(source, "", "its name does not say which knee it is: add --side left or --side right");
}

void refuse_what_is_no_case(const fs::path& folder) {
  if (fs::exists(folder) && !(fs::is_directory(folder) && fs::is_empty(folder)))
    throw InvalidInput(folder, "", "exists and is not a case: nothing was written");
}

cases::Case case_to_extend(const fs::path& folder, const BoneImport& import, const std::string& name,
                           const fs::path& source) {
  if (fs::exists(folder / "case.json")) {
    cases::Case existing = cases::load_case(folder);
    if (import.side && *import.side != existing.side) {
      throw InvalidInput(
          folder, "",
          "is a " + std::string(bones::to_text(existing.side)) + " knee, the import is a " +
              std::string(bones::to_text(*import.side)) + " one" +
              (is_guess(import.side_source) ? " " + told_by(import.side_source) + " (--side says otherwise)"
                                            : ""));
    }
    if (!name.empty()) existing.name = name;
    return existing;
  }
  refuse_what_is_no_case(folder);
  if (!import.side && !import.why_no_side.empty()) throw InvalidInput(source, "", import.why_no_side);
  if (!import.side) refuse_unknown_side(source);
  cases::Case created;
  // Not by the source's or the folder's name: it often is the patient's. The time tells two of a day apart.
  created.name = name.empty() ? "Knee " + files::local_time_in_words(files::utc_now()) : name;
  created.side = *import.side;
  created.created_utc = files::utc_now();
  return created;
}

// Byte by byte.
bool holds_same(const fs::path& file, const images::EncodedVolume& volume) {
  std::error_code error;
  if (fs::file_size(file, error) != volume.header.size() + volume.voxels.size() || error) return false;
  std::ifstream stream(file, std::ios::binary);
  std::string chunk;
  for (std::string_view expected : {std::string_view(volume.header), volume.voxels}) {
    while (!expected.empty()) {
      chunk.resize(std::min<std::size_t>(expected.size(), 1 << 20));
      if (!stream.read(chunk.data(), static_cast<std::streamsize>(chunk.size()))) return false;
      if (expected.substr(0, chunk.size()) != chunk) return false;
      expected.remove_prefix(chunk.size());
    }
  }
  return true;
}

void refuse_planned_bones(const fs::path& folder, const cases::Case& target, const BoneImport& import) {
  for (const ImportedBone& imported : import.bones) {
    const bones::BoneKind kind = imported.bone.kind;
    if (target.bones.contains(kind) && !target.plan.of(kind).empty()) {
      throw InvalidInput(folder, "",
                         "holds a plan on its " + std::string(bones::to_text(kind)) +
                             ", which another bone would make wrong: import into another case");
    }
  }
}

// Landmarks and cartilage of a bone that is replaced lie on its surface. They leave the disk before another
// surface comes: whatever happens in between, none is found on a bone that it is not of. So does what is
// known of its images: another bone's coordinates would go to the hospital in the frame of reference of this
// one.
void forget_replaced(const fs::path& folder, cases::Case& target, const BoneImport& import,
                     cases::Studies& studies, const cases::ImageStudies& of_images) {
  bool is_replaced = false;
  for (const ImportedBone& imported : import.bones) {
    const bones::BoneKind kind = imported.bone.kind;
    if (!target.bones.contains(kind)) continue;
    is_replaced = true;
    studies.erase(kind);
    target.landmarks.erase(kind);
    target.landmark_states.erase(kind);
    files::remove_file(cases::cartilage_file(folder, kind));
  }
  if (!is_replaced) return;
  cases::save_studies(folder, studies, of_images);
  cases::save_case(folder, target);
}

std::vector<bones::BoneKind> replaced_bones(const cases::Case& target, const BoneImport& import) {
  std::vector<bones::BoneKind> kinds;
  for (const ImportedBone& imported : import.bones)
    if (target.bones.contains(imported.bone.kind)) kinds.push_back(imported.bone.kind);
  return kinds;
}

// Whether images that the case has are of bones that none of is left: all of them are replaced by those of an
// image of its own, which lies elsewhere. Meshes and label maps come without; they are often made in an image
// that is there.
bool replaces_images(const cases::Case& target, const BoneImport& import, const cases::Studies& studies) {
  if (!import.image || import.image->image.is_label_map) return false;
  const std::vector<bones::BoneKind> replaced = replaced_bones(target, import);
  if (replaced.empty() || replaced.size() < target.bones.size()) return false;
  const std::string& frame = import.origin.frame_of_reference_uid;
  return frame.empty() || std::ranges::none_of(studies, [&](const auto& study) {
           return study.second.frame_of_reference_uid == frame;
         });
}

void put_bones(cases::Case& target, const BoneImport& import) {
  for (const ImportedBone& imported : import.bones) target.bones[imported.bone.kind] = imported.bone;
}

// The case's image that is the import's already; null when it has none.
const cases::CaseImage* image_there(const fs::path& folder, const cases::Case& target,
                                    const BoneImport& import) {
  const cases::CaseImage& image = import.image->image;
  const auto there = std::ranges::find_if(target.images, [&](const cases::CaseImage& other) {
    return other.size == image.size && other.spacing_mm == image.spacing_mm &&
           other.modality == image.modality && other.is_label_map == image.is_label_map &&
           holds_same(folder / other.file, import.image->volume);
  });
  return there == target.images.end() ? nullptr : &*there;
}

// Beside the bones, which were made from it. Empty when there is none to store: the same volume once more
// keeps its place.
std::optional<cases::CaseImage> store_new_image(const fs::path& folder, const cases::Case& target,
                                                const BoneImport& import) {
  if (!import.image || image_there(folder, target, import)) return std::nullopt;
  cases::CaseImage image = import.image->image;
  int number = 1;
  const auto is_taken = [&] { return fs::exists(folder / ("images/" + std::to_string(number) + ".nrrd")); };
  while (is_taken()) ++number;
  cases::store_image(folder, number, import.image->volume, image);
  return image;
}

// Of the bones that were added, and of no other: one that is now a mesh is no longer of the images. stored:
// the import's image where it is new to the case.
void save_studies_of(const fs::path& folder, const cases::Case& target, const BoneImport& import,
                     const std::optional<cases::CaseImage>& stored, cases::Studies studies,
                     cases::ImageStudies of_images) {
  std::erase_if(of_images, [&](const auto& one) {
    return std::ranges::none_of(target.images, [&](const auto& image) { return image.file == one.first; });
  });
  if (import.image && !import.origin.is_empty()) {
    const cases::CaseImage* const image = stored ? &*stored : image_there(folder, target, import);
    if (image != nullptr) of_images[image->file] = import.origin;
  }
  for (const ImportedBone& imported : import.bones) {
    studies.erase(imported.bone.kind);
    if (!import.origin.is_empty()) studies[imported.bone.kind] = import.origin;
  }
  // Images alone: the bones that will be painted in them.
  if (import.bones.empty() && !import.origin.is_empty())
    for (const bones::BoneKind kind : {bones::BoneKind::Femur, bones::BoneKind::Tibia})
      studies.try_emplace(kind, import.origin);
  cases::save_studies(folder, studies, of_images);
}

// Whether femur and tibia will be of two frames of reference once the import's bones are in the case.
bool makes_two_frames(const cases::Case& target, const BoneImport& import, cases::Studies studies) {
  std::set<bones::BoneKind> kinds;
  for (const auto& [kind, bone] : target.bones) kinds.insert(kind);
  for (const ImportedBone& imported : import.bones) {
    kinds.insert(imported.bone.kind);
    studies[imported.bone.kind] = import.origin;
  }
  return kinds.size() == 2 && cases::are_of_two_frames(studies);
}

// The bones whose doubts said that the side rests on a person's word alone; they say it no more.
std::set<bones::BoneKind> take_side_notes(cases::BoneDoubts& doubts) {
  std::set<bones::BoneKind> noted;
  for (auto& [kind, of_bone] : doubts)
    if (std::erase_if(of_bone, cases::is_side_note) > 0) noted.insert(kind);
  return noted;
}

// Those of the bones that were added take the place of what was said of the bones before them. That its side
// rests on a person's word alone is said until something bears the side out, whatever is added: of a side
// that comes with its first bones or images, or with others in place of all its bones.
void save_doubts_of(const fs::path& folder, const cases::Case& target, const BoneImport& import,
                    cases::BoneDoubts doubts) {
  std::set<bones::BoneKind> noted = take_side_notes(doubts), added;
  for (const ImportedBone& imported : import.bones) {
    added.insert(imported.bone.kind);
    std::vector<cases::BoneDoubt>& of_bone = doubts[imported.bone.kind] =
        doubts_with(import, imported, target.side);
    std::ranges::copy_if(imported.image_cuts, std::back_inserter(of_bone),
                         [](const bones::ImageCut& cut) { return !cut.is_wide(); });
    of_bone.emplace_back(cases::SurfaceLookedAt{});
  }
  const bool is_all =
      std::ranges::all_of(target.bones, [&](const auto& bone) { return added.contains(bone.first); });
  if (added.empty()) added = {bones::BoneKind::Femur, bones::BoneKind::Tibia};  // as they will be painted
  if (!noted.empty() || (is_all && side_note(import, target.side))) noted.merge(added);
  if (!side_is_borne_out(import, target.side))
    for (const bones::BoneKind kind : noted)
      doubts[kind].emplace_back(cases::SideDoubt{cases::SideWitness::PersonAlone, target.side, target.side});
  cases::save_bone_doubts(folder, doubts);
}

// Another patient's bone in a case would be navigated by.
void refuse_another_patient(const fs::path& folder, const cases::Identity& of_import) {
  const auto of_case = cases::load_identity(folder);
  if (!of_case || !cases::is_another_patient(*of_case, of_import)) return;
  throw InvalidInput(folder, "",
                     "is the knee of another patient (" + of_case->in_words() +
                         ") than what was to be added (" + of_import.in_words() + "); nothing was written");
}

void save_new(const fs::path& folder, cases::Case& contents, const BoneImport& import) {
  files::make_whole_folder(folder, [&](const fs::path& unfinished) {
    const auto image = store_new_image(unfinished, contents, import);
    if (image) contents.images.push_back(*image);
    cases::save_case(unfinished, contents);
    save_doubts_of(unfinished, contents, import, {});
    if (!import.identity.is_empty()) cases::save_identity(unfinished, import.identity);
    save_studies_of(unfinished, contents, import, image, {}, {});
  });
}

// The image, the largest, first: a disk that it fills is as it was before.
void save_into(const fs::path& folder, cases::Case& target, const BoneImport& import) {
  // What cannot be read is found out before anything is forgotten or written.
  cases::BoneDoubts doubts = cases::load_bone_doubts(folder);
  cases::Studies studies = cases::load_studies(folder);
  cases::ImageStudies of_images = cases::load_image_studies(folder);
  // A case of an older version says it of its bones alone: once it says it of an image, the others have none.
  if (of_images.empty())
    for (const cases::CaseImage& there : target.images)
      if (auto origin = cases::study_of_image(folder, there.file); !origin.is_empty())
        of_images[there.file] = std::move(origin);
  const bool is_other_knee = replaces_images(target, import, studies);
  const auto image = store_new_image(folder, target, import);
  try {
    forget_replaced(folder, target, import, studies, of_images);
    if (is_other_knee && image) target.images.clear();
    // Before its bone: of a doubt too many, after a crash, nobody drills wrongly.
    save_doubts_of(folder, target, import, std::move(doubts));
    put_bones(target, import);
    if (image) target.images.push_back(*image);
    cases::save_case(folder, target);
  } catch (...) {
    std::error_code ignored;  // of two failures the first is told
    if (image) fs::remove(folder / image->file, ignored);
    throw;
  }
  // A source that says less than another did takes nothing away.
  if (!import.identity.is_empty())
    cases::save_identity(
        folder, import.identity.filled_from(cases::load_identity(folder).value_or(cases::Identity())));
  save_studies_of(folder, target, import, image, std::move(studies), std::move(of_images));
}

// 3D Slicer's segmentations alone name their segments; before all of it is read, by the header.
bool is_side_in_segments(const fs::path& source) {
  constexpr std::size_t kLongestHeader = 1 << 16;
  std::string header(kLongestHeader, '\0');
  std::ifstream stream(source, std::ios::binary);
  stream.read(header.data(), kLongestHeader);
  header.resize(static_cast<std::size_t>(stream.gcount()));
  try {
    for (std::string& name : images::nrrd_segment_names(source, header)) {
      std::ranges::replace(name, '/', ' ');  // it is no path
      if (side_in_name(name)) return true;
    }
  } catch (const InvalidInput&) {
    // Another format, which names none.
  }
  return false;
}

}  // namespace

void refuse_folder(const fs::path& folder) {
  if (fs::exists(folder / "case.json")) return;
  refuse_what_is_no_case(folder);
  files::refuse_unwritable(fs::absolute(folder).parent_path());
}

void refuse_missing_side(const fs::path& folder, const fs::path& source, const BoneImportOptions& options) {
  if (options.side || side_in_name(source) || fs::exists(folder / "case.json") || !fs::exists(source)) return;
  files::refuse_pipe(source);
  const bool is_mesh = bones::is_mesh_file(source) && !fs::is_directory(source);
  if (is_mesh) refuse_empty_file(source);
  if (is_mesh && !options.kind && !bone_kind_in_name(source))
    throw InvalidInput(source, "",
                       "its name says neither which bone it is nor of which knee: add --bone femur or --bone "
                       "tibia, and --side left or --side right");
  // Two bones may tell it together, by their shapes.
  const bool is_one_label = !options.labels.empty() && (options.labels.size() == 1 || options.kind);
  if (is_mesh || (is_one_label && !is_side_in_segments(source))) refuse_unknown_side(source);
}

std::vector<std::string> replaced_in_words(const fs::path& folder, const BoneImport& import) {
  if (!fs::exists(folder / "case.json")) return {};
  const cases::Case target = cases::load_case(folder);
  const cases::Studies studies = cases::load_studies(folder);
  std::vector<std::string> words;
  std::string bones;
  for (const bones::BoneKind kind : replaced_bones(target, import))
    bones += (bones.empty() ? "its " : " and its ") + std::string(bones::to_text(kind));
  if (!bones.empty()) words.push_back("replaced in the case: " + bones);
  if (makes_two_frames(target, import, studies))
    words.emplace_back(
        "femur and tibia are of images of different frames of reference: each can be planned on, nothing is "
        "checked of both together");
  if (bones.empty() || !replaces_images(target, import, studies) || image_there(folder, target, import))
    return words;
  for (const cases::CaseImage& image : target.images)
    words.push_back(image.file + ", of the bones before, is no image of the case any more; its file stays");
  return words;
}

cases::Case add_to_case(const fs::path& folder, const BoneImport& import, const std::string& name,
                        const fs::path& source) {
  cases::Case target = case_to_extend(folder, import, name, source);
  refuse_planned_bones(folder, target, import);
  if (fs::exists(folder / "case.json")) {
    refuse_another_patient(folder, import.identity);
    save_into(folder, target, import);
  } else {
    put_bones(target, import);
    save_new(folder, target, import);
  }
  target.is_of_two_frames = target.bones.size() == 2 && cases::are_of_two_frames(cases::load_studies(folder));
  return target;
}

}  // namespace arthronaut::importing
