#include "planning/files/within_folder.h"

#include <gtest/gtest.h>

namespace arthronaut::files {

TEST(WithinFolder, LeavesOutTheFolderAlone) {
  EXPECT_EQ(within_folder("/data/Knee.arthro", "/data/Knee.arthro/sessions/0001/a.json: is broken"),
            "sessions/0001/a.json: is broken");
  EXPECT_EQ(within_folder("./", "./a.json: line 3. Then ./b.json"), "a.json: line 3. Then b.json");
  EXPECT_EQ(within_folder("Knee", "Knee.arthro/a.json: is broken"), "Knee.arthro/a.json: is broken");
}

// A record that has no folder yet: nothing is taken away.
TEST(WithinFolder, LeavesWordsAsTheyAreWithoutAFolder) {
  EXPECT_EQ(within_folder({}, "/knees/a.arthro/plan.json: broken"), "/knees/a.arthro/plan.json: broken");
}

}  // namespace arthronaut::files
