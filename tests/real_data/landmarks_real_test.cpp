// Proposed landmarks of real bones against those that were picked by eye, and how far they and the default
// entry move with how the bone lies and what of it is there.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <fstream>
#include <nlohmann/json.hpp>

#include "planning/bones/mesh_file.h"
#include "planning/bones/mesh_repair.h"
#include "planning/geometry/rigid_transform.h"
#include "tests/planning/default_plan/same_point.h"
#include "tests/real_data/real_data.h"

namespace arthronaut::default_plan {
namespace {

using Eigen::Vector3d;

struct HandPicked {
  bones::BoneKind kind = bones::BoneKind::Femur;
  std::string file;
  Vector3d lateral, anterior, superior;  // of the view that was picked in; axes of the file
  struct Point {
    Vector3d at_mm;
    std::string compare;
  };
  std::map<std::string, Point> points;
};

Vector3d vector_of(const nlohmann::json& node) {
  return Vector3d(node.at(0).get<double>(), node.at(1).get<double>(), node.at(2).get<double>());
}

std::vector<HandPicked> hand_picked() {
  std::ifstream file(ARTHRONAUT_HAND_LANDMARKS);
  const auto root = nlohmann::json::parse(file);
  std::vector<HandPicked> all;
  for (const auto& node : root.at("bones")) {
    HandPicked bone{bones::bone_kind_from_text(node.at("bone").get<std::string>()),
                    node.at("file").get<std::string>(),
                    vector_of(node.at("lateral")),
                    vector_of(node.at("anterior")),
                    vector_of(node.at("superior")),
                    {}};
    for (const auto& [name, point] : node.at("points").items())
      bone.points[name] = {vector_of(point.at("at_mm")), point.at("compare").get<std::string>()};
    all.push_back(bone);
  }
  return all;
}

geometry::TriangleMesh read_bone(const std::filesystem::path& folder, const std::string& file) {
  bones::MeshFileOptions options{.space = bones::Space::LPS, .unit = {}};
  if (file.starts_with("lenhart")) options.unit = bones::LengthUnit::Metre;
  return bones::mend_mesh(bones::read_mesh(folder / file, options)).mesh;
}

// 3 mm is what a point picked by hand is worth, 4 degrees a line.
TEST(RealLandmarks, LieWhereAHandPicksThem) {
  ARTHRONAUT_REQUIRE_DATA(folder, "bones");
  constexpr double kPoint_mm = 3.0, kLine_deg = 4.0;
  for (const HandPicked& bone : hand_picked()) {
    SCOPED_TRACE(bone.file);
    const auto proposal = landmarks::propose(read_bone(folder, bone.file), bone.kind);
    ASSERT_TRUE(proposal.is_usable()) << proposal.reason;
    for (const auto& [name, point] : bone.points) {
      ASSERT_TRUE(proposal.landmarks.contains(name)) << name;
      const Vector3d off = proposal.landmarks.at(name) - point.at_mm;
      double squares = 0;
      if (point.compare.find('l') != std::string::npos) squares += std::pow(off.dot(bone.lateral), 2);
      if (point.compare.find('a') != std::string::npos) squares += std::pow(off.dot(bone.anterior), 2);
      if (point.compare.find('s') != std::string::npos) squares += std::pow(off.dot(bone.superior), 2);
      EXPECT_LT(std::sqrt(squares), kPoint_mm) << name;
    }
    if (bone.kind == bones::BoneKind::Tibia) continue;
    const auto in_view = [&](const Vector3d& from, const Vector3d& to) {
      return Vector3d((to - from) - (to - from).dot(bone.lateral) * bone.lateral).normalized();
    };
    const Vector3d by_hand = in_view(bone.points.at("blumensaat_posterior").at_mm,
                                     bone.points.at("blumensaat_anterior").at_mm),
                   proposed = in_view(proposal.landmarks.at("blumensaat_posterior"),
                                      proposal.landmarks.at("blumensaat_anterior"));
    EXPECT_LT(std::atan2(by_hand.cross(proposed).norm(), by_hand.dot(proposed)),
              geometry::rad_from_deg(kLine_deg));
    EXPECT_GT(proposal.axes.lateral.dot(bone.lateral), std::cos(geometry::rad_from_deg(3)));
  }
}

class RealSamePoint : public ::testing::TestWithParam<const char*> {};

TEST_P(RealSamePoint, HoweverTheBoneLiesAndWhateverOfItIsThere) {
  ARTHRONAUT_REQUIRE_DATA(folder, "bones");
  const std::string file = GetParam();
  const auto kind = file.find("tibia") == std::string::npos ? bones::BoneKind::Femur : bones::BoneKind::Tibia;
  const test::Spread spread = test::spread_of(read_bone(folder, file), kind, 11);
  test::expect_same_point(spread);
  constexpr double kSame_mm = 0.5;
  EXPECT_LT(test::Spread::worst(spread.landmarks_mm), kSame_mm);
}

INSTANTIATE_TEST_SUITE_P(Bones, RealSamePoint,
                         ::testing::Values("lenhart2015/lenhart2015-R-femur-bone.stl",
                                           "mri-femora/1_RIGHT_femur_Nov_02_2021.vtk",
                                           "mri-femora/3_RIGHT_femur_Nov_02_2021.vtk",
                                           "mri-femora/femur_mesh_10k_pts.vtk",
                                           "lenhart2015/lenhart2015-R-tibia-bone.stl",
                                           "mri-femora/tibia_smoothed_image_10k_pts_thick_regions.vtk"));

}  // namespace
}  // namespace arthronaut::default_plan
