#include "app/start/side_slices.h"

#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "app/scene/reslice.h"
#include "app/widgets/list_rows.h"
#include "planning/images/volume_decoder.h"

namespace arthronaut::start {

namespace {

using Eigen::Vector3d;

constexpr int kLongestSide_px = 480;

struct Box {
  Vector3d low = Vector3d::Constant(std::numeric_limits<double>::infinity()), high = -low;
  [[nodiscard]] Vector3d at(double x, double y, double z) const {
    return low + Vector3d(x, y, z).cwiseProduct(high - low);
  }
};

Box box_of(const images::Volume& volume) {
  Box box;
  for (int corner = 0; corner < 8; ++corner) {
    const Eigen::Vector3i pick(corner & 1, (corner >> 1) & 1, (corner >> 2) & 1);
    const Vector3d at =
        volume.lps_from_index * pick.cwiseProduct(volume.size - Eigen::Vector3i::Ones()).cast<double>();
    box.low = box.low.cwiseMin(at);
    box.high = box.high.cwiseMax(at);
  }
  return box;
}

}  // namespace

std::vector<SideSlice> side_slices(const images::Volume& volume, int longest_side_px) {
  const Box box = box_of(volume);
  const Vector3d size = box.high - box.low;
  const scene::GreyWindow window = scene::automatic_window(volume);
  std::vector<SideSlice> slices;
  const auto add = [&](const char* words, const Vector3d& center, const Vector3d& down) {
    const Vector3d right = Vector3d::UnitX();
    const double wide_mm = size.x(), high_mm = std::abs(size.dot(down));
    SideSlice slice{.words = words,
                    .letters = {scene::orientation_letters(-right), scene::orientation_letters(right),
                                scene::orientation_letters(-down), scene::orientation_letters(down)},
                    .size_px = {},
                    .grey = {}};
    const double mm_per_px = std::max({wide_mm, high_mm, 1.0}) / longest_side_px;
    slice.size_px = {std::max(1, static_cast<int>(std::lround(wide_mm / mm_per_px))),
                     std::max(1, static_cast<int>(std::lround(high_mm / mm_per_px)))};
    scene::reslice(volume, {.center_mm = center, .right = right, .down = down, .mm_per_px = mm_per_px},
                   slice.size_px, window, slice.grey);
    slices.push_back(std::move(slice));
  };
  // z grows to the head: 0 is the lower end, y to the back.
  add("From in front, in the middle", box.at(0.5, 0.5, 0.5), -Vector3d::UnitZ());
  add("From in front, further back", box.at(0.5, 0.65, 0.5), -Vector3d::UnitZ());
  add("Across, below the joint", box.at(0.5, 0.5, 0.27), Vector3d::UnitY());
  add("Across, further down", box.at(0.5, 0.5, 0.1), Vector3d::UnitY());
  return slices;
}

void SideSlices::show(const images::EncodedVolume& volume) {
  clear();
  making_.start([volume] { return side_slices(images::volume_of(volume), kLongestSide_px); }, wake_);
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
  const widgets::Rect hint = rest.cut_bottom(2 * line, gap);
  widgets::draw_text(
      draw, ui.theme.body, hint.x, hint.y, widgets::kText,
      "The fibula, the thin bone beside and behind the tibia, lies on the outer side: at R in a "
      "right knee, at L in a left one",
      hint.width);
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
