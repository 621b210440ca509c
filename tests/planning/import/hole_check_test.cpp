#include "planning/import/hole_check.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "planning/bones/mesh_file.h"
#include "planning/files/atomic_file.h"
#include "planning/phantom/phantom_knee.h"
#include "planning/plan_export/drilled_bone.h"
#include "tests/temporary_folder.h"

namespace arthronaut::importing {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;
using testing::Not;

// A knee that was operated on before: its bones were taken without a word, and a tunnel planned through the
// old one was as long as if there were bone.
TEST(HoleCheck, ABoneThatWasDrilledThroughIsDoubted) {
  const auto phantom = phantom::make_phantom_knee({.edge_length_mm = 1.5});
  const test::TemporaryFolder folder;
  const auto doubts_of = [&](const geometry::TriangleMesh& mesh) {
    files::write_atomically(folder / "right_femur.stl", std::string_view(bones::mesh_as_stl("femur", mesh)));
    return import_bones(folder / "right_femur.stl").bones.at(0).doubts;
  };
  EXPECT_THAT(doubts_of(phantom.femur.mesh), Not(Contains(HasSubstr("a hole"))));
  const auto drilled = plan_export::drill(phantom.femur.mesh, phantom.femoral_tunnel);
  ASSERT_TRUE(drilled.is_usable()) << drilled.reason;
  EXPECT_THAT(doubts_of(drilled.mesh),
              Contains(AllOf(HasSubstr("a hole about "), HasSubstr("goes right through it"),
                             HasSubstr("an earlier operation"))));
}

}  // namespace
}  // namespace arthronaut::importing
