#include "planning/import/bone_import.h"

#include <algorithm>
#include <charconv>
#include <map>

#include "planning/bones/unit_unknown.h"
#include "planning/files/format.h"
#include "planning/files/pipe.h"
#include "planning/geometry/error.h"
#include "planning/images/bone_surface.h"
#include "planning/images/volume_file.h"
#include "planning/import/bone_labels.h"
#include "planning/import/cut_check.h"
#include "planning/import/failure_reason.h"
#include "planning/import/filled_check.h"
#include "planning/import/hole_check.h"
#include "planning/import/import_side.h"
#include "planning/import/shape_check.h"
#include "planning/import/slice_check.h"
#include "planning/segmentation/ct_bones.h"
#include "planning/segmentation/label_surface.h"

namespace arthronaut::importing {

namespace {

using bones::BoneKind;
using bones::Side;
using namespace images;

using Tell = std::function<void(const ImportProgress&)>;

std::vector<std::string> words_of(const std::filesystem::path& source) {
  std::filesystem::path named = source;
  if (!named.has_filename()) named = named.parent_path();  // "folder/"
  return words_in(named.filename().string());
}

// The one of two answers whose word occurs, when the other's does not.
template <typename T, typename Matches>
std::optional<T> only_one(const std::vector<std::string>& words, T first, T second, const Matches& matches) {
  const auto occurs = [&](T value) {
    return std::any_of(words.begin(), words.end(),
                       [&](const std::string& word) { return matches(word, value); });
  };
  const bool has_first = occurs(first), has_second = occurs(second);
  if (has_first == has_second) return std::nullopt;
  return has_first ? first : second;
}

// "right", "R"
bool says_side(const std::string& word, Side side) {
  return word == bones::to_text(side) || word == bones::to_text(side).substr(0, 1);
}

std::string formatted_size(const Eigen::Vector3d& size) {
  return files::format("%.1f x %.1f x %.1f mm (left-right x front-back x up-down)", size.x(), size.y(),
                       size.z());
}

// images: that it was made of; null for a mesh.
ImportedBone finished(BoneKind kind, const std::string& source, const geometry::TriangleMesh& mesh,
                      const Volume* images, const Tell& tell) {
  tell({ImportStage::MendingMesh});
  bones::MeshRepair repair = bones::mend_mesh(mesh);
  ImportedBone imported;
  imported.repair = repair.report;
  imported.bone = {kind, std::move(repair.mesh), source};
  const geometry::Bounds bounds = geometry::bounds_of(imported.bone.mesh);
  imported.lines.push_back(std::to_string(repair.report.triangles_now) + " triangles, " +
                           formatted_size(bounds.size_mm()));
  for (const auto& line : repair.report.lines()) imported.lines.push_back("mended: " + line);
  imported.doubts = repair.report.doubts();
  if (images != nullptr) imported.image_cuts = cuts_of(imported.bone.mesh, kind, *images);
  imported.filled_holes = wide_holes(std::move(repair.filled), imported.bone.mesh, kind);
  // Of a mesh that is no bone at all there is enough to say already.
  if (!imported.doubts.empty()) return imported;
  std::vector<Eigen::Vector3d> image_ends;
  for (const bones::ImageCut& cut : imported.image_cuts)
    if (cut.is_wide()) image_ends.push_back(cut.out);
  imported.doubts = shape_doubts(imported.bone.mesh, kind, image_ends);
  return imported;
}

ImportRefused refusal(const std::filesystem::path& source, const std::string& words, Failure failure) {
  failure.words = InvalidInput(source, "", words).what();
  return ImportRefused(std::move(failure));
}

[[noreturn]] void ask_for_kind(const std::filesystem::path& source) {
  throw InvalidInput(source, "", "its name does not say which bone it is: add --bone femur or --bone tibia");
}

bones::MeshFile read_asking_for_unit(const std::filesystem::path& source, const BoneImportOptions& options) {
  try {
    return bones::read_mesh_file(source, {options.space, options.unit});
  } catch (const bones::UnitUnknown& error) {
    if (error.fitting_units().empty()) throw;
    throw ImportRefused({.reason = FailureReason::NeedsUnit,
                         .words = error.what(),
                         .size_in_file = error.size_in_file(),
                         .units = error.fitting_units()});
  }
}

void import_mesh(const std::filesystem::path& source, const BoneImportOptions& options, BoneImport& result,
                 const Tell& tell) {
  if (!options.labels.empty() || options.threshold || !options.series.empty()) {
    throw InvalidInput(source, "", "is a mesh: --label, --threshold and --series are for volumes");
  }
  refuse_empty_file(source);  // before anything is asked about it
  const auto kind = options.kind ? options.kind : bone_kind_in_name(source);
  if (!kind) ask_for_kind(source);
  tell({ImportStage::Reading});
  const bones::MeshFile file = read_asking_for_unit(source, options);
  const char* said_by = options.space             ? "as --space says"
                        : file.space_was_declared ? "as the file says"
                                                  : "the file does not say";
  result.lines.push_back(file.format + ", in " + std::string(bones::to_text(file.unit_in_file)) + ", " +
                         (file.space_in_file == bones::Space::LPS ? "LPS" : "RAS") + " (" + said_by + ")");
  try {
    result.bones.push_back(finished(*kind, file.format, file.mesh, nullptr, tell));
    result.bones.back().read_in = file.space_in_file;
  } catch (const InvalidInput& error) {
    throw InvalidInput(source, "", error.what());
  }
}

void refuse_without_threshold(const Volume& volume, const std::filesystem::path& source,
                              const BoneImportOptions& options) {
  if (options.threshold || volume.modality == Modality::Ct) return;
  throw refusal(
      source,
      "is no CT, so there is no threshold that finds bone: paint seeds and grow them (arthronaut segment), "
      "give --threshold, or import a label map or a mesh of it",
      {.reason = FailureReason::IsNoCt});
}

// Each with its segment's name, where it has one.
std::string list_of(const std::vector<std::pair<int, std::size_t>>& labels,
                    const std::vector<images::Segment>& segments) {
  std::string list;
  for (const auto& [value, count] : labels) {
    if (value == 0) continue;
    list += (list.empty() ? "" : ", ") + std::to_string(value);
    const auto named = std::ranges::find(segments, value, &images::Segment::label);
    if (named != segments.end()) list += " (" + named->name + ")";
  }
  return list;
}

// nullopt where the surfaces are the labels' own.
std::optional<Volume> ct_of(const Volume& labels, const BoneImportOptions& options, const Tell& tell) {
  if (options.edges_in.empty()) return std::nullopt;
  VolumeFileOptions reading{.series = {}, .most_bytes = options.most_bytes};
  reading.on_progress = [&](double fraction) { tell({ImportStage::ReadingImages, fraction}); };
  Volume grey = read_volume(options.edges_in, reading);
  if (grey.modality != Modality::Ct) return std::nullopt;
  if (grey.size != labels.size || !grey.lps_from_index.isApprox(labels.lps_from_index, 1e-5))
    throw InvalidInput(options.edges_in, "", "is not the image that the labels were painted in");
  return grey;
}

// The words of the segments that are taken may tell the side, as those of the file's name do. Where names
// tell both, none is believed.
void take_side_of_segments(const Volume& volume, const std::map<BoneKind, int>& labels,
                           const BoneImportOptions& options, BoneImport& result) {
  if (options.side) return;
  std::vector<std::string> words, names;
  if (result.side) words.emplace_back(bones::to_text(*result.side));
  for (const auto& [kind, label] : labels) {
    if (options.kind && *options.kind != kind) continue;
    for (const Segment& segment : volume.segments) {
      if (segment.label != label) continue;
      const auto in_name = words_in(segment.name);
      if (std::ranges::none_of(in_name, [](const auto& word) {
            return says_side(word, Side::Left) || says_side(word, Side::Right);
          }))
        continue;
      words.insert(words.end(), in_name.begin(), in_name.end());
      names.push_back(segment.name);
    }
  }
  if (names.empty()) return;
  result.side = only_one(words, Side::Left, Side::Right, says_side);
  result.side_source = result.side ? SideSource::SegmentName : SideSource::None;
  result.lines.push_back(result.side ? "segment \"" + names.front() + "\" says that it is a " +
                                           std::string(bones::to_text(*result.side)) + " knee"
                                     : "segment \"" + names.front() +
                                           "\" and the other names do not say the same side: none is taken");
}

void import_labels(const Volume& volume, const std::map<BoneKind, int>& labels,
                   const BoneImportOptions& options, BoneImport& result, const Tell& tell) {
  take_side_of_segments(volume, labels, options, result);
  const std::optional<Volume> ct = ct_of(volume, options, tell);
  for (const auto& [kind, label] : labels) {
    if (options.kind && *options.kind != kind) continue;
    tell({ImportStage::MakingSurface});
    BoneSurface surface;
    if (ct) {
      surface.mesh = segmentation::label_surface_at_edges(*ct, volume, label);
      surface.notes.emplace_back("the surface lies at the edge that the CT shows");
    } else {
      surface = surface_of_label(volume, label);
    }
    result.bones.push_back(finished(kind, "label " + std::to_string(label) + " of " + volume.format,
                                    surface.mesh, &volume, tell));
    auto& lines = result.bones.back().lines;
    lines.insert(lines.begin(), surface.notes.begin(), surface.notes.end());
  }
  if (result.bones.empty()) throw InvalidInput("--label does not name the bone of --bone");
}

// Returns why the fibula does not tell the side; empty where it does.
std::string import_ct(const Volume& volume, const BoneImportOptions& options, BoneImport& result,
                      const Tell& tell) {
  segmentation::CtBonesOptions ct;
  ct.threshold = options.threshold;
  ct.only = options.kind;
  ct.side = result.side;
  ct.tell = [&](double fraction) { tell({ImportStage::FindingBones, fraction}); };
  const segmentation::CtBones found = segmentation::bones_of_ct(volume, ct);
  result.lines.insert(result.lines.end(), found.notes.begin(), found.notes.end());
  result.side_by_fibula = found.side_by_fibula;
  // Where it lies beside the other one is as good as a mark.
  if (found.is_one_of_both && !result.side_in_images) result.side_in_images = options.side;
  for (const segmentation::CtBone& bone : found.bones) {
    result.bones.push_back(finished(bone.kind, volume.format, bone.mesh, &volume, tell));
    ImportedBone& imported = result.bones.back();
    imported.lines.insert(imported.lines.begin(), bone.notes.begin(), bone.notes.end());
    imported.doubts.insert(imported.doubts.begin(), bone.doubts.begin(), bone.doubts.end());
  }
  if (!result.side && result.side_by_fibula) {
    result.side = result.side_by_fibula;
    result.side_source = SideSource::Fibula;
    result.lines.push_back("the fibula says that it is a " + std::string(bones::to_text(*result.side)) +
                           " knee");
  }
  return found.why_no_fibula;
}

void import_volume(const std::filesystem::path& source, const BoneImportOptions& options, BoneImport& result,
                   const Tell& tell) {
  if (options.space || options.unit) {
    throw InvalidInput(
        source, "", "is a volume, which says its space and unit itself: --space and --unit are for meshes");
  }
  VolumeFileOptions reading{.series = options.series, .most_bytes = options.most_bytes};
  reading.on_progress = [&](double fraction) { tell({ImportStage::Reading, fraction}); };
  reading.on_origin = [&](const DicomOrigin& origin) { result.origin = origin; };
  const Volume volume = read_volume(source, reading);
  const Eigen::Vector3d spacing = volume.spacing_mm();
  result.lines.push_back(volume.format + ", " +
                         files::format("%d x %d x %d voxels of %.3g x %.3g x %.3g mm, ", volume.size.x(),
                                       volume.size.y(), volume.size.z(), spacing.x(), spacing.y(),
                                       spacing.z()) +
                         axes_in_words(volume));
  result.lines.insert(result.lines.end(), volume.notes.begin(), volume.notes.end());

  take_side_of_images(result, volume.side, options.side.has_value());
  result.identity = {volume.patient.name, volume.patient.id, volume.patient.birth_date};
  const bool has_labels = is_label_map(volume);
  bool is_ct = false;
  std::string of_fibula;
  try {
    if (options.images_only) {
      if (has_labels) throw InvalidInput("is a label map: there is no image to paint in");
    } else if (!options.labels.empty()) {
      import_labels(volume, options.labels, options, result, tell);
    } else if (has_labels && !options.threshold) {
      auto named = labels_by_name(volume, result.lines);
      if (named.empty() && volume.segments.empty()) {
        tell({ImportStage::LookingAtBones});
        named = labels_by_shape(volume, result.lines);
      }
      if (named.empty() || (options.kind && !named.contains(*options.kind))) {
        const auto labels = labels_of(volume);
        throw refusal(source,
                      "is a label map with the labels " + list_of(labels, volume.segments) +
                          ": say which are the bones: --label femur=NUMBER" +
                          (labels.size() > 2 ? ",tibia=NUMBER" : ""),
                      {.reason = FailureReason::NeedsLabels, .labels = found_labels(volume)});
      }
      import_labels(volume, named, options, result, tell);
    } else {
      refuse_without_threshold(volume, source, options);
      is_ct = true;
      of_fibula = import_ct(volume, options, result, tell);
    }
    if (options.needs_side && !options.images_only && !result.side && !shapes_may_tell(result))
      throw InvalidInput(why_no_side(result, of_fibula));
  } catch (const segmentation::ShowsBothKnees& error) {
    throw refusal(source, error.what(), {.reason = FailureReason::ShowsBothKnees});
  } catch (const InvalidInput& error) {
    // Those of the surface speak of "the volume": the file's name goes before it, once.
    const std::string message = error.what();
    if (message.starts_with(source.string())) throw;
    throw InvalidInput(source, "", message);
  }
  result.image = ImportedImage{.image = {.file = {},
                                         .modality = volume.modality_in_file,
                                         .source = volume.format,
                                         .is_label_map = has_labels,
                                         .size = volume.size,
                                         .spacing_mm = spacing},
                               .volume = encoded(volume)};
  tell({ImportStage::LookingAtBones});
  check_shapes(result, result.side_by_fibula.has_value());
  if (!result.side) result.why_no_side = why_no_side(result, of_fibula);
  check_holes(result);
  if (is_ct && !options.kind && result.bones.size() == 1)
    result.bones.front().doubts.push_back(
        std::string("the volume shows no ") +
        (result.bones.front().bone.kind == BoneKind::Femur ? "tibia" : "femur"));
  if (const std::string of_slices = slice_doubt(volume); !of_slices.empty())
    for (ImportedBone& imported : result.bones) imported.doubts.push_back(of_slices);
}

}  // namespace

BoneImport import_bones(const std::filesystem::path& source, const BoneImportOptions& options,
                        const Tell& listener) {
  const Tell tell = [&](const ImportProgress& progress) {
    if (listener) listener(progress);
  };
  if (!std::filesystem::exists(source)) throw IoError(source, "does not exist");
  files::refuse_pipe(source);
  BoneImport result;
  result.side = options.side ? options.side : side_in_name(source);
  result.side_source = options.side  ? SideSource::Person
                       : result.side ? SideSource::SourceName
                                     : SideSource::None;
  if (bones::is_mesh_file(source) && !std::filesystem::is_directory(source)) {
    import_mesh(source, options, result, tell);
    tell({ImportStage::LookingAtBones});
    check_shapes(result, false);
    check_holes(result);
  } else if (is_volume_source(source)) {
    import_volume(source, options, result, tell);
  } else {
    throw InvalidInput(
        source, "",
        "is nothing that is imported: a mesh (STL, PLY, OBJ, VTK, VTP), DICOM, or a volume (NIfTI, NRRD, "
        "MetaImage)");
  }
  return result;
}

std::optional<BoneKind> bone_kind_in_name(const std::filesystem::path& source) {
  return only_one(words_of(source), BoneKind::Femur, BoneKind::Tibia,
                  [](const std::string& word, BoneKind kind) {
                    return word.find(kind == BoneKind::Femur ? "femur" : "tibia") != std::string::npos;
                  });
}

std::optional<Side> side_in_name(const std::filesystem::path& source) {
  return only_one(words_of(source), Side::Left, Side::Right, says_side);
}

std::map<BoneKind, int> labels_from_text(const std::string& text) {
  std::map<BoneKind, int> labels;
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t end = std::min(text.find(',', at), text.size());
    const std::string part = text.substr(at, end - at);
    const auto equals = part.find('=');
    int label = 0;
    const char* begin = part.data() + std::min(equals, part.size() - 1) + 1;
    const auto [stop, error] = std::from_chars(begin, part.data() + part.size(), label);
    if (equals == std::string::npos || error != std::errc() || stop != part.data() + part.size()) {
      throw InvalidInput("\"" + part + "\" is not BONE=NUMBER, as in femur=5,tibia=6");
    }
    if (!labels.emplace(bones::bone_kind_from_text(part.substr(0, equals)), label).second) {
      throw InvalidInput("names " + part.substr(0, equals) + " twice");
    }
    at = end + 1;
  }
  return labels;
}

}  // namespace arthronaut::importing
