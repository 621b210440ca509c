// Real femora, drilled and scanned: the own one is found and its tunnel told, another person's is refused.
#include <gtest/gtest.h>

#include "planning/bones/mesh_file.h"
#include "planning/bones/mesh_repair.h"
#include "planning/default_plan/default_plan.h"
#include "planning/postop/comparison.h"
#include "tests/planning/postop/postop_ct.h"
#include "tests/real_data/real_data.h"

namespace arthronaut {
namespace {

struct Planned {
  bones::Bone bone;
  tunnels::Tunnel plan;
};

Planned planned_on(const std::filesystem::path& file) {
  Planned planned{{bones::BoneKind::Femur, bones::mend_mesh(bones::read_mesh(file)).mesh, file.filename()},
                  {}};
  const geometry::Surface surface(planned.bone.mesh);
  default_plan::BoneInput input;
  input.bone = &planned.bone;
  input.surface = &surface;
  planned.plan = default_plan::plan_bone(input, bones::Side::Right).tunnel;
  return planned;
}

TEST(RealPostop, TheOwnFemurIsFoundAndAnotherPersonsIsRefused) {
  ARTHRONAUT_REQUIRE_DATA(folder, "bones/mri-femora");
  const Planned own = planned_on(folder / "1_RIGHT_femur_Nov_02_2021.vtk"),
                other = planned_on(folder / "3_RIGHT_femur_Nov_02_2021.vtk");
  test::Drilled how;
  how.tunnel = test::moved_tunnel(own.plan, geometry::Surface(own.bone.mesh), {2, -3}, {5, 4});
  const auto volume = test::postop_ct({own.bone.mesh}, {how}, test::lying(40, {1, 2, -1}, {50, -30, 20}));
  const postop::PostopImages images(volume);
  const auto found = images.compare(own.bone.mesh, own.plan);
  EXPECT_TRUE(found.tunnel.reliable) << testing::PrintToString(found.tunnel.reasons);
  // A third of the 0.5 mm and the 1 degree that are asked for.
  EXPECT_LT((found.tunnel.tunnel.entry_mm - how.tunnel.entry_mm).norm(), 0.17);
  EXPECT_LT(geometry::deg_from_rad(
                geometry::angle_between_rad(found.tunnel.tunnel.direction, how.tunnel.direction)),
            0.35);
  EXPECT_NEAR(found.tunnel.tunnel.diameter_mm, how.tunnel.diameter_mm, 0.2);
  const auto refused = images.compare(other.bone.mesh, other.plan);
  EXPECT_FALSE(refused.bone.reliable);
  EXPECT_FALSE(refused.tunnel.reliable);
}

}  // namespace
}  // namespace arthronaut
