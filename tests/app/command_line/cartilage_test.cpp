// --cartilage of register and navigate, and what a case keeps of it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "planning/bones/mesh_file.h"
#include "planning/files/atomic_file.h"
#include "tests/app/command_line/marker_clip.h"
#include "tests/navigation/registration/phantom_bone.h"
#include "tests/temporary_folder.h"

namespace arthronaut {
namespace {

using test::run_program;
using ::testing::HasSubstr;

// The vertices of a part of the bone, with triangles enough to make a file of them.
geometry::TriangleMesh surface_through(const std::vector<Eigen::Vector3d>& points_mm) {
  geometry::TriangleMesh mesh;
  mesh.vertices_mm = points_mm;
  for (int i = 0; i + 2 < static_cast<int>(points_mm.size()); i += 3)
    mesh.triangles.push_back({i, i + 1, i + 2});
  return mesh;
}

}  // namespace

// Strokes that ride on 2 mm of cartilage: told of it, register is sure and says the thickness, in words and
// in the file; not told, it is not sure.
TEST(CartilageOption, RegisterSolvesTheThicknessAndSaysSo) {
  const test::TemporaryFolder folder;
  const registration::PhantomBone& bone = registration::phantom_bone();
  const auto covered = registration::cartilage_trial(bone, bone.trial(experiments::TrialNoise::Dry, 2), 2);
  bones::write_mesh_ply(folder / "femur.ply", bone.mesh);
  bones::write_mesh_ply(folder / "cartilage.ply", surface_through(covered.region.points_mm));
  strokes::write_curves_file(folder / "curves.csv", covered.trial.curves);
  std::vector<std::string> arguments{"register",
                                     "--bone",
                                     folder / "femur.ply",
                                     "--curves",
                                     folder / "curves.csv",
                                     "-o",
                                     folder / "registration.json"};
  EXPECT_EQ(run_program(arguments).exit_code, 4);

  arguments.insert(arguments.end(), {"--cartilage", folder / "cartilage.ply"});
  const auto told = run_program(arguments);
  EXPECT_EQ(told.exit_code, 0) << told.errors;
  EXPECT_THAT(told.output, HasSubstr("the cartilage lies 2.0 mm off the mesh"));
  EXPECT_THAT(files::read_text(folder / "registration.json"),
              HasSubstr("the cartilage lies 2.0 mm off the mesh"));

  arguments.back() = folder / "curves.csv";
  const auto wrong = run_program(arguments);
  EXPECT_EQ(wrong.exit_code, 3);
  EXPECT_THAT(wrong.errors, HasSubstr("curves.csv"));
}

// navigate takes it into the case, where the next run finds it; a patch smaller than any bone is no reason to
// refuse it, and a file that is no mesh leaves nothing behind.
TEST(CartilageOption, NavigateKeepsItInTheCase) {
  const test::TemporaryFolder folder;
  test::write_marker_clip(folder);
  const std::string knee = folder / "knee.arthro";
  ASSERT_EQ(run_program({"phantom", "-o", knee}).exit_code, 0);
  bones::write_mesh_ply(folder / "patch.ply", surface_through({{0, 0, 0}, {9, 0, 0}, {0, 9, 0}}));
  const std::vector<std::string> plain{"navigate",    knee,
                                       "--video",     folder / "clip.mkv",
                                       "--camera",    folder / "camera.json",
                                       "--tools",     folder / "tools.json",
                                       "--medium",    "air",
                                       "--fixed-lens"};
  auto arguments = plain;
  arguments.insert(arguments.end(), {"--cartilage", folder / "camera.json"});
  EXPECT_EQ(run_program(arguments).exit_code, 3);
  EXPECT_FALSE(std::filesystem::exists(knee + "/femur_cartilage.ply"));
  arguments.back() = folder / "patch.ply";
  EXPECT_THAT(run_program(arguments).output, HasSubstr("cartilage: given"));
  const auto kept = bones::read_mesh(knee + "/femur_cartilage.ply",
                                     {.space = bones::Space::LPS, .unit = bones::LengthUnit::Millimetre});
  EXPECT_EQ(kept.vertices_mm.size(), 3u);
  EXPECT_THAT(run_program(plain).output, HasSubstr("cartilage: of the case"));
}

}  // namespace arthronaut
