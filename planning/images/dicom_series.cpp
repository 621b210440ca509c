#include <algorithm>
#include <iterator>
#include <set>
#include <utility>

#include "planning/bones/mesh_file.h"
#include "planning/geometry/error.h"
#include "planning/images/dicom_study.h"
#include "planning/images/volume_bytes.h"

namespace arthronaut::images {

namespace {

namespace fs = std::filesystem;

// Of the time that reading takes; the rest goes into the pixels.
constexpr double kHeadersFraction = 0.5;

bool may_be_volume(const DicomSlices& slices) { return slices.size() > 1 && slices.front().has_geometry; }

// A scout or a picture of a screen beside the volume: a lone image that is no slice of it.
bool is_aside(const DicomSlices& slices, const DicomSlices& volume) {
  const DicomSlice &lone = slices.front(), &of_volume = volume.front();
  const bool is_like_a_slice = lone.has_geometry && lone.frame.columns == of_volume.frame.columns &&
                               lone.frame.rows == of_volume.frame.rows &&
                               lone.normal().dot(of_volume.normal()) > 0.99;
  return slices.size() == 1 && !is_like_a_slice;
}

// The first of them, as a sentence lists them.
std::string some_of(const std::vector<fs::path>& files) {
  constexpr std::size_t kMostNamed = 5;
  std::string names;
  for (std::size_t i = 0; i < std::min(files.size(), kMostNamed); ++i)
    names += (i == 0 ? "" : ", ") + files[i].string();
  return files.size() > kMostNamed ? names + " and " + std::to_string(files.size() - kMostNamed) + " more"
                                   : names;
}

// Other volumes, and meshes, are files of their own, each given by its name.
[[noreturn]] void refuse_without_dicom(const fs::path& source, const DicomStudy& study) {
  std::vector<fs::path> volumes, meshes;
  for (const fs::path& other : study.others) {
    if (is_volume_source(other))
      volumes.push_back(other);
    else if (bones::is_mesh_file(other))
      meshes.push_back(other);
  }
  std::string words = "holds no DICOM file";
  if (!volumes.empty()) words += "; name the volume in it itself: " + some_of(volumes);
  if (!meshes.empty())
    words +=
        "; of the meshes in it name one bone's at a time, with --bone femur or --bone tibia and --side "
        "(the second joins the case of the first): " +
        some_of(meshes);
  throw InvalidInput(source, "", words);
}

DicomSlices chosen_series(const fs::path& source, DicomStudy study, const std::string& wanted) {
  if (study.dicom_count == 0) refuse_without_dicom(source, study);
  if (study.series.empty()) throw InvalidInput(source, "", "holds DICOM files, but no image among them");
  std::string list;
  std::vector<DicomSlices*> matching;
  for (auto& [uid, members] : study.series) {
    list += (list.empty() ? "" : "; ") + described(members) + ", UID " + uid;
    if (wanted.empty() || wanted == uid || wanted == members.front().series_number)
      matching.push_back(&members);
  }
  if (matching.empty()) throw InvalidInput(source, "", "holds no series " + wanted + ": " + list);
  const auto volume = std::find_if(matching.begin(), matching.end(),
                                   [](const DicomSlices* slices) { return may_be_volume(*slices); });
  if (volume != matching.end() && matching.size() > 1) {
    const DicomSlices& kept = **volume;
    std::erase_if(matching, [&](const DicomSlices* slices) { return is_aside(*slices, kept); });
  }
  if (matching.size() > 1) {
    throw InvalidInput(source, "",
                       "holds " + std::to_string(study.series.size()) +
                           " series, name one with --series NUMBER or UID: " + list);
  }
  return std::move(*matching.front());
}

// What is broken and of another series keeps nobody from this one. Of what does not say its series the slices
// tell whether one is missing between them (stacked()). Throws what its reading threw for one of this series.
std::vector<std::string> left_out_beside(const DicomSlices& chosen, const std::vector<BrokenDicom>& broken) {
  std::vector<std::string> lines;
  for (const BrokenDicom& one : broken) {
    if (one.series_uid == chosen.front().series_uid) std::rethrow_exception(one.error);
    const std::string& why = one.skipped.reason;
    lines.push_back(
        "left out: " + one.skipped.file.filename().string() + ": " + why +
        (one.series_uid.empty() ? "; it does not say which series it is of" : "; of another series"));
  }
  constexpr std::size_t kMostNamed = 5;
  if (lines.size() <= kMostNamed) return lines;
  const std::size_t more = lines.size() - kMostNamed;
  lines.resize(kMostNamed);
  lines.push_back("left out: " + std::to_string(more) + " more broken " + (more == 1 ? "file" : "files"));
  return lines;
}

// Of one series, so its first slice speaks for all; the images are all that are of its class.
DicomOrigin origin_of(const DicomSlices& slices) {
  DicomOrigin origin = *slices.front().origin;
  std::set<const DicomOrigin*> seen{slices.front().origin.get()};
  for (const DicomSlice& slice : slices) {
    // Frames of one file share theirs.
    if (slice.origin->sop_class_uid != origin.sop_class_uid || !seen.insert(slice.origin.get()).second)
      continue;
    const auto& uids = slice.origin->sop_instance_uids;
    origin.sop_instance_uids.insert(origin.sop_instance_uids.end(), uids.begin(), uids.end());
  }
  return origin;
}

// What most slices leave out some of them may say; where two say different things nothing is known.
std::optional<bones::Side> side_of_all(const DicomSlices& slices) {
  std::optional<bones::Side> all;
  for (const DicomSlice& slice : slices) {
    if (slice.side && all && *slice.side != *all) return std::nullopt;
    if (slice.side) all = slice.side;
  }
  return all;
}

}  // namespace

Volume read_dicom(const fs::path& source, const VolumeFileOptions& options) {
  DicomStudy study = read_dicom_study(source, options.most_bytes,
                                      [&](double fraction) { report(options, kHeadersFraction * fraction); });
  const std::vector<BrokenDicom> broken = std::exchange(study.broken, {});
  if (study.series.empty() && !broken.empty()) std::rethrow_exception(broken.front().error);
  DicomSlices chosen = chosen_series(source, std::move(study), options.series);
  const std::vector<std::string> left_out = left_out_beside(chosen, broken);
  const std::string description = described(chosen);
  DicomStack stack = stacked(source, std::move(chosen));
  DicomSlices& slices = stack.slices;
  const DicomSlice& first = slices.front();
  if (options.on_origin) options.on_origin(origin_of(slices));
  Volume volume;
  volume.format = "DICOM";
  volume.notes = {description};
  volume.notes.insert(volume.notes.end(), stack.notes.begin(), stack.notes.end());
  volume.notes.insert(volume.notes.end(), left_out.begin(), left_out.end());
  volume.modality_in_file = first.modality;
  volume.patient = first.patient;
  volume.side = side_of_all(slices);
  volume.size = {first.frame.columns, first.frame.rows, static_cast<int>(slices.size())};
  volume.values.reserve(checked_voxel_count(source, volume.size, 0, options.most_bytes));
  volume.lps_from_index.linear().col(0) = first.along_columns * first.column_spacing_mm;
  volume.lps_from_index.linear().col(1) = first.along_rows * first.row_spacing_mm;
  volume.lps_from_index.linear().col(2) = stack.step_mm;
  volume.lps_from_index.translation() = first.position_mm;
  for (std::size_t i = 0; i < slices.size(); ++i) {
    append_pixels(slices[i], volume.values);
    slices[i].pixels.reset();  // what a codec has kept goes with them
    const double done = static_cast<double>(i + 1) / static_cast<double>(slices.size());
    report(options, kHeadersFraction + (1 - kHeadersFraction) * done);
  }
  finish(volume, source);
  return volume;
}

}  // namespace arthronaut::images
