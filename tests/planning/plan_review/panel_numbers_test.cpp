// Every number that Plan's panel, `arthronaut plan` and the plan sheet say of a tunnel, computed another way:
// by brute force over the triangles, by complex numbers in the picture plane, by chance. The wall, the breach
// and what is between two tunnels are held against dense sampling in tunnel_wall_test.cpp, breach_test.cpp
// and tunnel_pair_test.cpp; that the words say the number that is judged, in plan_review_test.cpp.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdio>
#include <map>
#include <memory>
#include <random>
#include <utility>

#include "planning/phantom/phantom_case.h"
#include "planning/plan_review/plan_review.h"
#include "planning/plan_review/proposed_landmarks.h"

namespace arthronaut::plan_review {
namespace {

using bones::BoneKind;
using Eigen::Vector3d;

constexpr double kPi = 3.14159265358979323846;
constexpr double kExact_mm = 1e-6, kExact = 1e-6;

double deg_between(const Vector3d& a, const Vector3d& b) {
  return std::acos(std::clamp(a.normalized().dot(b.normalized()), -1.0, 1.0)) * 180 / kPi;
}

// Where the axis goes through the mesh: every triangle is asked (by the volumes of tetrahedra), none is
// sought.
std::vector<double> crossings_mm(const geometry::TriangleMesh& mesh, const tunnels::Tunnel& tunnel) {
  const Vector3d a = tunnel.entry_mm - 300 * tunnel.direction, b = tunnel.entry_mm + 300 * tunnel.direction;
  const auto volume = [](const Vector3d& p, const Vector3d& q, const Vector3d& r, const Vector3d& s) {
    return (q - p).cross(r - p).dot(s - p);
  };
  std::vector<double> at;
  for (const auto& triangle : mesh.triangles) {
    const Vector3d &p = mesh.vertices_mm[static_cast<std::size_t>(triangle[0])],
                   &q = mesh.vertices_mm[static_cast<std::size_t>(triangle[1])],
                   &r = mesh.vertices_mm[static_cast<std::size_t>(triangle[2])];
    const double before = volume(p, q, r, a), after = volume(p, q, r, b);
    if ((before > 0) == (after > 0)) continue;
    const double pq = volume(a, b, p, q), qr = volume(a, b, q, r), rp = volume(a, b, r, p);
    if ((pq > 0) != (qr > 0) || (qr > 0) != (rp > 0)) continue;
    at.push_back(600 * before / (before - after) - 300);
  }
  std::ranges::sort(at);
  return at;
}

struct Ends {
  Vector3d entry_mm, exit_mm;
};
Ends ends_of(const geometry::TriangleMesh& mesh, const tunnels::Tunnel& tunnel) {
  const std::vector<double> at = crossings_mm(mesh, tunnel);
  std::size_t entry = 0;
  for (std::size_t i = 0; i + 1 < at.size(); i += 2)  // outside, inside, outside, ...
    if (std::abs(at[i]) < std::abs(at[entry])) entry = i;
  return {tunnel.entry_mm + at.at(entry) * tunnel.direction,
          tunnel.entry_mm + at.at(entry + 1) * tunnel.direction};
}

// The phantom with every landmark that there is: those that its shape proposes, and its own footprints.
struct KneeAndShape {
  cases::Case knee;
  std::map<BoneKind, ProposedBone> by_shape;
};
const KneeAndShape& knee_of_all_landmarks(bones::Side side) {
  static std::map<bones::Side, KneeAndShape> made;
  if (const auto there = made.find(side); there != made.end()) return there->second;
  cases::Case knee =
      phantom::case_of(phantom::make_phantom_knee({.side = side, .edge_length_mm = 2}), "test");
  const auto own = std::exchange(knee.landmarks, {});
  auto by_shape = propose_landmarks(knee, Proposing::WithoutGrid);
  for (const auto& [kind, marks] : own)
    knee.landmarks.at(kind)["native_footprint"] = marks.at("native_footprint");
  return made.emplace(side, KneeAndShape{std::move(knee), std::move(by_shape)}).first->second;
}

// A planned knee with tunnels a hand may have aimed.
class PanelNumbers : public ::testing::TestWithParam<bones::Side> {
 protected:
  void SetUp() override {
    knee_ = knee_of_all_landmarks(GetParam()).knee;
    std::mt19937 random(11);
    std::uniform_real_distribution<double> turn(-0.12, 0.12);
    for (auto& [key, tunnel] : knee_.plan.tunnels)
      tunnel.direction = (tunnel.direction + Vector3d(turn(random), turn(random), turn(random))).normalized();
    review_ = std::make_unique<CaseReview>(knee_, knee_of_all_landmarks(GetParam()).by_shape);
    for (const BoneKind kind : {BoneKind::Femur, BoneKind::Tibia})
      ends_.emplace(kind, ends_of(knee_.bones.at(kind).mesh, knee_.plan.tunnels.at(kind)));
  }
  [[nodiscard]] tunnels::PlanCheck check(BoneKind kind, const char* name) const {
    for (auto& one : review_->checks(kind))
      if (one.name == name) return one;
    ADD_FAILURE() << "no check " << name;
    return {};
  }
  [[nodiscard]] double number(BoneKind kind, const char* name) const {
    return check(kind, name).value.value_or(std::nan(""));
  }
  [[nodiscard]] const tunnels::Tunnel& tunnel(BoneKind kind) const { return knee_.plan.tunnels.at(kind); }
  [[nodiscard]] const Vector3d& mark(BoneKind kind, const char* name) const {
    return knee_.landmarks.at(kind).at(name);
  }
  // The tibia's point with the knee bent about the line through the condyles' centres.
  [[nodiscard]] Vector3d bent(const Vector3d& of_tibia, double flexion_deg) const {
    const Vector3d &lateral = mark(BoneKind::Femur, "lateral_condyle_center"),
                   &medial = mark(BoneKind::Femur, "medial_condyle_center");
    const Vector3d leftwards =
        GetParam() == bones::Side::Right ? Vector3d(medial - lateral) : Vector3d(lateral - medial);
    // To the patient's left, right-handed: what is below goes backwards.
    const Eigen::Quaterniond turn(Eigen::AngleAxisd(flexion_deg * kPi / 180, leftwards.normalized()));
    return lateral + turn * (of_tibia - lateral);
  }

  cases::Case knee_;
  std::unique_ptr<CaseReview> review_;
  std::map<BoneKind, Ends> ends_;
};

TEST_P(PanelNumbers, LengthIsBetweenTheTrianglesThatTheAxisGoesThrough) {
  for (const auto& [kind, ends] : ends_) {
    const double length_mm = (ends.exit_mm - ends.entry_mm).norm();
    EXPECT_NEAR(number(kind, "Length"), length_mm, kExact_mm);
    const tunnels::TunnelGeometry& measured = review_->tunnels().at(kind).geometry;
    EXPECT_NEAR(measured.length_mm, length_mm, kExact_mm);
    EXPECT_LT((measured.exit_mm - ends.exit_mm).norm(), kExact_mm) << "\"Leaves the bone\"";
    EXPECT_LT((measured.entry_on_surface_mm - ends.entry_mm).norm(), kExact_mm);
    EXPECT_EQ(number(kind, "Diameter"), tunnel(kind).diameter_mm);
  }
}

TEST_P(PanelNumbers, WhatIsNearTheExitIsAsFarAsTheRulerSays) {
  EXPECT_NEAR(number(BoneKind::Femur, "Lateral epicondyle"),
              (ends_.at(BoneKind::Femur).exit_mm - mark(BoneKind::Femur, "lateral_epicondyle")).norm(),
              kExact_mm);
  EXPECT_NEAR(number(BoneKind::Tibia, "Tuberosity"),
              (ends_.at(BoneKind::Tibia).exit_mm - mark(BoneKind::Tibia, "tuberosity")).norm(), kExact_mm);
  for (const BoneKind kind : {BoneKind::Femur, BoneKind::Tibia})
    EXPECT_NEAR(number(kind, "Footprint"), (ends_.at(kind).entry_mm - mark(kind, "native_footprint")).norm(),
                kExact_mm);
}

// Against points all over the surface, which lie up to a tenth of an edge before the hindmost one.
TEST_P(PanelNumbers, PosteriorCortexIsAsFarBackAsTheSurfaceGoes) {
  const landmarks::AnatomicalAxes& axes = *review_->bone(BoneKind::Femur).surroundings.axes;
  const Vector3d& exit = ends_.at(BoneKind::Femur).exit_mm;
  const geometry::TriangleMesh& mesh = knee_.bones.at(BoneKind::Femur).mesh;
  double hindmost_mm = 0;
  for (const auto& triangle : mesh.triangles)
    for (int i = 0; i <= 10; ++i)
      for (int j = 0; i + j <= 10; ++j) {
        const Vector3d p = (i * mesh.vertices_mm[static_cast<std::size_t>(triangle[0])] +
                            j * mesh.vertices_mm[static_cast<std::size_t>(triangle[1])] +
                            (10 - i - j) * mesh.vertices_mm[static_cast<std::size_t>(triangle[2])]) /
                           10;
        const Vector3d away = p - exit;
        const double lateral_mm = away.dot(axes.lateral);
        if (std::abs(away.dot(axes.proximal)) > 1.5 || lateral_mm > 5 || lateral_mm < -15) continue;
        hindmost_mm = std::max(hindmost_mm, -away.dot(axes.anterior));
      }
  EXPECT_NEAR(number(BoneKind::Femur, "Posterior cortex"), hindmost_mm + 0.05, 0.06);
}

// In the plane of the true lateral view, with the roof as the unit of complex numbers.
TEST_P(PanelNumbers, TheQuadrantIsReadInThePictureOfTheLateralView) {
  const Vector3d along_view =
      mark(BoneKind::Femur, "lateral_condyle_center") - mark(BoneKind::Femur, "medial_condyle_center");
  const Vector3d right = along_view.unitOrthogonal(), up = along_view.normalized().cross(right);
  const auto in_picture = [&](const Vector3d& p) { return std::complex<double>(p.dot(right), p.dot(up)); };
  const std::complex<double> front = in_picture(mark(BoneKind::Femur, "blumensaat_anterior")),
                             back = in_picture(mark(BoneKind::Femur, "blumensaat_posterior"));
  const auto in_roof = [&](const Vector3d& p) { return (in_picture(p) - front) / (front - back); };
  const double deep = in_roof(mark(BoneKind::Femur, "lateral_condyle_deep")).real(),
               shallow = in_roof(mark(BoneKind::Femur, "lateral_condyle_shallow")).real(),
               low = in_roof(mark(BoneKind::Femur, "lateral_condyle_low")).imag();
  const std::complex<double> entry = in_roof(ends_.at(BoneKind::Femur).entry_mm);
  EXPECT_NEAR(number(BoneKind::Femur, "Deep to shallow"), 100 * (entry.real() - deep) / (shallow - deep),
              kExact);
  EXPECT_NEAR(number(BoneKind::Femur, "High to low"), 100 * entry.imag() / low, kExact);
}

// By planes: how far the entry is from that of one edge, of the way between both edges.
TEST_P(PanelNumbers, ThePlateauIsSharedByPlanesThroughItsEdges) {
  const Vector3d &front = mark(BoneKind::Tibia, "plateau_anterior"),
                 &back = mark(BoneKind::Tibia, "plateau_posterior"),
                 &medial = mark(BoneKind::Tibia, "plateau_medial"),
                 &lateral = mark(BoneKind::Tibia, "plateau_lateral");
  const Vector3d across = (lateral - medial).normalized();
  Vector3d up = across.cross(back - front).normalized();
  if (up.z() < 0) up = -up;  // the phantom stands upright
  const Vector3d backwards = across.cross(up).dot(back - front) > 0 ? across.cross(up) : up.cross(across);
  // The long axis stands 8 degrees in front of the plateau's own: what is seen along it falls backwards.
  const Vector3d seen_backwards = std::cos(8 * kPi / 180) * backwards + std::sin(8 * kPi / 180) * up;
  const Vector3d& entry = ends_.at(BoneKind::Tibia).entry_mm;
  const auto share = [&](const Vector3d& from, const Vector3d& to, const Vector3d& normal) {
    const Eigen::Hyperplane<double, 3> zero(normal.normalized(), from);
    return 100 * zero.signedDistance(entry) / zero.signedDistance(to);
  };
  EXPECT_NEAR(number(BoneKind::Tibia, "Anterior to posterior"), share(front, back, seen_backwards), kExact);
  EXPECT_NEAR(number(BoneKind::Tibia, "Medial to lateral"), share(medial, lateral, across), kExact);
}

// Between the plateau's line and the tunnel's shadow, seen from in front.
TEST_P(PanelNumbers, CoronalAngleIsThatOfTheTunnelsShadow) {
  const landmarks::AnatomicalAxes& axes = *review_->bone(BoneKind::Tibia).surroundings.axes;
  const Vector3d shadow = ends_.at(BoneKind::Tibia).exit_mm - ends_.at(BoneKind::Tibia).entry_mm;
  const Vector3d in_front = shadow - shadow.dot(axes.anterior) * axes.anterior;
  const double angle = deg_between(in_front, axes.lateral);
  EXPECT_NEAR(number(BoneKind::Tibia, "Coronal angle"), std::min(angle, 180 - angle), kExact);
}

// By chance: of points strewn over the bone within the footprint's outline, those within the drill.
TEST_P(PanelNumbers, FootprintOpenedIsWhatPointsStrewnOverItSay) {
  for (const BoneKind kind : {BoneKind::Femur, BoneKind::Tibia}) {
    const auto& outline = review_->bone(kind).footprints.at(norms::Bundle::Whole).outline_mm;
    const geometry::TriangleMesh& mesh = review_->bone(kind).surface->mesh();
    Vector3d middle = Vector3d::Zero(), normal = Vector3d::Zero();
    for (std::size_t i = 0; i < outline.size(); ++i) {
      middle += outline[i] / static_cast<double>(outline.size());
      normal += outline[i].cross(outline[(i + 1) % outline.size()]);
    }
    if (normal.dot(review_->bone(kind).surface->closest_point(middle).normal) < 0) normal = -normal;
    normal.normalize();
    const auto is_within = [&](const Vector3d& p) {  // by how often the outline winds about it
      double winding = 0;
      for (std::size_t i = 0; i < outline.size(); ++i) {
        const Vector3d a = outline[i] - p, b = outline[(i + 1) % outline.size()] - p;
        const Vector3d flat_a = a - a.dot(normal) * normal, flat_b = b - b.dot(normal) * normal;
        winding += std::atan2(flat_a.cross(flat_b).dot(normal), flat_a.dot(flat_b));
      }
      return std::abs(winding) > kPi;
    };
    std::mt19937 random(5);
    std::uniform_real_distribution<double> unit(0, 1);
    constexpr double kPerPoint_mm2 = 0.005;
    int in_footprint = 0, in_both = 0;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      const auto corner = [&](std::size_t i) {
        return mesh.vertices_mm[static_cast<std::size_t>(mesh.triangles[t][i])];
      };
      const Vector3d a = corner(0), ab = corner(1) - a, ac = corner(2) - a;
      if ((a - middle).norm() > 20 || ab.cross(ac).dot(normal) <= 0) continue;
      // A share of a point is one with that chance.
      const int points = static_cast<int>(0.5 * ab.cross(ac).norm() / kPerPoint_mm2 + unit(random));
      for (int i = 0; i < points; ++i) {
        double u = unit(random), v = unit(random);
        if (u + v > 1) u = 1 - u, v = 1 - v;
        const Vector3d p = a + u * ab + v * ac;
        if (!is_within(p)) continue;
        ++in_footprint;
        const Vector3d from_entry = p - tunnel(kind).entry_mm;
        if (from_entry.cross(tunnel(kind).direction).norm() < 0.5 * tunnel(kind).diameter_mm) ++in_both;
      }
    }
    const tunnels::PlanCheck said = check(kind, "Footprint opened");
    EXPECT_NEAR(*said.value, 100.0 * in_both / in_footprint, 1)
        << said.text;  // three sigma of so many points
    const double area_mm2 = kPerPoint_mm2 * in_footprint;
    double percent = 0, said_mm2 = 0;
    ASSERT_EQ(std::sscanf(said.text.c_str(), "%lf %% of the expected %lf mm2", &percent, &said_mm2), 2);
    EXPECT_NEAR(said_mm2, area_mm2, 0.02 * area_mm2 + 0.5) << said.text;
  }
}

TEST_P(PanelNumbers, GraftLengthIsBetweenTheOpenings) {
  const Ends &femur = ends_.at(BoneKind::Femur), &tibia = ends_.at(BoneKind::Tibia);
  const tunnels::PlanCheck said = check(BoneKind::Femur, "Graft length");
  const double in_joint_mm = (femur.entry_mm - tibia.entry_mm).norm();
  EXPECT_NEAR(*said.value, in_joint_mm, kExact_mm);
  double first = 0, all_mm = 0;
  ASSERT_EQ(std::sscanf(said.text.c_str(), "%lf mm in the joint, %lf mm in all", &first, &all_mm), 2);
  EXPECT_NEAR(all_mm,
              in_joint_mm + (femur.exit_mm - femur.entry_mm).norm() + (tibia.exit_mm - tibia.entry_mm).norm(),
              0.0501);
}

// The tibia turned by quaternions, a graft and a ligament measured in each position.
TEST_P(PanelNumbers, LengthAndBendsOverFlexionFollowTheTurnedTibia) {
  const Vector3d &femur = ends_.at(BoneKind::Femur).entry_mm, &tibia = ends_.at(BoneKind::Tibia).entry_mm;
  const Vector3d beyond = tibia + 10 * tunnel(BoneKind::Tibia).direction;  // on the tibial tunnel's axis
  const Vector3d &of_femur = mark(BoneKind::Femur, "native_footprint"),
                 &of_tibia = mark(BoneKind::Tibia, "native_footprint");
  double shortest = 1e9, longest = 0, longest_at_deg = 0, most_off = 0, femoral = 0, tibial = 0;
  const double extended = (femur - tibia).norm(), own_extended = (of_femur - of_tibia).norm();
  for (int deg = 0; deg <= 120; deg += 5) {
    const Vector3d here = bent(tibia, deg);
    const double length = (femur - here).norm();
    shortest = std::min(shortest, length);
    if (length > longest) longest_at_deg = deg;
    longest = std::max(longest, length);
    const double own = (of_femur - bent(of_tibia, deg)).norm();
    most_off = std::max(most_off, std::abs((length - extended) - (own - own_extended)));
    femoral = std::max(femoral, deg_between(tunnel(BoneKind::Femur).direction, femur - here));
    tibial = std::max(tibial, deg_between(bent(beyond, deg) - here, here - femur));
  }
  const tunnels::PlanCheck change = check(BoneKind::Femur, "Length over flexion");
  EXPECT_NEAR(*change.value, longest - shortest, kExact_mm);
  double first = 0, at_deg = 0;
  ASSERT_EQ(std::sscanf(change.text.c_str(), "%lf mm from 0 to 120 deg, longest at %lf deg", &first, &at_deg),
            2);
  EXPECT_NEAR(at_deg, longest_at_deg, 0.051);
  EXPECT_NEAR(number(BoneKind::Femur, "Against the insertions"), most_off, kExact_mm);
  const tunnels::PlanCheck at_femur = check(BoneKind::Femur, "Bend at the femur"),
                           at_tibia = check(BoneKind::Tibia, "Bend at the tibia");
  EXPECT_NEAR(*at_femur.value, femoral, 1e-4);
  EXPECT_NEAR(*at_tibia.value, tibial, 1e-4);
  ASSERT_EQ(std::sscanf(at_femur.text.c_str(), "%lf deg extended", &first), 1);
  EXPECT_NEAR(first, deg_between(tunnel(BoneKind::Femur).direction, femur - tibia), 0.0501);
  ASSERT_EQ(std::sscanf(at_tibia.text.c_str(), "%lf deg extended", &first), 1);
  EXPECT_NEAR(first, deg_between(tunnel(BoneKind::Tibia).direction, tibia - femur), 0.0501);
}

// By planes that stand on the lateral view: the front of the prolonged drill, and the roof.
TEST_P(PanelNumbers, RoofIsAsFarFromTheProlongedDrillAsItsPlanesSay) {
  const landmarks::AnatomicalAxes& axes = *review_->bone(BoneKind::Femur).surroundings.axes;
  const auto seen = [&](const Vector3d& v) { return Vector3d(v - v.dot(axes.lateral) * axes.lateral); };
  const Vector3d outlet = mark(BoneKind::Femur, "blumensaat_anterior"),
                 roof = seen(mark(BoneKind::Femur, "blumensaat_posterior") - outlet).normalized(),
                 drill = seen(-tunnel(BoneKind::Tibia).direction).normalized();
  const auto in_front_of = [&](const Vector3d& line) {  // unit, across the line, to the front
    const Vector3d across = line.cross(axes.lateral);
    return Vector3d(across.dot(axes.anterior) > 0 ? across : -across);
  };
  const Vector3d front_of_drill =
      ends_.at(BoneKind::Tibia).entry_mm + 0.5 * tunnel(BoneKind::Tibia).diameter_mm * in_front_of(drill);
  const double outlet_mm =
      Eigen::Hyperplane<double, 3>(in_front_of(drill), front_of_drill).signedDistance(outlet);
  const double opening_mm =
      -Eigen::Hyperplane<double, 3>(in_front_of(roof), outlet).signedDistance(front_of_drill);
  EXPECT_NEAR(number(BoneKind::Tibia, "Roof"), std::min(outlet_mm, opening_mm), kExact_mm);
}

// They are where the shape puts them, but for one that a hand moves by 1, 2 and 2 mm.
TEST_P(PanelNumbers, LandmarksIsHowFarOneWasMoved) {
  for (const auto& [kind, name] :
       {std::pair{BoneKind::Femur, "notch_apex"}, {BoneKind::Tibia, "tuberosity"}}) {
    EXPECT_FALSE(check(kind, "Landmarks").value) << "the shape against itself";
    cases::Case knee = knee_;
    knee.landmark_states[kind].clear();
    knee.landmarks[kind].at(name) += Vector3d(1, -2, 2);
    const CaseReview review(knee, knee_of_all_landmarks(GetParam()).by_shape);
    EXPECT_NEAR(*review.landmark_check(kind).value, 3, kExact_mm) << name;
  }
}

// Nothing that has a number is left out above: a new check needs a computation here, too.
TEST_P(PanelNumbers, AllOfThemAreComputedAnotherWay) {
  const std::vector<std::string> covered{"Length",
                                         "Wall",
                                         "Diameter",
                                         "Lateral epicondyle",
                                         "Tuberosity",
                                         "Footprint",
                                         "Posterior cortex",
                                         "Deep to shallow",
                                         "High to low",
                                         "Anterior to posterior",
                                         "Medial to lateral",
                                         "Coronal angle",
                                         "Footprint opened",
                                         "Graft length",
                                         "Length over flexion",
                                         "Against the insertions",
                                         "Bend at the femur",
                                         "Bend at the tibia",
                                         "Roof",
                                         "Landmarks",
                                         "Opening"};
  for (const BoneKind kind : {BoneKind::Femur, BoneKind::Tibia})
    for (const tunnels::PlanCheck& one : review_->checks(kind)) {
      EXPECT_TRUE(!one.value || std::ranges::count(covered, one.name) == 1) << one.name;
      EXPECT_NE(one.verdict, tunnels::PlanCheck::Verdict::NotChecked) << one.name;
    }
}

INSTANTIATE_TEST_SUITE_P(BothSides, PanelNumbers, ::testing::Values(bones::Side::Right, bones::Side::Left));

}  // namespace
}  // namespace arthronaut::plan_review
