#include "app/plan/landmark_drawing.h"

#include <cmath>

#include "app/widgets/draw_damage.h"

namespace arthronaut::plan {

void LandmarkDrawing::follow(bones::Side side) {
  if (making_.is_ready()) knee_ = making_.take();
  if (making_.is_busy() || (knee_ && knee_->side == side)) return;
  making_.start([side] { return make_schematic_knee(side); }, wake_);
}

void LandmarkDrawing::draw(const widgets::Ui& ui, const widgets::Rect& square, bones::Side side,
                           bones::BoneKind bone, const std::string& name) {
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  draw.AddRectFilled(square.min(), square.max(), widgets::kBackground, ui.theme.px(6));
  const int size_px = static_cast<int>(std::lround(square.width));
  if (!knee_ || knee_->side != side) return;
  if (shown_name_ != name || shown_bone_ != bone || shown_side_ != side || shown_.size_px != size_px) {
    shown_ = sketch_landmark(*knee_, bone, name, size_px);
    texture_.upload(size_px, size_px, shown_.rgba);
    shown_.rgba = {};
    shown_name_ = name;
    shown_bone_ = bone;
    shown_side_ = side;
    ++version_;
  }
  widgets::shows_version(draw, version_);
  // Pixel on pixel.
  const ImVec2 corner{std::round(square.x), std::round(square.y)};
  const auto size = static_cast<float>(size_px);
  draw.AddImage(reinterpret_cast<ImTextureID>(static_cast<std::uintptr_t>(texture_.texture())), corner,
                {corner.x + size, corner.y + size});
  draw.AddCallback(ImDrawCallback_ResetRenderState, nullptr);
  ImFont* font = ui.theme.body;
  const float pad = ui.theme.px(6), bottom = square.y + square.height - font->FontSize - pad / 2,
              wide = font->CalcTextSizeA(font->FontSize, 1e9F, 0, shown_.right.c_str()).x;
  // Read over the bone, too.
  draw.AddRectFilled({square.x, bottom}, {square.x + square.width, bottom + font->FontSize},
                     IM_COL32(12, 16, 20, 200));
  draw.AddText(font, font->FontSize, {square.x + pad, bottom}, widgets::kCaution, shown_.left.c_str());
  draw.AddText(font, font->FontSize, {square.x + square.width - wide - pad, bottom}, widgets::kCaution,
               shown_.right.c_str());
  ui.log.note("plan.landmark_picture", square.min(), square.max());
  ui.log.note_state("landmark_picture", name + ", " + std::string(scene::to_text(shown_.view)) + ", " +
                                            std::string(bones::to_text(side)));
}

}  // namespace arthronaut::plan
