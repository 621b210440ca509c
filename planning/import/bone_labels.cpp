#include "planning/import/bone_labels.h"

#include <algorithm>

#include "planning/geometry/error.h"
#include "planning/images/bone_surface.h"
#include "planning/import/cut_check.h"
#include "planning/segmentation/anatomy_check.h"

namespace arthronaut::importing {

namespace {

using bones::BoneKind;

// The end of a bone at the knee; cartilage and the fibula's end are less.
constexpr double kLeast_mm3 = 15'000;
constexpr std::size_t kMostLabels = 12;

bool has_shape_of(BoneKind kind, const geometry::TriangleMesh& mesh, const images::Volume& volume) {
  std::vector<Eigen::Vector3d> image_ends;
  for (const bones::ImageCut& cut : cuts_of(mesh, kind, volume)) image_ends.push_back(cut.out);
  return segmentation::anatomy_doubts(mesh, kind, image_ends).empty();
}

struct Shape {
  int label = 0;
  double middle_up_mm = 0;
};

}  // namespace

std::vector<std::string> words_in(const std::string& name) {
  std::vector<std::string> words(1);
  for (const char c : name) {
    const bool is_upper = c >= 'A' && c <= 'Z', is_lower = c >= 'a' && c <= 'z';
    if (is_upper || is_lower) {
      words.back() += is_upper ? static_cast<char>(c - 'A' + 'a') : c;
    } else {
      words.emplace_back();
    }
  }
  return words;
}

std::map<BoneKind, int> labels_by_name(const images::Volume& volume, std::vector<std::string>& lines) {
  std::map<BoneKind, int> labels;
  for (const BoneKind kind : {BoneKind::Femur, BoneKind::Tibia}) {
    std::vector<const images::Segment*> named;
    for (const images::Segment& segment : volume.segments) {
      const auto words = words_in(segment.name);
      const std::string word(bones::to_text(kind));
      const bool is_part = std::any_of(words.begin(), words.end(), [](const std::string& w) {
        return w.starts_with("cart") || w == "cancellous" || w == "marrow";
      });
      if (!is_part && std::any_of(words.begin(), words.end(),
                                  [&](const std::string& w) { return w.find(word) != std::string::npos; }))
        named.push_back(&segment);
    }
    if (named.size() != 1) continue;
    labels[kind] = named.front()->label;
    lines.push_back("segment \"" + named.front()->name + "\" is the " + std::string(bones::to_text(kind)));
  }
  return labels;
}

std::map<BoneKind, int> labels_by_shape(const images::Volume& volume, std::vector<std::string>& lines) {
  const double voxel_mm3 = volume.spacing_mm().prod();
  std::vector<std::pair<int, std::size_t>> large;
  for (const auto& label : images::labels_of(volume))
    if (label.first > 0 && static_cast<double>(label.second) * voxel_mm3 >= kLeast_mm3)
      large.push_back(label);
  if (large.size() > kMostLabels) return {};
  std::map<BoneKind, std::vector<Shape>> found;
  for (const auto& [label, count] : large) {
    geometry::TriangleMesh mesh;
    try {
      mesh = images::surface_of_label(volume, label).mesh;
    } catch (const InvalidInput&) {
      continue;  // no surface can be made of it: it is no bone
    }
    for (const BoneKind kind : {BoneKind::Femur, BoneKind::Tibia})
      if (has_shape_of(kind, mesh, volume))
        found[kind].push_back({label, geometry::bounds_of(mesh).center_mm().z()});
  }
  const std::vector<Shape>&femora = found[BoneKind::Femur], &tibiae = found[BoneKind::Tibia];
  if (femora.size() != 1 || tibiae.size() != 1 || femora.front().label == tibiae.front().label ||
      femora.front().middle_up_mm <= tibiae.front().middle_up_mm)
    return {};
  lines.push_back("label " + std::to_string(femora.front().label) + " alone has a femur's shape, and label " +
                  std::to_string(tibiae.front().label) +
                  ", below it, a tibia's: they are taken for the bones");
  return {{BoneKind::Femur, femora.front().label}, {BoneKind::Tibia, tibiae.front().label}};
}

}  // namespace arthronaut::importing
