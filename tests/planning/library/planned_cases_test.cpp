#include "planning/library/planned_cases.h"

#include <gtest/gtest.h>

#include "planning/cases/study.h"
#include "tests/planning/library/made_case.h"
#include "tests/temporary_folder.h"

namespace arthronaut::library {
namespace {

class PlannedCases : public ::testing::Test {
 protected:
  // Of Anna's CT of January, if nothing else is said.
  void make(const std::string& name, const test::MadeCase& made, const std::string& patient_id = "4711") {
    const std::filesystem::path folder = folder_ / name;
    test::make_case(folder, made);
    cases::save_identity(folder, {"Muster^Anna", patient_id, "19900131"});
    images::DicomOrigin origin;
    origin.study_uid = "1.2";
    origin.study_date = "20260131";
    origin.series_uid = "1.2.3";
    cases::save_studies(folder, {{bones::BoneKind::Femur, origin}});
    records_.push_back(read_case_record(folder, {}));
  }
  [[nodiscard]] std::vector<std::string> found(const TakenImages& images) const {
    std::vector<std::string> names;
    for (const PlannedCase& planned : planned_cases_of(records_, images)) names.push_back(planned.name);
    return names;
  }

  const test::TemporaryFolder folder_;
  std::vector<CaseRecord> records_;
  const TakenImages after_{{"MUSTER^ANNA", "4711", ""}, "20260301", "1.2.4"};
};

using Names = std::vector<std::string>;

TEST_F(PlannedCases, AreThoseOfThePatientThatHaveAPlanTheNewestFirst) {
  make("a.arthro", {.name = "Earlier", .created_utc = "2026-01-01T00:00:00Z"});
  make("b.arthro", {.name = "Later", .created_utc = "2026-02-01T00:00:00Z"});
  make("c.arthro", {.name = "Unplanned", .is_planned = false});
  make("d.arthro", {.name = "Somebody else's"}, "4712");
  EXPECT_EQ(found(after_), (Names{"Later", "Earlier"}));
  EXPECT_EQ(found({{"Muster^Anna", "", "19900131"}, "20260301", "1.2.4"}), Names{}) << "nobody's number";
}

// What the case was made of is not what its operation came to.
TEST_F(PlannedCases, AreNotOfTheImagesThatTheyWereMadeOf) {
  make("a.arthro", {.name = "Knee"});
  for (const auto& [date, series] : {std::pair{"20260131", "1.2.9"}, {"20251224", "1.2.9"}, {"", "1.2.3"}}) {
    TakenImages images = after_;
    images.study_date = date;
    images.series_uid = series;
    EXPECT_EQ(found(images), Names{}) << date << " " << series;
  }
  TakenImages undated = after_;
  undated.study_date = "";
  EXPECT_EQ(found(undated), Names{"Knee"});
}

}  // namespace
}  // namespace arthronaut::library
