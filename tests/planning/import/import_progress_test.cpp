#include "planning/import/import_progress.h"

#include <gtest/gtest.h>

#include <vector>

namespace arthronaut::importing {
namespace {

using Stage = ImportStage;

// One bar for all stages of a CT and of a label map: none begins before the one before it has ended.
TEST(ImportProgress, NoStageBeginsBeforeTheOneBeforeItHasEnded) {
  for (const auto& stages : {std::vector{Stage::Starting, Stage::Reading, Stage::FindingBones,
                                         Stage::MendingMesh, Stage::LookingAtBones},
                             std::vector{Stage::Starting, Stage::Reading, Stage::ReadingImages,
                                         Stage::MakingSurface, Stage::MendingMesh, Stage::LookingAtBones}}) {
    double before = 0;
    for (const Stage stage : stages)
      for (const double fraction : {-1.0, 0.5, 1.0}) {
        const double share = share_of_all({stage, fraction});
        EXPECT_GE(share, before) << in_words(stage);
        before = share;
      }
    EXPECT_GT(before, 0.9);
    EXPECT_LE(before, 1);
  }
}

}  // namespace
}  // namespace arthronaut::importing
