// What is drawn over the picture, looked at as pixels: the lines are put into a draw list as on the screen,
// their triangles are filled here, and the result is held against masks of what must stay free.
#include "app/navigate/overlay_lines.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "app/navigate/touched_picture.h"
#include "app/scene/tool_clearance.h"
#include "tests/app/scope.h"
#include "tests/planning/geometry/shapes.h"

namespace arthronaut::navigate {
namespace {

constexpr int kWidth_px = 1920, kHeight_px = 1080;

// How opaque each pixel of the overlay is, 0 to 1.
struct Opacity {
  std::vector<float> pixels = std::vector<float>(static_cast<std::size_t>(kWidth_px) * kHeight_px);
  [[nodiscard]] float& at(int x, int y) {
    return pixels[static_cast<std::size_t>(y) * kWidth_px + static_cast<std::size_t>(x)];
  }
};

void fill(Opacity& picture, const ImDrawVert& a, const ImDrawVert& b, const ImDrawVert& c) {
  const auto cross = [](const ImVec2& o, const ImVec2& p, const ImVec2& q) {
    return (p.x - o.x) * (q.y - o.y) - (p.y - o.y) * (q.x - o.x);
  };
  const float area = cross(a.pos, b.pos, c.pos);
  if (std::abs(area) < 1e-6F) return;
  const auto alpha = [](const ImDrawVert& v) { return static_cast<float>(v.col >> 24U) / 255; };
  const auto [x0, x1] = std::minmax({a.pos.x, b.pos.x, c.pos.x});
  const auto [y0, y1] = std::minmax({a.pos.y, b.pos.y, c.pos.y});
  for (int y = std::max(static_cast<int>(y0), 0); y <= std::min(static_cast<int>(y1), kHeight_px - 1); ++y)
    for (int x = std::max(static_cast<int>(x0), 0); x <= std::min(static_cast<int>(x1), kWidth_px - 1); ++x) {
      const ImVec2 p{static_cast<float>(x) + 0.5F, static_cast<float>(y) + 0.5F};
      const float u = cross(b.pos, c.pos, p) / area, v = cross(c.pos, a.pos, p) / area, w = 1 - u - v;
      if (u < 0 || v < 0 || w < 0) continue;
      float& pixel = picture.at(x, y);
      pixel += (1 - pixel) * (u * alpha(a) + v * alpha(b) + w * alpha(c));
    }
}

// The overlay one to one on the raw picture.
Opacity drawn(const scene::PlanOverlay& overlay, float opacity, float stroke_opacity = 1) {
  ImGui::CreateContext();
  ImDrawListSharedData* const shared = ImGui::GetDrawListSharedData();
  Opacity picture;
  {
    ImDrawList draw(shared);
    draw._ResetForNewFrame();
    draw.PushClipRectFullScreen();
    draw.Flags = ImDrawListFlags_AntiAliasedLines;  // without the texture of ready-made lines
    const widgets::Rect all{0, 0, kWidth_px, kHeight_px};
    draw_overlay_lines(draw, widgets::PicturePlacement(all, all), overlay, {opacity, 1, stroke_opacity});
    for (int i = 0; i + 2 < draw.IdxBuffer.Size; i += 3)
      fill(picture, draw.VtxBuffer[draw.IdxBuffer[i]], draw.VtxBuffer[draw.IdxBuffer[i + 1]],
           draw.VtxBuffer[draw.IdxBuffer[i + 2]]);
  }
  ImGui::DestroyContext();
  return picture;
}

// A block of bone with a tunnel into its front, and the femoral guide before it, its tip `away_mm` beside the
// entry.
struct Theatre {
  std::shared_ptr<const geometry::Surface> surface;
  tunnels::Tunnel plan;
  pipeline::FrameResult result;
  geometry::RigidTransform camera_from_bone{
      Eigen::Quaterniond(Eigen::AngleAxisd(0.2, Eigen::Vector3d::UnitY())), {1, -2, 30}};
  tools::ToolSet tools = tools::standard_tools();

  explicit Theatre(double lean_rad, double away_mm = 0) {
    surface = std::make_shared<geometry::Surface>(test::box({20, 20, 15}, {0, 0, 15}));
    plan.entry_mm = {2, 3, 0};
    plan.direction = Eigen::Vector3d(0.1, 0, 1).normalized();
    plan.diameter_mm = 8;
    result.camera = camera::CameraModel(test::scope(), 0.3, 1.3345);
    result.intrinsics_are_known = true;
    result.markers.resize(1);
    result.markers[0].id = 3;
    result.markers[0].state = markers::MarkerState::Tracked;
    // The guide's axis leans from the line of sight by lean_rad; its tip stands at the entry.
    const tools::ToolAxis& axis = guide();
    const Eigen::Vector3d aim(std::sin(lean_rad), 0, std::cos(lean_rad));
    const Eigen::Quaterniond turn = Eigen::Quaterniond::FromTwoVectors(axis.direction, aim);
    const Eigen::Vector3d tip = camera_from_bone * (plan.entry_mm + Eigen::Vector3d(0, away_mm, 0));
    result.markers[0].camera_from_marker = {turn, tip - turn * axis.point_mm};
  }
  [[nodiscard]] const tools::ToolAxis& guide() const { return *tools.find_tool("femoral guide")->axis; }
  [[nodiscard]] scene::PlanOverlay overlay() const {
    const scene::OverlayModel model(surface, test::box({20, 20, 15}, {0, 0, 15}), plan, 25);
    return model.project(result.camera, camera_from_bone, scene::clear_discs_of(result, tools));
  }
  // Whether the sleeve lies over this pixel: the ray comes closer to the axis than the sleeve is thick.
  [[nodiscard]] bool sleeve_is_at(int x, int y) const {
    constexpr double kSleeveRadius_mm = 2.2, kSleeveLength_mm = 60;
    const auto ray = result.camera.ray({x, y});
    if (!ray) return false;
    const geometry::RigidTransform& pose = result.markers[0].camera_from_marker;
    const Eigen::Vector3d tip = pose * guide().point_mm, back = -pose.rotate(guide().direction);
    const Eigen::Vector3d normal = ray->cross(back);
    if (normal.norm() < 1e-9) return false;
    const double along = tip.cross(*ray).dot(normal) / normal.squaredNorm();
    const double depth = (tip + along * back).dot(*ray);
    return along >= 0 && along <= kSleeveLength_mm && depth > 0 &&
           std::abs(tip.dot(normal.normalized())) < kSleeveRadius_mm;
  }
};

// Not one pixel of the overlay lies on the guide's sleeve, however the guide leans; and lines are there.
TEST(OverlayHazard24, NeverLiesOverATool) {
  for (const double lean_rad : {0.5, 0.8, 1.1, 1.4}) {
    const Theatre theatre(lean_rad);
    Opacity picture = drawn(theatre.overlay(), 1);
    long lines = 0, sleeve = 0, over = 0;
    for (int y = 0; y < kHeight_px; ++y)
      for (int x = 0; x < kWidth_px; ++x) {
        if (!theatre.result.camera.is_inside_view({x, y})) continue;
        const bool is_line = picture.at(x, y) > 0.02F, is_sleeve = theatre.sleeve_is_at(x, y);
        lines += is_line ? 1 : 0;
        sleeve += is_sleeve ? 1 : 0;
        over += is_line && is_sleeve ? 1 : 0;
      }
    EXPECT_EQ(over, 0) << lean_rad;
    EXPECT_GT(sleeve, 10'000) << lean_rad;
    EXPECT_GT(lines, 1'500) << lean_rad;  // the ring about the entry alone
  }
}

// A loose body of 5 mm that nobody told the program about stays seen: wherever it lies on the bone, lines
// cover less than half of it, and once the overlay has faded three quarters of its light pass everywhere but
// where lines cross.
TEST(OverlayHazard24, LeavesAForeignBodyToBeSeen) {
  const Theatre theatre(1.1, 12);
  Opacity fresh = drawn(theatre.overlay(), overlay_opacity(0));
  Opacity faded = drawn(theatre.overlay(), overlay_opacity(60));
  const double pixels_per_mm =
      theatre.result.camera.central_focal_px() / theatre.camera_from_bone.translation_mm.z();
  const int radius = static_cast<int>(2.5 * pixels_per_mm);
  long bodies = 0;
  for (int cy = radius; cy < kHeight_px - radius; cy += 40)
    for (int cx = radius; cx < kWidth_px - radius; cx += 40) {
      long all = 0, covered = 0;
      for (int y = cy - radius; y <= cy + radius; ++y)
        for (int x = cx - radius; x <= cx + radius; ++x) {
          if (std::hypot(x - cx, y - cy) > radius) continue;
          ++all;
          covered += fresh.at(x, y) > 0.1F ? 1 : 0;
        }
      ++bodies;
      EXPECT_LT(static_cast<double>(covered) / static_cast<double>(all), 0.5) << cx << ", " << cy;
    }
  EXPECT_GT(bodies, 500);
  long lines = 0, strong = 0;
  for (const float pixel : faded.pixels) {
    lines += pixel > 0.02F ? 1 : 0;
    strong += pixel > 0.26F ? 1 : 0;
  }
  EXPECT_GT(lines, 3'000);
  EXPECT_LT(static_cast<double>(strong) / static_cast<double>(lines), 0.1);
}

// It fades by itself and stays a hint.
TEST(OverlayHazard24, FadesToAHintAndNoFurther) {
  EXPECT_EQ(overlay_opacity(0), 1);
  EXPECT_EQ(overlay_opacity(7.9), 1);
  EXPECT_NEAR(overlay_opacity(9), 0.625, 1e-6);
  EXPECT_EQ(overlay_opacity(10), 0.25F);
  EXPECT_EQ(overlay_opacity(1e6), 0.25F);
}

// A line that the bone hides is dashed: between its ends there is as good as nothing half of the way, and
// what is seen is drawn through.
TEST(OverlayLines, WhatIsHiddenIsDashed) {
  using Kind = scene::OverlayLine::Kind;
  for (const bool is_hidden : {false, true}) {
    Opacity picture = drawn({{Kind::TunnelWall, is_hidden, {{100, 500}, {300, 500}, {700, 500}}}}, 1);
    int covered = 0, changes = 0;
    bool was = true;
    for (int x = 101; x < 700; ++x) {
      const bool is = picture.at(x, 500) > 0.2F;
      covered += is ? 1 : 0;
      changes += is != was ? 1 : 0;
      was = is;
    }
    // Dashes of 9 px and gaps of 7 px; anti-aliasing takes a pixel or two of either.
    if (is_hidden) {
      EXPECT_NEAR(covered / 599.0, 9.0 / 16, 0.1);
      EXPECT_GT(changes, 60);
    } else {
      EXPECT_EQ(covered, 599);
    }
  }
}

// While the guide is aimed the strokes that were drawn before step back behind the plan.
TEST(OverlayLines, StrokesStepBackWhileAiming) {
  using Kind = scene::OverlayLine::Kind;
  const scene::PlanOverlay both{{Kind::Curve, false, {{100, 400}, {700, 400}}},
                                {Kind::EntryRing, false, {{100, 600}, {700, 600}}}};
  Opacity full = drawn(both, 1), aiming = drawn(both, 1, 0.3F);
  EXPECT_LT(aiming.at(400, 400), 0.4F * full.at(400, 400));
  EXPECT_EQ(aiming.at(400, 600), full.at(400, 600));
}

// Green is what is surely on the bone, in the 3D view: over the picture a stroke is what was drawn, no more.
TEST(OverlayLines, StrokesClaimNothingOverThePicture) {
  ImGui::CreateContext();
  {
    ImDrawList draw(ImGui::GetDrawListSharedData());
    draw._ResetForNewFrame();
    draw.PushClipRectFullScreen();
    draw.Flags = ImDrawListFlags_AntiAliasedLines;
    const widgets::Rect all{0, 0, kWidth_px, kHeight_px};
    draw_overlay_lines(draw, widgets::PicturePlacement(all, all),
                       {{scene::OverlayLine::Kind::Curve, false, {{100, 400}, {700, 400}}}}, {1, 1, 1});
    constexpr ImU32 kRgb = 0x00FFFFFF;
    ASSERT_GT(draw.VtxBuffer.Size, 0);
    for (const ImDrawVert& vertex : draw.VtxBuffer)
      EXPECT_EQ(vertex.col & kRgb, widgets::color_of(kDrawnColor) & kRgb);
    EXPECT_NE(widgets::color_of(kDrawnColor) & kRgb, widgets::color_of(scene::kCurveColor) & kRgb);
  }
  ImGui::DestroyContext();
}

// No line of the plan to be seen has a reason, in words.
TEST(OverlayHazard30, IsNeverGoneWithoutAReason) {
  using Kind = scene::OverlayLine::Kind;
  const scene::PlanOverlay seen{{Kind::EntryRing, false, {{1, 1}, {2, 2}}}};
  const scene::PlanOverlay none{{Kind::Curve, false, {{1, 1}, {2, 2}}}};
  EXPECT_EQ(why_no_plan_line(seen, 0.25F), "");
  EXPECT_NE(why_no_plan_line(seen, 0), "");
  EXPECT_NE(why_no_plan_line(none, 1), "");
}

}  // namespace
}  // namespace arthronaut::navigate
