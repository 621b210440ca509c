#include "app/plan/landmark_sketch.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "app/plan/edge_words.h"
#include "app/scene/lateral_plane.h"
#include "app/scene/notch_cut.h"
#include "app/scene/scene_camera.h"
#include "planning/geometry/error.h"
#include "planning/landmarks/propose.h"
#include "planning/phantom/phantom_knee.h"

namespace arthronaut::plan {

namespace {

using bones::BoneKind;
using Eigen::Vector2d;
using Eigen::Vector3d;
using scene::ViewDirection;

constexpr double kEdge_mm = 2;                           // of the schematic bone's triangles
constexpr double kJointEnd_mm = 60;                      // of the bone, where the shaft says nothing
constexpr double kGuide_mm = 30;                         // of a guide, to either side
constexpr scene::Color kMarkColor{0.34F, 0.71F, 0.91F};  // widgets::kAccent

// What is drawn beside the place itself. Upright and level are of the picture.
enum class Guide { None, Roof, AcrossRoof, AlongRoof, Upright, Level, Circle, Shaft };

struct Definition {
  BoneKind bone;
  std::string_view name;
  ViewDirection view;
  Guide guide;
  std::string_view rim = "";  // Circle: a landmark on it
};
constexpr auto kFemur = BoneKind::Femur, kTibia = BoneKind::Tibia;
constexpr std::array kDefinitions{
    Definition{kFemur, "blumensaat_anterior", ViewDirection::Notch, Guide::Roof},
    Definition{kFemur, "blumensaat_posterior", ViewDirection::Notch, Guide::Roof},
    Definition{kFemur, "notch_apex", ViewDirection::Notch, Guide::Roof},
    Definition{kFemur, "lateral_condyle_center", ViewDirection::Lateral, Guide::Circle,
               "lateral_condyle_posterior"},
    Definition{kFemur, "medial_condyle_center", ViewDirection::Medial, Guide::Circle,
               "medial_condyle_posterior"},
    Definition{kFemur, "lateral_condyle_posterior", ViewDirection::Lateral, Guide::Upright},
    Definition{kFemur, "medial_condyle_posterior", ViewDirection::Medial, Guide::Upright},
    Definition{kFemur, "lateral_condyle_deep", ViewDirection::Notch, Guide::AcrossRoof},
    Definition{kFemur, "lateral_condyle_shallow", ViewDirection::Notch, Guide::AcrossRoof},
    Definition{kFemur, "lateral_condyle_low", ViewDirection::Notch, Guide::AlongRoof},
    Definition{kFemur, "lateral_epicondyle", ViewDirection::Anterior, Guide::Upright},
    Definition{kFemur, "medial_epicondyle", ViewDirection::Anterior, Guide::Upright},
    Definition{kFemur, "shaft_distal", ViewDirection::Lateral, Guide::Shaft},
    Definition{kFemur, "shaft_proximal", ViewDirection::Lateral, Guide::Shaft},
    Definition{kFemur, "native_footprint", ViewDirection::Notch, Guide::None},
    Definition{kTibia, "plateau_anterior", ViewDirection::Plateau, Guide::Level},
    Definition{kTibia, "plateau_posterior", ViewDirection::Plateau, Guide::Level},
    Definition{kTibia, "plateau_medial", ViewDirection::Plateau, Guide::Upright},
    Definition{kTibia, "plateau_lateral", ViewDirection::Plateau, Guide::Upright},
    Definition{kTibia, "medial_eminence", ViewDirection::Anterior, Guide::None},
    Definition{kTibia, "lateral_eminence", ViewDirection::Anterior, Guide::None},
    Definition{kTibia, "tuberosity", ViewDirection::Lateral, Guide::Upright},
    Definition{kTibia, "shaft_proximal", ViewDirection::Lateral, Guide::Shaft},
    Definition{kTibia, "shaft_distal", ViewDirection::Lateral, Guide::Shaft},
    Definition{kTibia, "native_footprint", ViewDirection::Plateau, Guide::None}};

const Definition& definition_of(BoneKind bone, std::string_view name) {
  const auto found = std::ranges::find_if(
      kDefinitions, [&](const Definition& one) { return one.bone == bone && one.name == name; });
  if (found == kDefinitions.end())
    throw InvalidInput("the " + std::string(bones::to_text(bone)) + " has no landmark \"" +
                       std::string(name) + "\"");
  return *found;
}

// Without perspective: a line that is drawn touches what it touches.
struct Projection {
  scene::CameraAxes axes;
  Vector2d middle_mm, middle_px;
  double px_per_mm = 1;

  [[nodiscard]] Vector2d plane_mm(const Vector3d& x) const { return {axes.right.dot(x), -axes.up.dot(x)}; }
  [[nodiscard]] Vector2d operator()(const Vector3d& x) const {
    return middle_px + px_per_mm * (plane_mm(x) - middle_mm);
  }
};

Projection projection_of(const SchematicBone& bone, const Definition& what, int size_px) {
  Projection to;
  to.axes = scene::axes_of(scene::look_from(what.view, bone.axes, geometry::bounds_of(bone.mesh), 1));
  Eigen::AlignedBox2d seen;
  const std::vector<Vector3d> points = what.guide == Guide::Shaft
                                           ? bone.mesh.vertices_mm
                                           : scene::joint_end(bone.mesh, what.bone, bone.axes, kJointEnd_mm);
  for (const Vector3d& point : points) seen.extend(to.plane_mm(point));
  constexpr double kFilled = 0.8, kFromTop = 0.45;  // below it stand the words of the edges
  to.middle_mm = seen.center();
  to.middle_px = {0.5 * size_px, kFromTop * size_px};
  to.px_per_mm = kFilled * size_px / seen.sizes().maxCoeff();
  return to;
}

double cross(const Vector2d& a, const Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

std::uint32_t rgba_of(const Eigen::Vector3f& color) {
  const Eigen::Vector3f byte = (255 * color.array().min(1).max(0) + 0.5F).matrix();
  return 0xFF000000U | static_cast<std::uint32_t>(byte.x()) | static_cast<std::uint32_t>(byte.y()) << 8U |
         static_cast<std::uint32_t>(byte.z()) << 16U;
}

Eigen::Vector3f vector_of(const scene::Color& color) { return {color.red, color.green, color.blue}; }

// Pixels that are drawn on, as colours.
class Canvas {
 public:
  explicit Canvas(int size) : size_(size), pixels_(static_cast<std::size_t>(size) * size, kBackdrop) {}

  void fill(const SchematicBone& bone, const Projection& to, const std::optional<scene::CutPlane>& cut) {
    std::vector<double> depths(pixels_.size(), std::numeric_limits<double>::infinity());
    for (const auto& corners : bone.mesh.triangles) {
      std::array<Vector2d, 3> at;
      Eigen::Matrix3d points, normals;
      for (std::size_t i = 0; i < 3; ++i) {
        const auto vertex = static_cast<std::size_t>(corners[i]);
        points.col(static_cast<Eigen::Index>(i)) = bone.mesh.vertices_mm[vertex];
        normals.col(static_cast<Eigen::Index>(i)) = bone.normals[vertex];
        at[i] = to(bone.mesh.vertices_mm[vertex]);
      }
      const double area = cross(at[1] - at[0], at[2] - at[0]);
      if (area == 0) continue;
      const Vector2d low = at[0].cwiseMin(at[1]).cwiseMin(at[2]),
                     high = at[0].cwiseMax(at[1]).cwiseMax(at[2]);
      for (int y = clamped(low.y()); y <= clamped(high.y()); ++y) {
        for (int x = clamped(low.x()); x <= clamped(high.x()); ++x) {
          const Vector2d pixel(x + 0.5, y + 0.5);
          const Vector3d weights =
              Vector3d(cross(at[1] - pixel, at[2] - pixel), cross(at[2] - pixel, at[0] - pixel),
                       cross(at[0] - pixel, at[1] - pixel)) /
              area;
          if (weights.minCoeff() < 0) continue;
          const Vector3d point = points * weights;
          if (cut && cut->cuts_away(point)) continue;
          const double depth = to.axes.ahead.dot(point);
          double& nearest = depths[index(x, y)];
          if (depth >= nearest) continue;
          nearest = depth;
          // Rows go down: a triangle that is seen from outside goes round the other way. One that is seen
          // from inside is the section, since the cut stands square to the view.
          const double facing = std::abs(to.axes.ahead.dot((normals * weights).normalized()));
          pixels_[index(x, y)] =
              area > 0
                  ? vector_of(scene::kSectionColor)
                  : Eigen::Vector3f(static_cast<float>(0.3 + 0.65 * facing) * vector_of(scene::kBoneColor));
        }
      }
    }
  }

  [[nodiscard]] Canvas halved() const {
    Canvas half(size_ / 2);
    for (int y = 0; y < half.size_; ++y)
      for (int x = 0; x < half.size_; ++x)
        half.pixels_[half.index(x, y)] =
            0.25F * (pixels_[index(2 * x, 2 * y)] + pixels_[index(2 * x + 1, 2 * y)] +
                     pixels_[index(2 * x, 2 * y + 1)] + pixels_[index(2 * x + 1, 2 * y + 1)]);
    return half;
  }

  // Where distance_px(pixel) is within half the width, with a dark seam that shows it on a bright bone.
  template <typename Distance>
  void stroke(const Distance& distance_px, double width_px) {
    for (int y = 0; y < size_; ++y)
      for (int x = 0; x < size_; ++x) {
        const double away = distance_px(Vector2d(x + 0.5, y + 0.5)) - width_px / 2;
        Eigen::Vector3f& pixel = pixels_[index(x, y)];
        const auto blend = [&](double beyond, const Eigen::Vector3f& color) {
          const auto share = static_cast<float>(std::clamp(beyond + 0.5 - away, 0.0, 1.0));
          pixel += share * (color - pixel);
        };
        blend(1.2, kBackdrop);
        blend(0, vector_of(kMarkColor));
      }
  }

  [[nodiscard]] std::vector<std::uint32_t> rgba() const {
    std::vector<std::uint32_t> bytes;
    bytes.reserve(pixels_.size());
    std::ranges::transform(pixels_, std::back_inserter(bytes), rgba_of);
    return bytes;
  }

 private:
  [[nodiscard]] int clamped(double at) const { return static_cast<int>(std::clamp(at, 0.0, size_ - 1.0)); }
  [[nodiscard]] std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(size_) + static_cast<std::size_t>(x);
  }

  static inline const Eigen::Vector3f kBackdrop{0.047F, 0.059F, 0.075F};  // widgets::kBackground
  int size_;
  std::vector<Eigen::Vector3f> pixels_;
};

void draw_line(Canvas& canvas, const Vector2d& from, const Vector2d& to, double width_px) {
  canvas.stroke(
      [&](const Vector2d& at) {
        const Vector2d along = to - from;
        const double share = std::clamp((at - from).dot(along) / along.squaredNorm(), 0.0, 1.0);
        return (at - from - share * along).norm();
      },
      width_px);
}

void draw_circle(Canvas& canvas, const Vector2d& center, double radius_px, double width_px) {
  canvas.stroke([&](const Vector2d& at) { return std::abs((at - center).norm() - radius_px); }, width_px);
}

void draw_guide(Canvas& canvas, const SchematicBone& bone, const Definition& what, const Projection& to,
                double width_px) {
  const auto at = [&](std::string_view name) { return to(bone.landmarks.at(std::string(name))); };
  const Vector2d place = at(what.name);
  const auto through_place = [&](const Vector2d& along) {
    const Vector2d reach = kGuide_mm * to.px_per_mm * along;
    draw_line(canvas, place - reach, place + reach, width_px);
  };
  const auto along = [&](std::string_view from, std::string_view end) -> Vector2d {
    return (at(end) - at(from)).normalized();
  };
  const auto draw_roof = [&] {
    draw_line(canvas, at("blumensaat_anterior"), at("blumensaat_posterior"), width_px);
  };
  switch (what.guide) {
    case Guide::None:
      return;
    case Guide::Roof:
      return draw_roof();
    case Guide::AcrossRoof:
    case Guide::AlongRoof: {
      draw_roof();
      const Vector2d roof = along("blumensaat_anterior", "blumensaat_posterior");
      return through_place(what.guide == Guide::AlongRoof ? roof : roof.unitOrthogonal());
    }
    case Guide::Upright:
      return through_place(Vector2d::UnitY());
    case Guide::Level:
      return through_place(Vector2d::UnitX());
    case Guide::Circle:
      return draw_circle(canvas, place, (at(what.rim) - place).norm(), width_px);
    case Guide::Shaft: {
      // Beyond both of its points: the axis is what they tell.
      const Vector2d beyond = 0.5 * kGuide_mm * to.px_per_mm * along("shaft_distal", "shaft_proximal");
      return draw_line(canvas, at("shaft_distal") - beyond, at("shaft_proximal") + beyond, width_px);
    }
  }
}

}  // namespace

SchematicKnee make_schematic_knee(bones::Side side) {
  const phantom::PhantomKnee phantom = phantom::make_phantom_knee({.side = side, .edge_length_mm = kEdge_mm});
  SchematicKnee knee{side, {}};
  for (const auto& [bone, marks] : {std::pair{&phantom.femur, &phantom.femur_landmarks},
                                    std::pair{&phantom.tibia, &phantom.tibia_landmarks}}) {
    landmarks::Proposal proposal = landmarks::propose(bone->mesh, bone->kind, {.side = side});
    proposal.landmarks["native_footprint"] = marks->at("native_footprint");
    knee.bones[bone->kind] = {bone->mesh, geometry::vertex_normals(bone->mesh), proposal.axes,
                              std::move(proposal.landmarks)};
  }
  return knee;
}

LandmarkSketch sketch_landmark(const SchematicKnee& knee, BoneKind kind, std::string_view name, int size_px) {
  if (size_px < 16 || size_px > 2048) throw InvalidInput("a landmark's picture is 16 to 2048 pixels wide");
  const Definition& what = definition_of(kind, name);
  const SchematicBone& bone = knee.bones.at(kind);
  // Twice as fine: smooth edges.
  Canvas fine(2 * size_px);
  fine.fill(bone, projection_of(bone, what, 2 * size_px),
            what.view == ViewDirection::Notch ? scene::notch_cut(bone.mesh, bone.axes, bone.landmarks)
                                              : std::nullopt);
  Canvas canvas = fine.halved();
  const Projection to = projection_of(bone, what, size_px);
  const double line_px = std::max(0.011 * size_px, 1.0);
  draw_guide(canvas, bone, what, to, line_px);
  LandmarkSketch sketch;
  sketch.view = what.view;
  sketch.size_px = size_px;
  sketch.at_px = to(bone.landmarks.at(std::string(name)));
  draw_circle(canvas, sketch.at_px, 0.045 * size_px, 1.3 * line_px);
  draw_circle(canvas, sketch.at_px, 0, 0.035 * size_px);
  EdgeWords words = edge_words(to.axes.right, to.axes.up, bone.axes);
  sketch.left = std::move(words.left);
  sketch.right = std::move(words.right);
  sketch.rgba = canvas.rgba();
  return sketch;
}

}  // namespace arthronaut::plan
