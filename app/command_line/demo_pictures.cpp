#include "app/command_line/demo_pictures.h"

#include <algorithm>
#include <cmath>

#include "app/command_line/frame_dump.h"
#include "app/scene/image.h"
#include "app/scene/plan_overlay.h"

namespace arthronaut::command_line {

namespace {

using Colour = std::array<std::uint8_t, 3>;

void dot(scene::Image& image, const Eigen::Vector2d& at, const Colour& colour) {
  const int x = static_cast<int>(std::lround(at.x())), y = static_cast<int>(std::lround(at.y()));
  for (int dy = -1; dy <= 1; ++dy) {
    for (int dx = -1; dx <= 1; ++dx) {
      if (x + dx < 0 || y + dy < 0 || x + dx >= image.width || y + dy >= image.height) continue;
      std::copy(colour.begin(), colour.end(),
                image.rgb.begin() + 3 * (static_cast<std::ptrdiff_t>(y + dy) * image.width + x + dx));
    }
  }
}

// Hidden lines are dotted: form, not colour alone, tells them apart.
void draw(scene::Image& image, const scene::OverlayLine& line) {
  if (line.kind == scene::OverlayLine::Kind::TunnelFace) return;  // lines alone
  const Colour colour =
      line.kind == scene::OverlayLine::Kind::BoneOutline ? Colour{90, 200, 255} : Colour{120, 255, 120};
  const double step_px = line.is_hidden ? 8 : 1;
  for (std::size_t i = 1; i < line.points_px.size(); ++i) {
    const Eigen::Vector2d from = line.points_px[i - 1], to = line.points_px[i];
    const int count = std::max(1, static_cast<int>((to - from).norm() / step_px));
    for (int k = 0; k <= count; ++k) dot(image, from + (to - from) * k / count, colour);
  }
}

}  // namespace

void write_frame_picture(const std::filesystem::path& file, const camera::Frame& frame,
                         const pipeline::FrameResult& result,
                         const std::optional<registration::RegistrationSummary>& registration,
                         const geometry::TriangleMesh& bone, const tunnels::Tunnel& plan,
                         double planned_length_mm) {
  scene::Image image = image_of(frame);
  if (registration && registration->has_pose && result.camera_from_world.is_valid) {
    const scene::OverlayModel overlay(std::make_shared<geometry::Surface>(bone), bone, plan,
                                      planned_length_mm);
    const auto lines = overlay.project(
        result.camera, result.camera_from_world.target_from_source * registration->marker_from_bone, {});
    for (const scene::OverlayLine& line : lines) draw(image, line);
  }
  scene::write_png(file, image);
}

}  // namespace arthronaut::command_line
