#include "planning/library/cohort.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <nlohmann/json.hpp>

#include "planning/files/atomic_file.h"
#include "tests/planning/library/made_case.h"
#include "tests/temporary_folder.h"

namespace arthronaut::library {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

std::vector<CaseRecord> two_cases() {
  std::vector<CaseRecord> records(2);
  records[0].name = "A";
  records[0].folder = "/cases/A.arthro";
  records[0].side = bones::Side::Left;
  records[0].planned = {bones::BoneKind::Femur};
  SessionFacts session;
  session.id = "0001";
  session.bone = bones::BoneKind::Femur;
  session.registration_is_reliable = true;
  session.predicted_error_mm = 0.4;
  session.entry_offset_mm = 1.25;
  session.angle_deg = 0.5;
  session.drilling_min = 3.5;
  records[0].sessions = {session, session};
  records[0].sessions[1].id = "0002";
  records[0].postoperative = {{.tunnel = bones::BoneKind::Tibia,
                               .entry_offset_mm = 2,
                               .angle_deg = 1,
                               .diameter_mm = 9,
                               .is_reliable = true},
                              {.tunnel = {bones::BoneKind::Femur, norms::Bundle::Posterolateral},
                               .entry_offset_mm = 3,
                               .angle_deg = 4,
                               .diameter_mm = 6,
                               .is_reliable = false,
                               .known = {tunnels::Quantity::Entry, tunnels::Quantity::Direction}}};
  records[1].name = "B";
  records[1].folder = "/cases/B.arthro";
  records[1].problem = "case.json: broken";
  return records;
}

// As RFC 4180 has it, by column; every row has as many cells as the header.
std::vector<std::map<std::string, std::string>> rows_of(const std::string& csv) {
  std::vector<std::vector<std::string>> lines(1, std::vector<std::string>(1));
  bool is_quoted = false;
  for (std::size_t i = 0; i < csv.size(); ++i) {
    const char c = csv[i];
    if (c == '"' && is_quoted && i + 1 < csv.size() && csv[i + 1] == '"')
      lines.back().back() += csv[++i];
    else if (c == '"')
      is_quoted = !is_quoted;
    else if (c == ',' && !is_quoted)
      lines.back().emplace_back();
    else if (c == '\n' && !is_quoted)
      lines.emplace_back(1);
    else
      lines.back().back() += c;
  }
  lines.pop_back();  // what follows the last line end
  std::vector<std::map<std::string, std::string>> rows;
  for (std::size_t line = 1; line < lines.size(); ++line) {
    EXPECT_EQ(lines[line].size(), lines[0].size()) << line;
    rows.emplace_back();
    for (std::size_t column = 0; column < lines[0].size(); ++column)
      rows.back()[lines[0][column]] = lines[line].at(column);
  }
  return rows;
}

// A row a session, one for a case without any.
TEST(CohortTest, IsARowASession) {
  auto rows = rows_of(cohort_csv(two_cases()));
  ASSERT_EQ(rows.size(), 3U);
  EXPECT_EQ(rows[0]["case"], "A");
  EXPECT_EQ(rows[0]["femur_planned"], "yes");
  EXPECT_EQ(rows[0]["tibia_planned"], "no");
  EXPECT_EQ(rows[1]["session"], "0002");
  EXPECT_EQ(rows[0]["outcome"], "drilled, 1.2 mm and 0.5\u00B0 from the plan");
  EXPECT_EQ(rows[0]["entry_offset_mm"], "1.250");
  EXPECT_EQ(rows[0]["predicted_tre_mm"], "0.400");
  EXPECT_EQ(rows[0]["drilling_min"], "3.500");
  EXPECT_EQ(rows[0]["registering_min"], "") << "not known is empty";
  EXPECT_EQ(rows[0]["registration_reliable"], "yes");
  EXPECT_EQ(rows[0]["tibia_postop_offset_mm"], "2.000");
  EXPECT_EQ(rows[0]["femur_postop_offset_mm"], "");
  EXPECT_EQ(rows[0]["femur_pl_postop_offset_mm"], "3.000");
  EXPECT_EQ(rows[0]["femur_pl_postop_reliable"], "no");
  EXPECT_EQ(rows[0]["femur_pl_postop_reliable_quantities"], "entry and direction");
  EXPECT_EQ(rows[0]["tibia_postop_reliable_quantities"], "entry, direction, diameter and length");
  EXPECT_EQ(rows[0]["femur_am_postop_offset_mm"], "");
  EXPECT_EQ(rows[2]["state"], "unreadable");
  EXPECT_EQ(rows[2]["session"], "");
  EXPECT_EQ(rows[2]["problem"], "case.json: broken");
  EXPECT_FALSE(rows[0].contains("patient_name"));
}

// What a spreadsheet would cut apart or run is quoted.
TEST(CohortTest, QuotesNotes) {
  std::vector<CaseRecord> records(1);
  records[0].name = "=1+1";
  records[0].note = "said \"no\",\nlater yes";
  auto rows = rows_of(cohort_csv(records));
  ASSERT_EQ(rows.size(), 1U);
  EXPECT_EQ(rows[0]["case"], "'=1+1");
  EXPECT_EQ(rows[0]["note"], "said \"no\",\nlater yes");
}

// Hazard 19: nobody is named unless the user asks for it.
TEST(CohortTest, Hazard19NamesThePatientOnlyWhenAsked) {
  const test::TemporaryFolder folder;
  test::make_case(folder / "A.arthro");
  cases::save_identity(folder / "A.arthro", {"Muster^Anna", "4711", "19900131"});
  std::vector<CaseRecord> records(2);
  records[0].name = records[1].name = "A";
  records[0].folder = folder / "A.arthro";
  records[1].folder = folder / "gone.arthro";
  records[1].is_there = false;
  EXPECT_THAT(cohort_csv(records), Not(HasSubstr("Muster")));
  write_cases_json(folder / "without.json", records);
  EXPECT_THAT(files::read_text(folder / "without.json"), Not(HasSubstr("4711")));
  const Identities named = read_identities(records);
  EXPECT_EQ(named.size(), 1U);
  EXPECT_THAT(cohort_csv(records, &named), HasSubstr("Muster^Anna,4711,19900131\n"));
  write_cases_json(folder / "with.json", records, &named);
  const auto document = nlohmann::json::parse(files::read_text(folder / "with.json"));
  EXPECT_EQ(document.at("cases").at(0).at("identity").at("patient_id"), "4711");
  EXPECT_FALSE(document.at("cases").at(1).contains("identity"));
}

}  // namespace
}  // namespace arthronaut::library
