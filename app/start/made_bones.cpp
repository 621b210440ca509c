#include "app/start/made_bones.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <string>
#include <utility>

#include "app/scene/scene_content.h"
#include "app/widgets/list_rows.h"
#include "app/widgets/wrapped_text.h"

namespace arthronaut::start {

namespace {

using bones::Side;

struct Point {
  float x, y;
};
// A knee from in front of the patient, as lines in a square from (-1, -1) at the top left; a right knee,
// whose outer side then is at the left.
constexpr std::array<Point, 15> kFemur{{{-0.24F, -1},
                                        {-0.22F, -0.55F},
                                        {-0.36F, -0.35F},
                                        {-0.48F, -0.2F},
                                        {-0.48F, -0.02F},
                                        {-0.34F, 0.08F},
                                        {-0.16F, 0.06F},
                                        {-0.06F, -0.06F},
                                        {0.06F, -0.06F},
                                        {0.16F, 0.1F},
                                        {0.34F, 0.12F},
                                        {0.48F, 0},
                                        {0.48F, -0.2F},
                                        {0.24F, -0.55F},
                                        {0.2F, -1}}};
constexpr std::array<Point, 10> kTibia{{{-0.18F, 1},
                                        {-0.22F, 0.55F},
                                        {-0.46F, 0.36F},
                                        {-0.48F, 0.2F},
                                        {-0.1F, 0.2F},
                                        {0, 0.14F},
                                        {0.12F, 0.2F},
                                        {0.48F, 0.22F},
                                        {0.44F, 0.38F},
                                        {0.16F, 1}}};
constexpr std::array<Point, 8> kFibula{{{-0.4F, 1},
                                        {-0.42F, 0.6F},
                                        {-0.46F, 0.5F},
                                        {-0.5F, 0.42F},
                                        {-0.6F, 0.44F},
                                        {-0.62F, 0.54F},
                                        {-0.54F, 0.62F},
                                        {-0.52F, 1}}};

void draw_sketch(const widgets::Ui& ui, const widgets::Rect& area, Side side, bool is_chosen) {
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  const float mirror = side == Side::Right ? 1.F : -1.F, line = ui.theme.body->FontSize + ui.theme.px(4);
  // Beside slices the area is narrow.
  const auto fitted = [&](std::string_view text) {
    return widgets::lines_within(ui.theme.body, text, area.width - ui.theme.px(12), ui.theme.body->FontSize);
  };
  const widgets::LinesWithin seen_from = fitted("seen from in front:"),
                             fibula =
                                 fitted(side == Side::Right ? "fibula at its left" : "fibula at its right");
  draw.AddRectFilled(area.min(), area.max(), widgets::kBackground, ui.theme.px(6));
  draw.AddRect(area.min(), area.max(), is_chosen ? widgets::kAccent : widgets::kPanelEdge, ui.theme.px(6), 0,
               ui.theme.px(is_chosen ? 3 : 1));
  const float size = std::min(area.width, area.height - 3 * line - ui.theme.px(16)) / 2;
  const ImVec2 middle{area.center().x, area.y + line + ui.theme.px(8) + size};
  const auto outline = [&](const auto& points, ImU32 color, float wide) {
    std::array<ImVec2, 16> at{};
    std::transform(points.begin(), points.end(), at.begin(), [&](const Point& p) {
      return ImVec2{middle.x + mirror * size * p.x, middle.y + size * p.y};
    });
    draw.AddPolyline(at.data(), static_cast<int>(points.size()), color, 0, ui.theme.px(wide));
  };
  outline(kFemur, widgets::kQuietText, 2);
  outline(kTibia, widgets::kQuietText, 2);
  outline(kFibula, widgets::kAccent, 3);
  const auto centered = [&](ImFont* font, float letters_px, float y, ImU32 color, const std::string& text) {
    const float wide = font->CalcTextSizeA(letters_px, 1e9F, 0, text.c_str()).x;
    draw.AddText(font, letters_px, {area.center().x - wide / 2, y}, color, text.c_str());
    return ImVec4{area.center().x - wide / 2, y, area.center().x + wide / 2, y + letters_px};
  };
  centered(ui.theme.strong, ui.theme.strong->FontSize, area.y + ui.theme.px(4), widgets::kText,
           side == Side::Right ? "Right knee (R)" : "Left knee (L)");
  const ImVec4 view = centered(ui.theme.body, seen_from.letters_px, area.y + area.height - 2 * line,
                               widgets::kQuietText, seen_from.lines);
  const ImVec4 told = centered(ui.theme.body, fibula.letters_px, area.y + area.height - line,
                               widgets::kQuietText, fibula.lines);
  ui.log.note("start.sketch_words_" + std::string(bones::to_text(side)), {std::min(view.x, told.x), view.y},
              {std::max(view.z, told.z), told.w});
}

// LPS: x grows to the patient's left.
std::string side_of_picture(const scene::SceneCamera& camera, bool is_left_edge) {
  const double across = (camera.focus_mm - camera.position_mm).cross(camera.up).normalized().x();
  if (std::abs(across) < 0.5) return "";  // turned until both lie one behind the other
  return (across > 0) == is_left_edge ? "patient's right" : "patient's left";
}

}  // namespace

MadeBones::MadeBones(std::function<void()> make_current, std::function<void()> wake)
    : wake_(std::move(wake)), pane_(std::move(make_current)), slices_(wake_) {}

void MadeBones::show(const importing::BoneImport& import) {
  is_there_ = false;
  // Of a CT, too: a fibula that hung on the tibia is taken off it, and the bones tell no side any more.
  has_slices_ = import.image.has_value();
  has_bones_ = !import.bones.empty();
  if (has_slices_)
    slices_.show(import);
  else
    slices_.clear();
  std::vector<geometry::TriangleMesh> meshes;
  for (const importing::ImportedBone& bone : import.bones) meshes.push_back(bone.bone.mesh);
  thinning_.start(
      [meshes = std::move(meshes)] {
        Meshes thin;
        for (const geometry::TriangleMesh& mesh : meshes) thin.push_back(scene::simplified(mesh));
        return thin;
      },
      wake_);
}

std::optional<Side> MadeBones::draw(const widgets::Ui& ui, const widgets::Rect& area,
                                    std::optional<Side> side) {
  widgets::Rect rest = area;
  const float gap = ui.theme.px(8);
  // Beside slices the sketches stand one above the other, and leave them all of the height.
  if (has_slices_) (void)slices_.draw(ui, rest.cut_right((has_bones_ ? 0.62F : 0.7F) * rest.width, gap));
  widgets::Rect sketches = rest.cut_bottom(!has_slices_ ? ui.theme.px(230)
                                           : has_bones_ ? 0.55F * rest.height
                                                        : rest.height,
                                           gap);
  if (thinning_.is_ready()) {
    const Meshes meshes = thinning_.take();
    scene::SceneContent content;
    geometry::Bounds bounds;
    for (const auto& mesh : meshes) {
      const geometry::Bounds own = geometry::bounds_of(*mesh);
      bounds = content.bones.empty()
                   ? own
                   : geometry::Bounds{bounds.min_mm.cwiseMin(own.min_mm), bounds.max_mm.cwiseMax(own.max_mm)};
      content.bones.push_back({mesh, scene::kBoneColor, 1.0, {}});
    }
    is_there_ = !meshes.empty();
    if (is_there_) {
      pane_.show(content);
      // The side turns nothing in a view from in front.
      pane_.look(scene::look_from(scene::ViewDirection::Anterior, Side::Right, bounds,
                                  rest.width / std::max(rest.height, 1.F)));
    }
  }
  ui.log.note_state("made_bones", is_there_ ? "shown" : "none");
  if (is_there_) {
    (void)pane_.draw(ui, "start.bones", rest);
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    const std::string left = side_of_picture(pane_.camera(), true),
                      right = side_of_picture(pane_.camera(), false);
    ImFont* const font = ui.theme.strong;
    const float edge = ui.theme.px(10), pad = ui.theme.px(5);
    // across: the share of what the words leave free of the picture. Read over a bright bone, too.
    const auto put = [&](const std::string& words, float across) {
      if (words.empty()) return;
      const float wide = font->CalcTextSizeA(font->FontSize, 1e9F, 0, words.c_str()).x;
      const ImVec2 at{rest.x + edge + across * (rest.width - wide - 2 * edge), rest.center().y};
      draw.AddRectFilled({at.x - pad, at.y - pad / 2}, {at.x + wide + pad, at.y + font->FontSize + pad / 2},
                         IM_COL32(12, 16, 20, 190), pad);
      widgets::draw_text(draw, font, at.x, at.y, widgets::kCaution, words);
    };
    put(left, 0);
    put(right, 1);
  }
  std::optional<Side> clicked;
  const widgets::Rect first = has_slices_ ? sketches.cut_top((sketches.height - gap) / 2, gap)
                                          : sketches.cut_left((sketches.width - gap) / 2, gap);
  for (const auto& [place, of] : {std::pair{first, Side::Right}, std::pair{sketches, Side::Left}}) {
    draw_sketch(ui, place, of, side == of);
    ImGui::SetCursorScreenPos(place.min());
    const std::string name = "start.sketch_" + std::string(bones::to_text(of));
    if (ImGui::InvisibleButton(name.c_str(), {place.width, place.height})) clicked = of;
    ui.log.note(name, place.min(), place.max());
  }
  return clicked;
}

}  // namespace arthronaut::start
