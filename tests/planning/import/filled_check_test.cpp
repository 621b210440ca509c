#include "planning/import/filled_check.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "planning/bones/mesh_file.h"
#include "planning/files/atomic_file.h"
#include "planning/import/bone_import.h"
#include "planning/import/import_side.h"
#include "planning/phantom/phantom_knee.h"
#include "tests/temporary_folder.h"

namespace arthronaut::importing {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;
using testing::Not;

const phantom::PhantomKnee& knee() {
  static const phantom::PhantomKnee made = phantom::make_phantom_knee({.edge_length_mm = 1.5});
  return made;
}

template <typename IsCut>
std::vector<std::string> doubts_without(const std::string& name, geometry::TriangleMesh mesh,
                                        const IsCut& is_cut) {
  std::erase_if(mesh.triangles, [&](const auto& t) {
    return std::ranges::any_of(
        t, [&](std::int32_t v) { return is_cut(mesh.vertices_mm[static_cast<std::size_t>(v)]); });
  });
  const test::TemporaryFolder folder;
  const std::string stl = bones::mesh_as_stl("bone", mesh);
  files::write_atomically(folder / name, std::string_view(stl));
  const BoneImport import = import_bones(folder / name);
  return cases::words_of(doubts_with(import, import.bones.at(0), import.side));
}

// The wall of the notch about the planned entry was cut away and filled with what no scanner saw: without a
// word, and the plan on it was called reliable.
TEST(FilledCheck, AHoleAboutTheEntryIsDoubted) {
  const Eigen::Vector3d entry_mm = knee().femoral_tunnel.entry_mm;
  const auto without = [&](double radius_mm) {
    return doubts_without("right_femur.stl", knee().femur.mesh,
                          [&](const Eigen::Vector3d& p) { return (p - entry_mm).norm() < radius_mm; });
  };
  for (const double radius_mm : {6.0, 12.0})
    EXPECT_THAT(without(radius_mm), Contains(AllOf(HasSubstr("a hole of its surface"), HasSubstr("filled in"),
                                                   HasSubstr("no entry on it"))))
        << radius_mm;
  // Of a hole of 2 mm across, plus the triangles of 1.5 mm about it.
  EXPECT_THAT(without(1), Not(Contains(HasSubstr("filled in"))));
}

// A surface that is open where the scan ends, through the shaft; at the joint's end of the bone it is a hole.
TEST(FilledCheck, TheOpenEndOfAShaftIsNoHole) {
  const auto cut = [](const std::string& name, const geometry::TriangleMesh& mesh, double above_mm,
                      double below_mm) {
    const geometry::Bounds bounds = geometry::bounds_of(mesh);
    return doubts_without(name, mesh, [&](const Eigen::Vector3d& p) {
      return p.z() > bounds.max_mm.z() - above_mm || p.z() < bounds.min_mm.z() + below_mm;
    });
  };
  const auto& femur = knee().femur.mesh;
  const auto& tibia = knee().tibia.mesh;
  EXPECT_THAT(cut("right_femur.stl", femur, 3, -1), Not(Contains(HasSubstr("filled in"))));
  EXPECT_THAT(cut("right_tibia.stl", tibia, -1, 3), Not(Contains(HasSubstr("filled in"))));
  EXPECT_THAT(cut("right_femur.stl", femur, -1, 3), Contains(HasSubstr("filled in")));
  EXPECT_THAT(cut("right_tibia.stl", tibia, 6, -1), Contains(HasSubstr("filled in")));
}

}  // namespace
}  // namespace arthronaut::importing
