#include "planning/library/case_query.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "planning/geometry/error.h"

namespace arthronaut::library {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

class CaseQueryTest : public ::testing::Test {
 protected:
  CaseQueryTest() {
    records_.resize(4);
    set(0, "Bauer", bones::Side::Left, "2026-01-05", "2026-01-09");
    set(1, "adler", bones::Side::Right, "2026-01-07", "2026-01-08");
    set(2, "Ärmel", bones::Side::Right, "2026-01-01", "2026-01-10");
    set(3, "Cramer", bones::Side::Left, "2026-01-03", "2026-01-07");
    records_[0].planned = {bones::BoneKind::Femur};
    records_[1].note = "Revision, #study\nsecond line";
    records_[2].is_there = false;
    SessionFacts drilled;
    drilled.started_utc = "2025-12-24T10:00:00Z";
    drilled.source_kind = "live";
    drilled.entry_offset_mm = 2;
    records_[3].sessions = {drilled, SessionFacts{}};
    drilled.entry_offset_mm = 3;
    records_[1].sessions = {drilled};
  }
  void set(std::size_t i, const char* name, bones::Side side, const char* created, const char* changed) {
    records_[i].name = name;
    records_[i].side = side;
    records_[i].created_utc = std::string(created) + "T12:00:00Z";
    records_[i].changed_utc = std::string(changed) + "T12:00:00Z";
    records_[i].folder = std::string("/cases/") + std::to_string(i);
  }
  [[nodiscard]] std::vector<std::size_t> found(const CaseQuery& query) const {
    return find_cases(records_, query);
  }
  std::vector<CaseRecord> records_;
};

TEST_F(CaseQueryTest, OrdersAsAsked) {
  EXPECT_THAT(found({}), ElementsAre(2, 0, 1, 3));
  EXPECT_THAT(found({.order = CaseOrder::Name}), ElementsAre(1, 2, 0, 3))
      << "capital or not, with umlaut or without";
  EXPECT_THAT(found({.order = CaseOrder::Created}), ElementsAre(1, 0, 3, 2));
  EXPECT_THAT(found({.order = CaseOrder::EntryOffset}), ElementsAre(1, 3, 2, 0));
  EXPECT_THAT(found({.order = CaseOrder::State}), ElementsAre(2, 0, 1, 3)) << "missing, planned, drilled";
}

// Of a name typed with its accents or without them; as one letter each, or with accents of their own.
TEST_F(CaseQueryTest, FindsNamesByAKeyboardWithoutAccents) {
  records_[0].name = "Dvořák–Ærøskøbing";
  for (const char* words : {"dvorak", "DVOŘÁK", "dvor\u030Ca\u0301k", "aeroskobing", "Ærøskøbing", "k–æ"})
    EXPECT_THAT(found({.words = words}), ElementsAre(0)) << words;
  EXPECT_THAT(found({.words = "dvorek"}), IsEmpty());
}

TEST_F(CaseQueryTest, EveryWordMustStandSomewhere) {
  EXPECT_THAT(found({.words = "revision"}), ElementsAre(1));
  EXPECT_THAT(found({.words = "#STUDY right"}), ElementsAre(1));
  EXPECT_THAT(found({.words = "#study left"}), IsEmpty());
  EXPECT_THAT(found({.words = "ärmel"}), ElementsAre(2));
  EXPECT_THAT(found({.words = "ARMEL"}), ElementsAre(2)) << "by a keyboard without umlauts";
  EXPECT_THAT(found({.words = "2025-12"}), ElementsAre(1, 3)) << "dates of sessions";
  EXPECT_THAT(found({.words = "live drilled left"}), ElementsAre(3));
  EXPECT_THAT(found({.words = "  "}).size(), 4);
}

TEST_F(CaseQueryTest, FiltersBySideAndState) {
  EXPECT_THAT(found({.side = bones::Side::Left}), ElementsAre(0, 3));
  EXPECT_THAT(found({.state = CaseState::Missing}), ElementsAre(2));
  EXPECT_THAT(found({.side = bones::Side::Left, .state = CaseState::Drilled}), ElementsAre(3));
}

TEST_F(CaseQueryTest, WordsOfStatesAndOrdersComeBack) {
  for (int i = 0; i < 6; ++i)
    EXPECT_EQ(case_state_from_text(to_text(static_cast<CaseState>(i))), static_cast<CaseState>(i));
  for (int i = 0; i < 5; ++i)
    EXPECT_EQ(case_order_from_text(to_text(static_cast<CaseOrder>(i))), static_cast<CaseOrder>(i));
  EXPECT_THROW((void)case_state_from_text("lost"), InvalidInput);
  EXPECT_THROW((void)case_order_from_text("size"), InvalidInput);
}

// A surgeon looks for a patient. Only where the patients are known to who asks: in a list that names nobody a
// name finds nothing, or that it finds would tell whose case it is.
TEST_F(CaseQueryTest, FindsThePatientOnlyForWhoIsToldThePatients) {
  const Identities patients{{records_[1].folder, {"M\u00fcller^Anna", "4711", "19900131"}},
                            {records_[3].folder, {"Muster^Bernd", "0815", ""}}};
  for (const char* words : {"m\u00fcller", "M\u00dcLLER anna", "M\u00fcller, Anna", "4711", "1990-01-31",
                            "19900131", "m\u00fcller right"}) {
    CaseQuery query;
    query.words = words;
    EXPECT_THAT(find_cases(records_, query, &patients), ElementsAre(1U)) << words;
    EXPECT_THAT(find_cases(records_, query), IsEmpty()) << words;
  }
  CaseQuery query;
  query.words = "muster";
  EXPECT_THAT(find_cases(records_, query, &patients), ElementsAre(3U));
  query.words = "muster anna";
  EXPECT_THAT(find_cases(records_, query, &patients), IsEmpty());
}

}  // namespace
}  // namespace arthronaut::library
