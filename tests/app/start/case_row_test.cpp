// What the row of a case says in the list.
#include <gtest/gtest.h>

#include "app/start/case_list.h"

namespace arthronaut::start {
namespace {

// Two cases of one day differ by their patients, before anybody opens one; without one nothing stands for
// him.
TEST(CaseRow, NamesThePatientWhereHeIsKnown) {
  library::CaseRecord record;
  record.folder = "/data/Knee 1.arthro";
  EXPECT_EQ(whose_and_where(record, "", false), "/data/Knee 1.arthro");
  EXPECT_EQ(whose_and_where(record, "Muster, Anna", false), "Muster, Anna  \u2013  /data/Knee 1.arthro");
  record.note = "look again\n#study";
  EXPECT_EQ(whose_and_where(record, "Muster, Anna", true),
            "Found by its patient: Muster, Anna  \u2013  \u201Clook again\u201D");
}

}  // namespace
}  // namespace arthronaut::start
