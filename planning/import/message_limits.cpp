#include "planning/import/message_limits.h"

#include <cmath>

#include "planning/geometry/error.h"

namespace arthronaut::importing {

namespace {

// Every text that may be as long as a file likes.
template <typename Use>
void with_each_text(images::SeriesList& list, const Use& use) {
  const auto use_path = [&](std::filesystem::path& path) {
    std::string text = path.string();
    use(text);
    path = text;
  };
  for (images::ImageSeries& series : list.series) {
    for (std::string* text :
         {&series.uid, &series.number, &series.format, &series.modality, &series.description,
          &series.patient_name, &series.patient_id, &series.study_date, &series.refusal})
      use(*text);
    for (std::string& warning : series.warnings) use(warning);
    for (std::filesystem::path& file : series.files) use_path(file);
  }
  for (images::SkippedFile& skipped : list.skipped) {
    use_path(skipped.file);
    use(skipped.reason);
  }
}

}  // namespace

std::string clipped(std::string text) {
  if (text.size() <= kLongestText_bytes) return text;
  std::size_t end = kLongestText_bytes;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0U) == 0x80U) --end;
  text.resize(end);
  return text;
}

void clip_texts(images::SeriesList& list) {
  with_each_text(list, [](std::string& text) { text = clipped(std::move(text)); });
}

void refuse_unsound(const ImportProgress& progress) {
  if (progress.stage > ImportStage::LookingAtBones || !std::isfinite(progress.fraction))
    throw InvalidInput("the importing process sent a progress that is none");
}

void refuse_unsound(const Failure& failure) {
  bool is_sound = failure.words.size() <= kLongestText_bytes &&
                  failure.reason <= FailureReason::NeedsLabels && std::isfinite(failure.size_in_file);
  for (const bones::LengthUnit unit : failure.units)
    is_sound = is_sound && unit >= bones::LengthUnit::Millimetre && unit <= bones::LengthUnit::Inch;
  for (const FoundLabel& label : failure.labels)
    is_sound = is_sound && std::isfinite(label.volume_cm3) && label.lowest_mm.allFinite() &&
               label.highest_mm.allFinite();
  if (!is_sound) throw InvalidInput("the importing process sent a failure that is none");
}

void refuse_unsound(images::SeriesList& list) {
  constexpr int kMostImages = 100'000'000;
  bool is_sound = true;
  with_each_text(list,
                 [&](const std::string& text) { is_sound = is_sound && text.size() <= kLongestText_bytes; });
  for (const images::ImageSeries& series : list.series)
    is_sound = is_sound && series.image_count >= 0 && series.image_count <= kMostImages &&
               series.size.minCoeff() >= 0 && series.spacing_mm.allFinite();
  if (!is_sound) throw InvalidInput("the importing process sent a list of series that is none");
}

// A picture without pixels is none, and has no size.
void refuse_unsound(const SeriesPicture& picture) {
  const auto& [width, height, grey] = picture.thumbnail;
  const auto is_side = [](int side) { return side >= 1 && side <= kLongestPictureSide; };
  const bool is_none = width == 0 && height == 0 && grey.empty();
  const bool is_picture =
      is_side(width) && is_side(height) && grey.size() == static_cast<std::size_t>(width * height);
  if ((!is_none && !is_picture) || picture.refusal.size() > kLongestText_bytes)
    throw InvalidInput("the importing process sent a picture that is none");
}

void refuse_unsound(const BoneImport& import) {
  bool is_sound = import.side_source >= SideSource::None && import.side_source <= SideSource::Shapes;
  for (const auto& side : {import.side, import.side_by_fibula, import.side_in_images})
    is_sound = is_sound && (!side || *side == bones::Side::Left || *side == bones::Side::Right);
  if (!is_sound) throw InvalidInput("the importing process sent a side that is none");
  for (const ImportedBone& imported : import.bones) {
    const geometry::TriangleMesh& mesh = imported.bone.mesh;
    const auto count = static_cast<std::int64_t>(mesh.vertices_mm.size());
    is_sound =
        (imported.bone.kind == bones::BoneKind::Femur || imported.bone.kind == bones::BoneKind::Tibia) &&
        (!imported.read_in || *imported.read_in == bones::Space::LPS ||
         *imported.read_in == bones::Space::RAS);
    for (const Eigen::Vector3d& p : mesh.vertices_mm) is_sound = is_sound && p.allFinite();
    for (const bones::FilledHole& hole : imported.filled_holes)
      is_sound = is_sound && hole.at_mm.allFinite() && std::isfinite(hole.across_mm) && hole.across_mm > 0;
    for (const bones::ImageCut& cut : imported.image_cuts) is_sound = is_sound && cut.is_sound();
    for (const auto& triangle : mesh.triangles) {
      for (const std::int32_t corner : triangle) is_sound = is_sound && corner >= 0 && corner < count;
    }
    if (!is_sound) throw InvalidInput("the importing process sent a bone that is none");
  }
}

}  // namespace arthronaut::importing
