#include "planning/cases/bone_doubts.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "planning/files/atomic_file.h"
#include "planning/geometry/error.h"
#include "tests/message_of.h"
#include "tests/temporary_folder.h"

namespace arthronaut::cases {
namespace {

using bones::BoneKind;
using ::testing::AllOf;
using ::testing::HasSubstr;

TEST(BoneDoubts, ComeBackAndWithoutAnyTheFileGoes) {
  const test::TemporaryFolder folder;
  EXPECT_TRUE(load_bone_doubts(folder.path()).empty());
  const BoneDoubts doubts{{BoneKind::Femur, {"12 cm2 are missing", "no \"condyles\""}},
                          {BoneKind::Tibia, {"too short"}}};
  save_bone_doubts(folder.path(), doubts);
  EXPECT_EQ(load_bone_doubts(folder.path()), doubts);
  save_bone_doubts(folder.path(), {{BoneKind::Femur, {}}});
  EXPECT_TRUE(folder.names().empty());
}

TEST(BoneDoubts, AFileThatIsNoneIsRefusedByPlace) {
  const test::TemporaryFolder folder;
  files::write_atomically(
      bone_doubts_file(folder.path()),
      R"({"format": "arthronaut.bone_doubts", "version": 1, "bones": [{"kind": "fibula"}]})");
  EXPECT_THAT(test::message_of<InvalidInput>([&] { (void)load_bone_doubts(folder.path()); }),
              AllOf(HasSubstr("bone_doubts.json: bones[0].kind"), HasSubstr("femur or tibia")));
}

}  // namespace
}  // namespace arthronaut::cases
