#include "app/scene/plan_picture.h"

#include <Eigen/Geometry>
#include <algorithm>

#include "app/scene/lateral_plane.h"
#include "app/scene/notch_cut.h"
#include "app/scene/offscreen_context.h"
#include "app/scene/scene_camera.h"
#include "app/scene/scene_content.h"
#include "app/scene/scene_view.h"
#include "planning/geometry/error.h"
#include "planning/geometry/surface.h"

namespace arthronaut::scene {

namespace {

// Of a bone, from the joint on: what is beyond says nothing of a tunnel, and would make all of it small.
constexpr double kJointEnd_mm = 55;

std::optional<bones::BoneKind> bone_of(const PictureRequest& request) {
  if (request.view == ViewDirection::Distal || request.view == ViewDirection::Notch)
    return bones::BoneKind::Femur;
  if (request.view == ViewDirection::Plateau) return bones::BoneKind::Tibia;
  return request.only_bone;
}

double drawn_length_mm(const tunnels::Tunnel& tunnel, const geometry::TriangleMesh& mesh) {
  constexpr double kLengthOfOneThatMisses_mm = 30;
  const tunnels::TunnelGeometry measured = tunnels::measure(tunnel, geometry::Surface(mesh));
  return measured.enters_bone ? measured.length_mm : kLengthOfOneThatMisses_mm;
}

// As near, and as much in the middle, as all of the points are still seen.
SceneCamera look_closely(ViewDirection view, const landmarks::AnatomicalAxes& axes,
                         const std::vector<Eigen::Vector3d>& points_mm, double aspect) {
  geometry::TriangleMesh all;
  all.vertices_mm = points_mm;
  SceneCamera camera = look_from(view, axes, geometry::bounds_of(all), aspect);
  constexpr double kMargin = 1.05;
  const Eigen::Vector2d reach = Eigen::Vector2d(aspect, 1) / kMargin;  // of half the picture's height
  // What bounds the picture changes with the eye's place: a few rounds settle it.
  for (int round = 0; round < 6; ++round) {
    Eigen::AlignedBox2d seen;
    for (const Eigen::Vector3d& p : points_mm)
      if (const auto at = project(camera, p, {2, 2}))
        seen.extend(Eigen::Vector2d(*at - Eigen::Vector2d(1, 1)));
    if (seen.isEmpty()) return camera;
    const Eigen::Vector3d ahead = camera.focus_mm - camera.position_mm;
    camera = panned(camera, -seen.center(), 2);
    const double excess = (0.5 * seen.sizes()).cwiseQuotient(reach).maxCoeff();
    camera.position_mm = camera.focus_mm - excess * ahead;
  }
  return camera;
}

// Twice the size, each pixel the mean of four: smooth edges on any OpenGL.
Image halved(const Image& large) {
  Image small{large.width / 2, large.height / 2, {}};
  small.rgb.resize(3 * static_cast<std::size_t>(small.width) * static_cast<std::size_t>(small.height));
  const std::size_t stride = 3 * static_cast<std::size_t>(large.width);
  std::size_t out = 0;
  for (int y = 0; y < small.height; ++y) {
    for (int x = 0; x < small.width; ++x) {
      const std::size_t at = 2 * static_cast<std::size_t>(y) * stride + 6 * static_cast<std::size_t>(x);
      for (std::size_t c = 0; c < 3; ++c, ++out) {
        const int sum = large.rgb[at + c] + large.rgb[at + 3 + c] + large.rgb[at + stride + c] +
                        large.rgb[at + stride + 3 + c];
        small.rgb[out] = static_cast<std::uint8_t>((sum + 2) / 4);
      }
    }
  }
  return small;
}

}  // namespace

Image render_plan_picture(const PictureRequest& request) {
  if (request.knee == nullptr) throw InvalidInput("a picture needs a case");
  if (std::min(request.width, request.height) < 16 || std::max(request.width, request.height) > 8192)
    throw InvalidInput("a picture's size must be 16 to 8192 pixels");
  const std::optional<bones::BoneKind> only = bone_of(request);
  SceneContent content;
  std::vector<Eigen::Vector3d> shown_mm;
  std::optional<landmarks::AnatomicalAxes> axes;  // the first bone's: the femur's where it is there
  for (const auto& [kind, bone] : request.knee->bones) {
    if ((only && kind != *only) || bone.mesh.empty()) continue;
    constexpr std::size_t kPictureTriangles = 60'000;
    const auto marks = request.knee->landmarks.find(kind);
    const landmarks::Landmarks named =
        marks == request.knee->landmarks.end() ? landmarks::Landmarks{} : marks->second;
    if (!axes) axes = landmarks::anatomical_axes(kind, request.knee->side, named, bone.mesh);
    content.bones.push_back({simplified(bone.mesh, kPictureTriangles), kBoneColor, 1.0});
    if (request.view == ViewDirection::Notch) content.bones.back().cut = notch_cut(bone.mesh, *axes, named);
    const auto end = joint_end(bone.mesh, kind, *axes, kJointEnd_mm);
    shown_mm.insert(shown_mm.end(), end.begin(), end.end());
    for (const tunnels::TunnelKey& key : request.knee->plan.of(kind)) {
      const tunnels::Tunnel& planned = request.knee->plan.tunnels.at(key);
      const double length_mm = drawn_length_mm(planned, bone.mesh);
      add_planned_tunnel(content, planned, length_mm);
      shown_mm.insert(shown_mm.end(), {planned.entry_mm, planned.entry_mm + length_mm * planned.direction});
    }
    for (const tunnels::Tunnel& achieved : request.achieved)
      if (achieved.bone == kind) add_achieved_tunnel(content, achieved, drawn_length_mm(achieved, bone.mesh));
  }
  if (content.bones.empty()) throw InvalidInput("the case has none of the bones that the picture is to show");
  add_curve_points(content, request.curve_points_in_bone);

  const OffscreenContext context;
  SceneView view([&] { context.make_current(); });
  if (request.light_background) view.set_background({0.96F, 0.97F, 0.98F}, {1.0F, 1.0F, 1.0F});
  view.resize(2 * request.width, 2 * request.height);
  view.show(content);
  view.look(look_closely(request.view, *axes, shown_mm, static_cast<double>(request.width) / request.height));
  return halved(view.read_image());
}

}  // namespace arthronaut::scene
