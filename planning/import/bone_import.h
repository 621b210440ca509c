// From whatever holds a bone (mesh, label map, CT) to the closed, outward surface in LPS and mm that a case
// holds.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "planning/bones/bone.h"
#include "planning/bones/image_cut.h"
#include "planning/bones/mesh_file.h"
#include "planning/bones/mesh_repair.h"
#include "planning/cases/case_image.h"
#include "planning/cases/identity.h"
#include "planning/images/dicom_origin.h"
#include "planning/import/import_progress.h"

namespace arthronaut::importing {

struct BoneImportOptions {
  // Meshes: else guessed from the name of the source. Volumes: this bone alone; else femur and tibia.
  std::optional<bones::BoneKind> kind;
  std::optional<bones::Side> side;        // else guessed from the name of the source, or
                                          // seen by the fibula or the shape of both bones
  std::optional<bones::Space> space;      // meshes: overrides what the file says
  std::optional<bones::LengthUnit> unit;  // meshes: of the file
  std::map<bones::BoneKind, int> labels;  // label maps: which label is which bone; else by
                                          // the names of the segments
  std::optional<double>
      threshold;       // grey volumes; for a CT there is a default, other modalities are refused without
  std::string series;  // DICOM: series number or UID
  // Grey volumes: no bone is looked for. The import then holds the images alone, for a case in which the
  // bones are painted.
  bool images_only = false;
  // Label maps: the CT that they were painted in, in the same grid. The surfaces then lie at its edges,
  // between the voxels. Of any other modality it is not used.
  std::filesystem::path edges_in = {};
  // It is of no use without a side: refused as soon as nothing can tell one any more, before the work that is
  // left.
  bool needs_side = false;
  // Volumes: what reading may take, as images::VolumeFileOptions has it.
  std::size_t most_bytes = std::size_t{2} << 30;
};

struct ImportedBone {
  bones::Bone bone;
  bones::MeshRepairReport repair;
  std::vector<std::string> lines;  // what was found, chosen and mended, for a person
  // Why a person should look before relying on it; what is to be said of its side, import_side.h says.
  std::vector<std::string> doubts;
  std::vector<bones::FilledHole> filled_holes = {};  // wide ones (filled_check.h): a doubt, too
  std::vector<bones::ImageCut> image_cuts = {};      // where the images end within it: doubts, too
  std::optional<bones::Space> read_in = {};          // of a mesh: the axes that the file was taken to be in
  bool looks_backwards = false;                      // to the patient's back, which is among the doubts
  // Of which knee its shape is, where that was looked at and it tells; import_side.h holds it against the
  // side.
  bool shape_was_judged = false;
  std::optional<bones::Side> side_by_shape = {};
  // The axes that a mesh is likelier in than those it was read in; nullopt where nothing speaks against
  // these.
  [[nodiscard]] std::optional<bones::Space> likelier_in() const {
    if (!read_in || !looks_backwards) return std::nullopt;
    return *read_in == bones::Space::LPS ? bones::Space::RAS : bones::Space::LPS;
  }
};

// The volume that the bones were made from, for the case to keep.
struct ImportedImage {
  cases::CaseImage image;  // no file yet
  images::EncodedVolume volume;
};

// What told the side of an import. Names and marks are guesses: as good as who wrote them. Of the shapes
// alone it is a doubt.
enum class SideSource { None, Person, SourceName, SegmentName, ImageMark, Fibula, Shapes };
[[nodiscard]] constexpr bool is_guess(SideSource source) {
  return source == SideSource::SourceName || source == SideSource::SegmentName ||
         source == SideSource::ImageMark;
}

struct BoneImport {
  std::vector<ImportedBone> bones;
  std::optional<bones::Side> side;  // nullopt: nothing told it
  SideSource side_source = SideSource::None;
  // What each of these says, whatever told the side: another side is a doubt of the bones.
  std::optional<bones::Side> side_by_fibula;
  std::optional<bones::Side> side_in_images;  // as they are marked, or of both knees show it
  // Without a side: what was asked for it, and why each does not tell it; what would. For a person.
  std::string why_no_side;
  std::vector<std::string> lines;  // about the source
  // Whose bones they are, where the source says so (DICOM does). For identity.json alone: nothing else of the
  // import names a person, nor a file or folder, whose name often is the patient's.
  cases::Identity identity;
  // Of which study the images were, for study.json alone; empty unless they were DICOM.
  images::DicomOrigin origin;
  std::optional<ImportedImage> image;  // nullopt for a mesh

  // Lets go of all that leads to the patient.
  void forget_patient() {
    identity = {};
    origin = {};
  }
};

// Throws IoError, ImportRefused (failure_reason.h) or InvalidInput; a bone that cannot be told from the name
// is InvalidInput that says which option to add. `tell` is called on the same thread whenever there is
// progress. For files from elsewhere use ImportProcess, which does this where it can do no harm.
[[nodiscard]] BoneImport import_bones(
    const std::filesystem::path& source, const BoneImportOptions& options = {},
    const std::function<void(const ImportProgress& progress)>& tell = nullptr);

// From words in a name such as "3_RIGHT_femur.vtk" or "knee-L-tibia.stl"; nullopt when there is none, or
// both.
[[nodiscard]] std::optional<bones::BoneKind> bone_kind_in_name(const std::filesystem::path& source);
[[nodiscard]] std::optional<bones::Side> side_in_name(const std::filesystem::path& source);

// "femur=5,tibia=6". Throws InvalidInput.
[[nodiscard]] std::map<bones::BoneKind, int> labels_from_text(const std::string& text);

}  // namespace arthronaut::importing
