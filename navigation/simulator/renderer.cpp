#include "navigation/simulator/renderer.h"

#include <algorithm>
#include <cmath>

#include "navigation/simulator/ray_table.h"

namespace arthronaut::simulator {
namespace {

// The field stop's surroundings, with room for the blur.
PixelArea visible_area(const camera::CameraModel& camera) {
  const camera::Boundary& b = camera.boundary();
  const auto low = [&](double center) {
    return std::max(0, static_cast<int>(std::floor(center - b.radius_px)) - 8);
  };
  const auto high = [&](double center, int size) {
    return std::min(size, static_cast<int>(std::ceil(center + b.radius_px)) + 8);
  };
  const int left = low(b.center_px.x()), top = low(b.center_px.y());
  return {left, top, high(b.center_px.x(), camera.image_size_px().x()) - left,
          high(b.center_px.y(), camera.image_size_px().y()) - top};
}

}  // namespace

Renderer::Renderer(BoneView* bone, const SensorOptions& sensor)
    : bone_(bone), vignette_share_(sensor.vignette_share), sensor_(sensor) {}

void Renderer::render(const Scene& scene, const camera::CameraModel& camera, double mark_angle_deg,
                      std::uint64_t noise_seed, camera::Frame& frame) {
  frame.width = camera.image_size_px().x();
  frame.height = camera.image_size_px().y();
  const PixelArea area = visible_area(camera);
  const double reach =
      camera.boundary().radius_px + 40 + (camera.principal_point_px() - camera.boundary().center_px).norm();
  const RayTable rays(camera, reach);
  const FieldStop stop(camera.boundary(), mark_angle_deg, vignette_share_);

  light_.resize(Sensor::light_size(area));
  BoneView* const bone = scene.has_bone ? bone_ : nullptr;
  if (bone) bone->look(scene.camera_from_bone, rays, area);
  const Ground ground(bone, area, camera.boundary(), rays, scene.exposure);
  const SolidLayer solids(scene.solids, area, rays, scene.exposure);
  // 1. The bone. 2. The solids over it. 3. The field stop over both. 4. The sensor.
  static_assert(kBandRows % 2 == 0);
  parallel_bands(area.height, [&](int first, int end, int thread) {
    ThreadMemory& memory = memory_[static_cast<std::size_t>(thread)];
    memory.bone_rows.clear(first, std::min(end + 1, area.height) - first, area.width);
    if (bone) bone->draw(memory.bone_rows);
    ground.draw_rows(first, end, memory.bone_rows, memory.ground, light_.data());
    solids.draw_rows(first, end, memory.bone_rows, memory.solids, light_.data());
    for (int row = first; row < end; ++row)
      stop.stop(area.left, area.top + row, area.width,
                light_.data() + static_cast<std::ptrdiff_t>(3) * area.width * row);
  });
  sensor_.expose(light_, area, &stop, noise_seed, frame);
}

}  // namespace arthronaut::simulator
