#include "planning/phantom/phantom_knee.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>

#include "planning/bones/made_bone.h"
#include "planning/geometry/error.h"
#include "planning/geometry/surface.h"
#include "planning/landmarks/insertion_grids.h"
#include "planning/phantom/implicit_mesh.h"
#include "planning/phantom/knee_shape.h"
#include "planning/tunnels/aim.h"

namespace arthronaut::phantom {

namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using geometry::Surface;
using landmarks::Landmarks;

// Where the native ligament inserts: Bernard and Hertel's quadrant (deep to shallow, high to low) and Amis
// and Jakob's line (anterior to posterior) with the medial-lateral share. Means of published studies, in
// percent.
constexpr double kFemurDeepShallow = 28, kFemurHighLow = 35;
constexpr double kTibiaAnteroposterior = 41, kTibiaMediolateral = 47;

// A bone in the anatomical frame of knee_shape.h: x lateral, y anterior, z superior.
struct AnatomicalBone {
  geometry::TriangleMesh mesh;
  Surface surface;
  explicit AnatomicalBone(geometry::TriangleMesh m) : mesh(std::move(m)), surface(mesh) {}

  // First surface point from `origin` along `direction`. The phantom's own shape promises that there is one.
  [[nodiscard]] Vector3d hit(const Vector3d& origin, const Vector3d& direction) const {
    const auto found = surface.first_hit(origin, direction);
    if (!found) throw std::logic_error("phantom: a landmark's ray misses the bone");
    return found->point_mm;
  }
  // The vertex that lies furthest along a direction, among those that `among` admits.
  template <typename Predicate>
  [[nodiscard]] Vector3d furthest(const Vector3d& direction, Predicate among) const {
    const Vector3d* best = nullptr;
    for (const auto& v : mesh.vertices_mm) {
      if (among(v) && (best == nullptr || v.dot(direction) > best->dot(direction))) best = &v;
    }
    if (best == nullptr) throw std::logic_error("phantom: a landmark's region is empty");
    return *best;
  }
};

Vector3d in_sagittal_plane(double x, const Vector2d& yz) { return {x, yz.x(), yz.y()}; }

Landmarks femur_landmarks(const FemurShape& shape, const AnatomicalBone& femur) {
  const double scale = shape.parameters().scale, middle = shape.notch_middle_x_mm();
  const auto is_condylar = [&](const Vector3d& v) { return v.z() < 12 * scale; };
  Landmarks marks;
  marks["lateral_epicondyle"] = femur.furthest(Vector3d::UnitX(), is_condylar);
  marks["medial_epicondyle"] = femur.furthest(-Vector3d::UnitX(), is_condylar);
  marks["lateral_condyle_posterior"] =
      femur.furthest(-Vector3d::UnitY(), [&](const Vector3d& v) { return is_condylar(v) && v.x() > middle; });
  marks["medial_condyle_posterior"] =
      femur.furthest(-Vector3d::UnitY(), [&](const Vector3d& v) { return is_condylar(v) && v.x() < middle; });
  // The roof of the notch in the midline: along Blumensaat's line, seen from inside the notch.
  const auto on_roof = [&](double from_outlet_mm) {
    const Vector2d below =
        shape.roof_point() - from_outlet_mm * shape.roof_direction() + 4 * scale * shape.roof_normal();
    return femur.hit(in_sagittal_plane(middle, below), in_sagittal_plane(0, -shape.roof_normal()));
  };
  marks["blumensaat_anterior"] = on_roof(2 * scale);
  marks["notch_apex"] = on_roof(14 * scale);
  marks["blumensaat_posterior"] = on_roof(26 * scale);
  // The grid is the one that plans are judged by. Lateral, anterior and superior are right-handed in this
  // frame, as in a right knee, and the wall is met from the middle of the notch.
  const auto quadrant = landmarks::femoral_quadrant(femur.mesh, marks, bones::Side::Right);
  if (!quadrant) throw std::logic_error("phantom: no quadrant on the femur");
  const Vector3d in_notch =
      quadrant->point_at({.deep_shallow = kFemurDeepShallow, .high_low = kFemurHighLow});
  const Vector3d across = quadrant->low.cross(quadrant->shallow);
  marks["native_footprint"] = femur.hit(in_notch, across.x() > 0 ? across : -across);
  return marks;
}

Landmarks tibia_landmarks(const TibiaShape& shape, const AnatomicalBone& tibia) {
  const double scale = shape.parameters().scale, width = scale * shape.parameters().width_factor;
  const double top = geometry::bounds_of(tibia.mesh).max_mm.z();
  const auto is_plateau = [&](const Vector3d& v) { return v.z() > top - 22 * scale; };
  const auto from_above = [&](double x, double y) { return tibia.hit({x, y, top + 5}, -Vector3d::UnitZ()); };
  Landmarks marks;
  marks["plateau_anterior"] = tibia.furthest(Vector3d::UnitY(), is_plateau);
  marks["plateau_posterior"] = tibia.furthest(-Vector3d::UnitY(), is_plateau);
  marks["plateau_medial"] = tibia.furthest(-Vector3d::UnitX(), is_plateau);
  marks["plateau_lateral"] = tibia.furthest(Vector3d::UnitX(), is_plateau);
  marks["medial_eminence"] = from_above(-6.5 * width, -6 * scale);
  marks["lateral_eminence"] = from_above(6 * width, -9 * scale);
  marks["tuberosity"] = tibia.hit({4 * width, 60 * scale, top - 38 * scale}, -Vector3d::UnitY());
  const auto grid = landmarks::tibial_grid(marks);
  if (!grid) throw std::logic_error("phantom: no grid on the tibia");
  // Where the view from above that the shares are read in meets the plateau.
  const Vector3d in_plane =
      grid->point_at({.anterior_posterior = kTibiaAnteroposterior, .medial_lateral = kTibiaMediolateral});
  marks["native_footprint"] = tibia.hit(in_plane + 40 * scale * grid->up, -grid->up);
  return marks;
}

// Planned in the anatomical frame, so that a left knee's plan is the mirror image of a right one's to the
// last bit.
tunnels::Tunnel plan_tunnel(const AnatomicalBone& bone, bones::BoneKind kind, const Vector3d& entry) {
  const Vector3d patient = tunnels::customary_direction(kind, bones::Side::Left);
  const tunnels::Tunnel customary{.bone = kind,
                                  .entry_mm = entry,
                                  .direction = {patient.x(), -patient.y(), patient.z()},
                                  .diameter_mm = 9};
  return tunnels::aim(customary, bone.surface, tunnels::customary_aim(kind));
}

// The anatomical frame into LPS. A right knee's lateral is the patient's right; a left knee is its mirror
// image.
class ToPatient {
 public:
  explicit ToPatient(bones::Side side) : x_(side == bones::Side::Right ? -1 : 1) {}
  [[nodiscard]] Vector3d operator()(const Vector3d& p) const { return {x_ * p.x(), -p.y(), p.z()}; }
  [[nodiscard]] geometry::TriangleMesh operator()(geometry::TriangleMesh mesh) const {
    for (auto& v : mesh.vertices_mm) v = (*this)(v);
    if (x_ > 0) {  // one axis turned, not two: a mirror, which turns triangles inside out
      for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
    }
    return mesh;
  }
  [[nodiscard]] Landmarks operator()(Landmarks marks) const {
    for (auto& [name, position] : marks) position = (*this)(position);
    return marks;
  }
  [[nodiscard]] tunnels::Tunnel operator()(tunnels::Tunnel tunnel) const {
    tunnel.entry_mm = (*this)(tunnel.entry_mm);
    tunnel.direction = (*this)(tunnel.direction);
    return tunnel;
  }

 private:
  double x_;
};

}  // namespace

PhantomKnee make_phantom_knee(const PhantomOptions& options) {
  if (!(options.edge_length_mm >= 0.3 && options.edge_length_mm <= 5)) {
    throw InvalidInput("phantom: edge_length_mm must lie from 0.3 to 5");
  }
  const KneeParameters parameters = vary(options.seed);
  const FemurShape femur_shape(parameters);
  const TibiaShape tibia_shape(parameters);
  const auto bone_of = [&](const auto& shape) {
    return AnatomicalBone(mesh_of(
        shape,
        {.min_mm = shape.min_mm(), .max_mm = shape.max_mm(), .edge_length_mm = options.edge_length_mm}));
  };
  const AnatomicalBone femur = bone_of(femur_shape), tibia = bone_of(tibia_shape);
  const Landmarks femur_marks = femur_landmarks(femur_shape, femur),
                  tibia_marks = tibia_landmarks(tibia_shape, tibia);

  const auto femoral = plan_tunnel(femur, bones::BoneKind::Femur, femur_marks.at("native_footprint"));
  const auto tibial = plan_tunnel(tibia, bones::BoneKind::Tibia, tibia_marks.at("native_footprint"));

  const ToPatient to_patient(options.side);
  std::string source(bones::kMadeSource);
  source += ", seed " + std::to_string(options.seed);
  return {.side = options.side,
          .femur = {.kind = bones::BoneKind::Femur, .mesh = to_patient(femur.mesh), .source = source},
          .tibia = {.kind = bones::BoneKind::Tibia, .mesh = to_patient(tibia.mesh), .source = source},
          .femur_landmarks = to_patient(femur_marks),
          .tibia_landmarks = to_patient(tibia_marks),
          .femoral_tunnel = to_patient(femoral),
          .tibial_tunnel = to_patient(tibial)};
}

}  // namespace arthronaut::phantom
