#include "app/start/side_slices.h"

#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "app/scene/reslice.h"
#include "app/widgets/list_rows.h"
#include "app/widgets/wrapped_text.h"
#include "planning/files/format.h"
#include "planning/images/volume_decoder.h"

namespace arthronaut::start {

namespace {

using Eigen::Vector3d;

constexpr int kLongestSide_px = 480;
// The fibula's head lies behind and beside the tibia's, its widest 15 to 25 mm below the joint; further down
// the two stand apart.
constexpr double kHead_mm = 30, kNear_mm = 25, kFar_mm = 80, kLeastFar_mm = 8;
constexpr double kOverEdge_mm = 3;  // above the lowest of the tibia: a slice of it that is whole
// Bone of any density, and soft tissue still told from it.
constexpr scene::GreyWindow kBoneInTissue{350, 1100};

geometry::Bounds box_of(const images::Volume& volume) {
  geometry::Bounds box{Vector3d::Constant(std::numeric_limits<double>::infinity()), {}};
  box.max_mm = -box.min_mm;
  for (int corner = 0; corner < 8; ++corner) {
    const Eigen::Vector3i pick(corner & 1, (corner >> 1) & 1, (corner >> 2) & 1);
    const Vector3d at =
        volume.lps_from_index * pick.cwiseProduct(volume.size - Eigen::Vector3i::Ones()).cast<double>();
    box.min_mm = box.min_mm.cwiseMin(at);
    box.max_mm = box.max_mm.cwiseMax(at);
  }
  return box;
}

struct Place {
  std::string words;
  Vector3d center_mm, down;
};

// z grows to the head, y to the back.
std::vector<Place> places_in(const geometry::Bounds& box) {
  const auto at = [&](double y, double z) -> Vector3d {
    return box.min_mm + Vector3d(0.5, y, z).cwiseProduct(box.size_mm());
  };
  return {{"From in front, in the middle", at(0.5, 0.5), -Vector3d::UnitZ()},
          {"From in front, further back", at(0.65, 0.5), -Vector3d::UnitZ()},
          {"Across, a quarter of the way up", at(0.5, 0.25), Vector3d::UnitY()},
          {"Across, near the lower end", at(0.5, 0.1), Vector3d::UnitY()}};
}

double far_mm(const FoundTibia& tibia) {
  return std::min(kFar_mm, tibia.joint_z_mm - tibia.lowest_z_mm - kOverEdge_mm);
}

// What of the images is shown; tibia and fibula with what lies about them.
geometry::Bounds region_about(const FoundTibia& tibia) {
  constexpr double kBeside_mm = 30, kInFront_mm = 15, kBehind_mm = 35, kAbove_mm = 40;
  Vector3d low = tibia.head.min_mm - Vector3d(kBeside_mm, kInFront_mm, 0),
           high = tibia.head.max_mm + Vector3d(kBeside_mm, kBehind_mm, 0);
  low.z() = tibia.joint_z_mm - far_mm(tibia) - kOverEdge_mm;
  high.z() = tibia.joint_z_mm + kAbove_mm;
  return {low, high};
}

std::vector<Place> places_at(const FoundTibia& tibia, const geometry::Bounds& region) {
  constexpr double kBack = 0.95;  // of the head's depth: what is left of it stands beside the fibula's
  const double far = far_mm(tibia), near = std::min(kNear_mm, 0.6 * far);
  const auto in_front = [&](const char* words, double share) -> Place {
    Vector3d center = region.center_mm();
    center.y() = tibia.head.min_mm.y() + share * tibia.head.size_mm().y();
    return {words, center, -Vector3d::UnitZ()};
  };
  const auto across = [&](double below_mm) -> Place {
    Vector3d center = region.center_mm();
    center.z() = tibia.joint_z_mm - below_mm;
    return {files::format("Across, %.0f mm below the %s", below_mm,
                          tibia.is_joint_by_femur ? "joint" : "tibia's top"),
            center, Vector3d::UnitY()};
  };
  return {in_front("From in front, middle of the tibia", 0.5),
          in_front("From in front, back of the tibia", kBack), across(near), across(far)};
}

}  // namespace

std::optional<FoundTibia> found_tibia(const importing::BoneImport& import) {
  const auto mesh_of = [&](bones::BoneKind kind) -> const geometry::TriangleMesh* {
    for (const importing::ImportedBone& bone : import.bones)
      if (bone.bone.kind == kind && !bone.bone.mesh.vertices_mm.empty()) return &bone.bone.mesh;
    return nullptr;
  };
  const geometry::TriangleMesh* const tibia = mesh_of(bones::BoneKind::Tibia);
  if (tibia == nullptr) return std::nullopt;
  const geometry::Bounds all = geometry::bounds_of(*tibia);
  FoundTibia found{.joint_z_mm = all.max_mm.z(), .lowest_z_mm = all.min_mm.z()};
  // The condyles stand on the plateau, below the tip of its eminence.
  if (const auto* femur = mesh_of(bones::BoneKind::Femur)) {
    constexpr double kWidestGap_mm = 20;
    const double condyles_z_mm = geometry::bounds_of(*femur).min_mm.z();
    found.is_joint_by_femur =
        condyles_z_mm > found.lowest_z_mm && condyles_z_mm < all.max_mm.z() + kWidestGap_mm;
    if (found.is_joint_by_femur) found.joint_z_mm = condyles_z_mm;
  }
  if (far_mm(found) < kLeastFar_mm) return std::nullopt;
  found.head = {all.max_mm, all.min_mm};
  for (const Vector3d& vertex : tibia->vertices_mm) {
    if (vertex.z() < found.joint_z_mm - kHead_mm) continue;
    found.head.min_mm = found.head.min_mm.cwiseMin(vertex);
    found.head.max_mm = found.head.max_mm.cwiseMax(vertex);
  }
  return found;
}

std::vector<SideSlice> side_slices(const images::Volume& volume, const std::optional<FoundTibia>& tibia,
                                   int longest_side_px) {
  geometry::Bounds shown = box_of(volume);
  std::vector<Place> places = places_in(shown);
  if (tibia) {
    const geometry::Bounds about = region_about(*tibia);
    const geometry::Bounds region{about.min_mm.cwiseMax(shown.min_mm), about.max_mm.cwiseMin(shown.max_mm)};
    if (region.size_mm().minCoeff() > 0) {
      places = places_at(*tibia, region);
      shown = region;
    }
  }
  const scene::GreyWindow window =
      volume.modality == images::Modality::Ct ? kBoneInTissue : scene::automatic_window(volume);
  std::vector<SideSlice> slices;
  for (const Place& place : places) {
    const Vector3d right = Vector3d::UnitX();
    const double wide_mm = shown.size_mm().x(), high_mm = std::abs(shown.size_mm().dot(place.down));
    SideSlice& slice = slices.emplace_back();
    slice.words = place.words;
    slice.letters = {scene::orientation_letters(-right), scene::orientation_letters(right),
                     scene::orientation_letters(-place.down), scene::orientation_letters(place.down)};
    const double mm_per_px = std::max({wide_mm, high_mm, 1.0}) / longest_side_px;
    slice.size_px = {std::max(1, static_cast<int>(std::lround(wide_mm / mm_per_px))),
                     std::max(1, static_cast<int>(std::lround(high_mm / mm_per_px)))};
    scene::reslice(volume,
                   {.center_mm = place.center_mm, .right = right, .down = place.down, .mm_per_px = mm_per_px},
                   slice.size_px, window, slice.grey);
  }
  return slices;
}

void SideSlices::show(const importing::BoneImport& import) {
  clear();
  making_.start(
      [volume = import.image->volume, tibia = found_tibia(import)] {
        return side_slices(images::volume_of(volume), tibia, kLongestSide_px);
      },
      wake_);
}

void SideSlices::clear() {
  making_.drop();
  slices_.clear();
}

bool SideSlices::draw(const widgets::Ui& ui, const widgets::Rect& area) {
  if (making_.is_ready()) {
    slices_ = making_.take();
    for (std::size_t i = 0; i < slices_.size(); ++i)
      textures_[i].upload(slices_[i].size_px.x(), slices_[i].size_px.y(), slices_[i].grey);
  }
  ui.log.note_state("side_slices", slices_.empty() ? "none" : "shown");
  if (slices_.empty()) return false;
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  const float gap = ui.theme.px(8), line = ui.theme.body->FontSize + ui.theme.px(4);
  widgets::Rect rest = area;
  const std::string rule = widgets::wrapped(
      ui.theme.body,
      "The fibula, the thin bone beside and behind the tibia, lies on the outer side: at R in a right knee, "
      "at L in a left one",
      area.width);
  const auto rows = static_cast<float>(1 + std::ranges::count(rule, '\n'));
  const widgets::Rect hint = rest.cut_bottom(rows * line, gap);
  widgets::draw_text(draw, ui.theme.body, hint.x, hint.y, widgets::kText, rule);
  const float width = (rest.width - gap) / 2, height = (rest.height - gap) / 2;
  for (std::size_t i = 0; i < slices_.size(); ++i) {
    const SideSlice& slice = slices_[i];
    widgets::Rect cell{rest.x + static_cast<float>(i % 2) * (width + gap),
                       rest.y + static_cast<float>(i / 2) * (height + gap), width, height};
    const widgets::Rect words = cell.cut_top(line);
    widgets::draw_text(draw, ui.theme.body, words.x, words.y, widgets::kQuietText,
                       widgets::fitting(ui.theme.body, slice.words, words.width));
    draw.AddRectFilled(cell.min(), cell.max(), IM_COL32(0, 0, 0, 255));
    const widgets::Rect picture =
        widgets::fitted(cell, static_cast<float>(slice.size_px.x()) / static_cast<float>(slice.size_px.y()));
    draw.AddImage(reinterpret_cast<ImTextureID>(static_cast<std::uintptr_t>(textures_[i].texture())),
                  picture.min(), picture.max());
    ImFont* const font = ui.theme.strong;
    const float pad = ui.theme.px(4), tall = font->FontSize;
    const auto put = [&](const std::string& letters, float across, float along) {
      const float wide = font->CalcTextSizeA(tall, 1e9F, 0, letters.c_str()).x;
      const ImVec2 at{cell.x + pad + across * (cell.width - wide - 2 * pad),
                      cell.y + pad + along * (cell.height - tall - 2 * pad)};
      draw.AddRectFilled({at.x - pad, at.y - pad / 2}, {at.x + wide + pad, at.y + tall + pad / 2},
                         IM_COL32(12, 16, 20, 190), pad);
      widgets::draw_text(draw, font, at.x, at.y, widgets::kCaution, letters);
    };
    put(slice.letters[0], 0, 0.5F);
    put(slice.letters[1], 1, 0.5F);
    put(slice.letters[2], 0.5F, 0);
    put(slice.letters[3], 0.5F, 1);
  }
  return true;
}

}  // namespace arthronaut::start
