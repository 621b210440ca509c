// Every number that the plan's panel, `arthronaut plan` and the report show of a real knee, computed another
// way: by every triangle of the mesh, by hand-written geometry in the plane, by counting points. A number
// that nothing here computes fails the test: whoever adds a check adds its other way.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <random>
#include <set>

#include "planning/bones/mesh_file.h"
#include "planning/bones/mesh_repair.h"
#include "planning/default_plan/default_plan.h"
#include "planning/plan_review/plan_review.h"
#include "planning/tunnels/diameter_range.h"
#include "tests/planning/tunnels/dense_wall.h"
#include "tests/real_data/real_data.h"

namespace arthronaut {
namespace {

using bones::BoneKind;
using bones::Side;
using Eigen::Vector2d;
using Eigen::Vector3d;
using norms::Bundle;

double deg(double rad) { return rad * 180 / std::numbers::pi; }

// A right knee and its mirror image, without a landmark by hand.
cases::Case real_knee(const std::filesystem::path& folder, Side side, const std::vector<Bundle>& bundles) {
  cases::Case knee;
  knee.name = "real";
  knee.side = side;
  for (const auto& [kind, file] :
       {std::pair{BoneKind::Femur, "femur_mesh_10k_pts.vtk"},
        std::pair{BoneKind::Tibia, "tibia_smoothed_image_10k_pts_thick_regions.vtk"}}) {
    geometry::TriangleMesh mesh = bones::read_mesh(folder / file);
    if (side == Side::Left) {
      for (Vector3d& vertex : mesh.vertices_mm) vertex.x() = -vertex.x();
      for (auto& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
    }
    const bones::Bone bone{kind, bones::mend_mesh(mesh).mesh, ""};
    const geometry::Surface surface(bone.mesh);
    const auto proposal = landmarks::propose(bone.mesh, kind, {.side = side});
    EXPECT_TRUE(proposal.is_usable()) << proposal.reason;
    landmarks::take_proposal(proposal, knee.landmarks[kind], knee.landmark_states[kind]);
    for (const Bundle bundle : bundles) {
      const auto planned = default_plan::plan_bone(
          {.bone = &bone, .surface = &surface, .landmarks = {}, .states = {}, .proposal = &proposal}, side,
          {.bundle = bundle, .diameter_mm = tunnels::usual_diameter_mm(bundle)});
      EXPECT_TRUE(planned.is_usable()) << planned.message;
      knee.plan.put(planned.tunnel, "");
    }
    knee.bones[kind] = bone;
  }
  return knee;
}

// Where a line meets the mesh, by every triangle: how far from its start.
std::vector<double> crossings(const geometry::TriangleMesh& mesh, const Vector3d& start,
                              const Vector3d& along) {
  std::vector<double> found;
  for (const auto& triangle : mesh.triangles) {
    const auto corner = [&](std::size_t i) {
      return mesh.vertices_mm[static_cast<std::size_t>(triangle[i])];
    };
    Eigen::Matrix3d system;
    system << corner(1) - corner(0), corner(2) - corner(0), -along;
    const Vector3d solved = system.partialPivLu().solve(start - corner(0));
    if (solved.allFinite() && solved.x() >= 0 && solved.y() >= 0 && solved.x() + solved.y() <= 1)
      found.push_back(solved.z());
  }
  std::ranges::sort(found);
  return found;
}

// One tunnel of the knee beside the bone that it is in, and beside the other end of its graft.
struct Panel {
  const cases::Case& knee;
  tunnels::Tunnel tunnel, other;  // other: in the other bone
  const tunnels::TunnelGeometry& shown;
  const tunnels::PlanSurroundings& known;   // its axes alone are taken over; anatomical_axes_test has them
  const std::vector<Vector3d>& outline_mm;  // of the expected footprint

  const geometry::TriangleMesh& mesh() const { return knee.bones.at(tunnel.bone).mesh; }
  Vector3d mark(const char* name) const { return knee.landmarks.at(tunnel.bone).at(name); }
  Vector3d femoral(const char* name) const { return knee.landmarks.at(BoneKind::Femur).at(name); }

  // From 20 mm before the entry: bone begins at the crossing nearest to it, and ends at the next one.
  std::pair<Vector3d, Vector3d> in_bone(const tunnels::Tunnel& of) const {
    const Vector3d start = of.entry_mm - 20 * of.direction;
    const auto at = crossings(knee.bones.at(of.bone).mesh, start, of.direction);
    std::size_t entry = 0;
    for (std::size_t i = 0; i < at.size(); i += 2)
      if (std::abs(at[i] - 20) < std::abs(at[entry] - 20)) entry = i;
    return {start + at.at(entry) * of.direction, start + at.at(entry + 1) * of.direction};
  }
  Vector3d entry() const { return in_bone(tunnel).first; }
  Vector3d exit() const { return in_bone(tunnel).second; }

  double length() const { return (exit() - entry()).norm(); }
  double wall() const {
    const geometry::Surface surface(mesh());
    return test::dense_wall(tunnel, shown, surface, {.count = 360, .step_mm = 0.1}).thickness_mm;
  }
  // In the plane of the true lateral view: x along Blumensaat's line, forwards, y away from it into the
  // condyle.
  Vector2d in_lateral_view(const Vector3d& point) const {
    const Vector3d view = (mark("lateral_condyle_center") - mark("medial_condyle_center")).normalized();
    const Eigen::Matrix3d flat = Eigen::Matrix3d::Identity() - view * view.transpose();
    const Vector3d x = (flat * (mark("blumensaat_anterior") - mark("blumensaat_posterior"))).normalized();
    const Vector3d low = flat * (mark("lateral_condyle_low") - mark("blumensaat_anterior"));
    const Vector3d y = (low - low.dot(x) * x).normalized();
    const Vector3d from = point - mark("blumensaat_anterior");
    return {from.dot(x), from.dot(y)};
  }
  double deep_to_shallow() const {
    const double deep = in_lateral_view(mark("lateral_condyle_deep")).x(),
                 shallow = in_lateral_view(mark("lateral_condyle_shallow")).x();
    return 100 * (in_lateral_view(entry()).x() - deep) / (shallow - deep);
  }
  double high_to_low() const {
    return 100 * in_lateral_view(entry()).y() / in_lateral_view(mark("lateral_condyle_low")).y();
  }
  double medial_to_lateral() const {
    const Vector3d across = mark("plateau_lateral") - mark("plateau_medial");
    return 100 * (entry() - mark("plateau_medial")).dot(across) / across.squaredNorm();
  }
  // Seen along the long axis, 8 degrees in front of what stands upright on the plateau: a step backwards on
  // the plateau goes down by as much.
  double anterior_to_posterior() const {
    const Vector3d across = (mark("plateau_lateral") - mark("plateau_medial")).normalized();
    Vector3d back = mark("plateau_posterior") - mark("plateau_anterior");
    back = (back - back.dot(across) * across).normalized();
    const Vector3d down_end = mark("tuberosity") - mark("plateau_anterior");
    // About the line across, so that it turns towards the knee.
    Vector3d seen = Eigen::AngleAxisd(8 * std::numbers::pi / 180, across) * back;
    if (seen.dot(down_end) > back.dot(down_end))
      seen = Eigen::AngleAxisd(-8 * std::numbers::pi / 180, across) * back;
    return 100 * (entry() - mark("plateau_anterior")).dot(seen) /
           (mark("plateau_posterior") - mark("plateau_anterior")).dot(seen);
  }
  double coronal() const {
    const Vector3d front = known.axes->anterior;
    const Vector3d flat = tunnel.direction - tunnel.direction.dot(front) * front;
    const double angle = deg(std::acos(std::abs(flat.normalized().dot(known.axes->lateral))));
    return angle;
  }
  double posterior_cortex() const {
    const landmarks::AnatomicalAxes& axes = *known.axes;
    double hindmost = 0;
    for (double up = -1.4; up <= 1.4; up += 0.7)
      for (double lateral = -14.5; lateral <= 4.5; lateral += 1)
        for (const double at :
             crossings(mesh(), exit() + up * axes.proximal + lateral * axes.lateral, -axes.anterior))
          hindmost = std::max(hindmost, at);
    return hindmost;
  }
  // The mean normal of the triangles that lie within the drill's circle, as large as the drill sees them.
  double opening_deg() const {
    Vector3d sum = Vector3d::Zero();
    const Vector3d start = entry(), &d = tunnel.direction;
    for (const auto& triangle : mesh().triangles) {
      const auto corner = [&](std::size_t i) {
        return mesh().vertices_mm[static_cast<std::size_t>(triangle[i])];
      };
      const Vector3d normal = (corner(1) - corner(0)).cross(corner(2) - corner(0)),
                     from = (corner(0) + corner(1) + corner(2)) / 3 - start;
      const bool is_within = (from - from.dot(d) * d).norm() < tunnel.diameter_mm / 2;
      if (is_within && std::abs(from.dot(d)) < 2 * tunnel.diameter_mm && normal.dot(d) < 0)
        sum += -normal.dot(d) / normal.norm() * normal;
    }
    return deg(std::asin(-sum.normalized().dot(d)));
  }
  // Points of the bone within the expected outline, seen along the outline's own normal: how many the drill
  // takes. Each triangle is strewn evenly, by its area.
  double footprint_opened() const {
    Vector3d middle = Vector3d::Zero(), face = Vector3d::Zero();
    for (std::size_t i = 0; i < outline_mm.size(); ++i) {
      middle += outline_mm[i] / static_cast<double>(outline_mm.size());
      face += outline_mm[i].cross(outline_mm[(i + 1) % outline_mm.size()]);
    }
    face.normalize();
    if (face.dot(tunnel.direction) > 0) face = -face;
    const auto holds = [&](const Vector3d& p) {
      double turned = 0;  // the outline's winding about it
      for (std::size_t i = 0; i < outline_mm.size(); ++i) {
        Vector3d a = outline_mm[i] - p, b = outline_mm[(i + 1) % outline_mm.size()] - p;
        a -= a.dot(face) * face;
        b -= b.dot(face) * face;
        turned += std::atan2(a.cross(b).dot(face), a.dot(b));
      }
      return std::abs(turned) > std::numbers::pi;
    };
    std::mt19937 random(8);
    std::uniform_real_distribution<double> unit(0, 1);
    double all = 0, opened = 0;
    for (const auto& triangle : mesh().triangles) {
      const auto corner = [&](std::size_t i) {
        return mesh().vertices_mm[static_cast<std::size_t>(triangle[i])];
      };
      const Vector3d ab = corner(1) - corner(0), ac = corner(2) - corner(0);
      if ((corner(0) - middle).norm() > 20 || ab.cross(ac).dot(face) <= 0) continue;
      for (auto points = static_cast<int>(100 * ab.cross(ac).norm() + unit(random)); points > 0; --points) {
        double u = unit(random), v = unit(random);
        if (u + v > 1) u = 1 - u, v = 1 - v;
        const Vector3d p = corner(0) + u * ab + v * ac;
        if (!holds(p)) continue;
        all += 1;
        opened += (p - tunnel.entry_mm).cross(tunnel.direction).norm() < tunnel.diameter_mm / 2;
      }
    }
    return 100 * opened / all;
  }
  double graft_length() const { return (entry() - in_bone(other).first).norm(); }
  // The tibial end turned about the line through the condyles' centres, a degree at a time; flexion takes the
  // shin backwards.
  template <typename See>
  void over_flexion(const See& see) const {
    const bool is_femur = tunnel.bone == BoneKind::Femur;
    const tunnels::Tunnel &femur = is_femur ? tunnel : other, &tibia = is_femur ? other : tunnel;
    const Vector3d from = in_bone(femur).first, to = in_bone(tibia).first,
                   center = (femoral("lateral_condyle_center") + femoral("medial_condyle_center")) / 2;
    Vector3d axis = (femoral("lateral_condyle_center") - femoral("medial_condyle_center")).normalized();
    const Vector3d shin = to - center + 100 * tibia.direction;
    const Vector3d front = femoral("blumensaat_anterior") - femoral("lateral_condyle_posterior");
    if ((Eigen::AngleAxisd(std::numbers::pi / 2, axis) * shin).dot(front) > 0) axis = -axis;
    for (int flexion = 0; flexion <= 120; flexion += 5) {
      const Eigen::AngleAxisd turn(flexion * std::numbers::pi / 180, axis);
      const Vector3d there = center + turn * (to - center), graft = there - from;
      see(graft, femur.direction, turn * tibia.direction);
    }
  }
  double length_change() const {
    double least = 1e9, most = 0;
    over_flexion([&](const Vector3d& graft, const Vector3d&, const Vector3d&) {
      least = std::min(least, graft.norm());
      most = std::max(most, graft.norm());
    });
    return most - least;
  }
  // Straight on is 180 degrees between the graft's way out and the tunnel's way in.
  double greatest_bend() const {
    double greatest = 0;
    over_flexion([&](const Vector3d& graft, const Vector3d& into_femur, const Vector3d& into_tibia) {
      const double cosine = tunnel.bone == BoneKind::Femur ? -graft.normalized().dot(into_femur)
                                                           : graft.normalized().dot(into_tibia);
      greatest = std::max(greatest, deg(std::acos(cosine)));
    });
    return greatest;
  }
};

// The value of each row, by its name; within how much.
struct OtherWay {
  std::function<double(const Panel&)> compute;
  double within;
};
const std::map<std::string, OtherWay>& other_ways() {
  const auto to_mark = [](const char* name) {
    return [name](const Panel& p) { return (p.exit() - p.mark(name)).norm(); };
  };
  static const std::map<std::string, OtherWay> ways{
      {"Length", {&Panel::length, 0.02}},
      // A grid of rays finds no thinner place, and comes near to the thinnest.
      {"Wall", {&Panel::wall, 0.1}},
      {"Diameter", {[](const Panel& p) { return p.tunnel.diameter_mm; }, 1e-9}},
      {"Deep to shallow", {&Panel::deep_to_shallow, 0.02}},
      {"High to low", {&Panel::high_to_low, 0.02}},
      {"Anterior to posterior", {&Panel::anterior_to_posterior, 0.02}},
      {"Medial to lateral", {&Panel::medial_to_lateral, 0.02}},
      {"Coronal angle", {&Panel::coronal, 0.01}},
      {"Lateral epicondyle", {to_mark("lateral_epicondyle"), 0.02}},
      {"Tuberosity", {to_mark("tuberosity"), 0.02}},
      // All of the surface on one side, rays a millimetre apart on the other.
      {"Posterior cortex", {&Panel::posterior_cortex, 0.5}},
      // Whole triangles on one side, their parts within the circle on the other.
      {"Opening", {&Panel::opening_deg, 2}},
      {"Footprint opened", {&Panel::footprint_opened, 1}},
      {"Graft length", {&Panel::graft_length, 0.02}},
      {"Length over flexion", {&Panel::length_change, 0.02}},
      {"Bend at the femur", {&Panel::greatest_bend, 0.05}},
      {"Bend at the tibia", {&Panel::greatest_bend, 0.05}}};
  return ways;
}

// These are of the knee as a whole: roof_clearance_test, tunnel_pair_test and knee_checks_test have them
// another way.
const std::set<std::string> kElsewhere{"Roof", "Between the tunnels", "Against the insertions"};

TEST(RealPanel, EveryNumberComesOutTheSameAnotherWay) {
  ARTHRONAUT_REQUIRE_DATA(folder, "bones/mri-femora");
  for (const Side side : {Side::Right, Side::Left}) {
    for (const auto& bundles : {std::vector<Bundle>{Bundle::Whole},
                                std::vector<Bundle>{Bundle::Anteromedial, Bundle::Posterolateral}}) {
      const cases::Case knee = real_knee(folder, side, bundles);
      const plan_review::CaseReview review(knee);
      for (const auto& [key, planned] : review.tunnels()) {
        SCOPED_TRACE(std::string(bones::to_text(side)) + ", " + tunnels::name_of(key));
        ASSERT_TRUE(planned.geometry.enters_bone);
        const auto* end = plan_review::other_end(key, review.tunnels());
        ASSERT_NE(end, nullptr);
        const Panel panel{knee,
                          planned.tunnel,
                          end->tunnel,
                          planned.geometry,
                          review.bone(key.bone).surroundings,
                          review.bone(key.bone).footprints.at(key.bundle).outline_mm};
        std::size_t compared = 0;
        for (const tunnels::PlanCheck& check : review.checks(key)) {
          if (!check.value || kElsewhere.contains(check.name)) continue;
          const auto way = other_ways().find(check.name);
          if (way == other_ways().end()) {
            ADD_FAILURE() << "nothing computes \"" << check.name << "\" another way";
            continue;
          }
          EXPECT_NEAR(*check.value, way->second.compute(panel), way->second.within) << check.name;
          ++compared;
        }
        EXPECT_GE(compared, key.bone == BoneKind::Femur ? 10U : 8U);
      }
    }
  }
}

}  // namespace
}  // namespace arthronaut
