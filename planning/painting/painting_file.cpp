#include "planning/painting/painting_file.h"

#include <cmath>

#include "planning/files/private_folder.h"
#include "planning/geometry/error.h"
#include "planning/images/volume_file.h"
#include "planning/images/volume_writer.h"

namespace arthronaut::painting {

namespace {

namespace fs = std::filesystem;

Labels read_labels(const fs::path& file, const images::Volume& grid) {
  if (!fs::exists(file)) return Labels(grid.values.size(), kNothing);
  const images::Volume read = images::read_volume(file);
  // What is written is read back exactly; another program may round.
  const double off_mm = (read.lps_from_index.matrix() - grid.lps_from_index.matrix()).cwiseAbs().maxCoeff();
  if (read.size != grid.size || off_mm > 1e-3)
    throw InvalidInput(file, "", "was painted in the grid of another image than the case's");
  Labels labels(read.values.size());
  for (std::size_t v = 0; v < labels.size(); ++v) {
    const float value = read.values[v];
    if (!(value >= 0 && value <= kSurroundings) || value != std::floor(value))
      throw InvalidInput(file, "",
                         "holds labels that stand for nothing: 1 is femur, 2 tibia, 3 surroundings");
    labels[v] = static_cast<std::uint8_t>(value);
  }
  return labels;
}

}  // namespace

fs::path strokes_file(const fs::path& case_folder) { return case_folder / "painting" / "strokes.nrrd"; }
fs::path bones_file(const fs::path& case_folder) { return case_folder / "painting" / "bones.nrrd"; }

void save_painting(const fs::path& case_folder, const images::Volume& grid, const SavedPainting& painting) {
  const std::vector<images::Segment> bones{{"Femur", kFemur}, {"Tibia", kTibia}};
  std::vector<images::Segment> strokes = bones;
  strokes.push_back({"Surroundings", kSurroundings});
  files::create_private_folder(case_folder / "painting");
  images::write_volume(strokes_file(case_folder), images::encoded_labels(grid, painting.strokes, strokes));
  images::write_volume(bones_file(case_folder), images::encoded_labels(grid, painting.bones, bones));
}

std::optional<SavedPainting> load_painting(const fs::path& case_folder, const images::Volume& grid) {
  if (!fs::exists(strokes_file(case_folder)) && !fs::exists(bones_file(case_folder))) return std::nullopt;
  return SavedPainting{read_labels(strokes_file(case_folder), grid),
                       read_labels(bones_file(case_folder), grid)};
}

}  // namespace arthronaut::painting
