#include "app/window/whose_knee.h"

#include <gtest/gtest.h>

namespace arthronaut::window {
namespace {

std::string kept_of(const std::vector<WhoseLine>& lines) {
  std::string all;
  for (const WhoseLine& line : lines) all += line.rest + "\n";
  return all;
}

// Two patients of one name are told apart by it: what is too long is cut elsewhere.
TEST(WhoseKnee, NeitherBirthDateNorSideIsCutShort) {
  const auto lines =
      whose_knee(cases::Identity{"Muster-Beispielhausen^Anna Maria", "471100812345", "19900131"},
                 "Knee 2026-11-24, second opinion", bones::Side::Left);
  ASSERT_EQ(lines.size(), 3U);
  EXPECT_EQ(lines[0].may_be_cut, "Muster-Beispielhausen, Anna Maria");
  EXPECT_EQ(lines[1].may_be_cut, "471100812345");
  const std::string kept = kept_of(lines);
  EXPECT_NE(kept.find("1990-01-31"), std::string::npos) << kept;
  EXPECT_NE(kept.find("left knee"), std::string::npos) << kept;
}

// The number, or the time, by which two cases of a day are told apart is not what is cut.
TEST(WhoseKnee, WhatTellsTwoOfADayApartIsNotCut) {
  EXPECT_EQ(line_of_case("Knee 2026-11-24 14:05:31").rest, "11-24 14:05:31");
  EXPECT_EQ(line_of_case("Knee 2026-11-24 14:05:31").may_be_cut, "Knee 2026-");
  EXPECT_EQ(line_of_case("Knee 2026-11-24 14.05:31").rest, " 14.05:31");
  EXPECT_EQ(line_of_case("Knee").may_be_cut, "Knee");
  EXPECT_EQ(line_of_case("A Donaudampfschifffahrt").may_be_cut, "A Donaudampfschifffahrt");
  const auto lines =
      whose_knee(cases::Identity{"Muster^Anna", "4711", "19900131"}, "Knee 2026-11-24 2", bones::Side::Left);
  EXPECT_EQ(lines.back().may_be_cut + "|" + lines.back().rest, "Knee 2026-11-24| 2  \u2013  left knee");
}

TEST(WhoseKnee, OnlyWhatIsKnownHasALine) {
  const auto alone = whose_knee(std::nullopt, "Knee 2026-11-24 2", bones::Side::Right);
  ASSERT_EQ(alone.size(), 2U);
  EXPECT_EQ(alone[0].may_be_cut + "|" + alone[0].rest, "Knee 2026-11-24| 2");
  EXPECT_EQ(alone[1].may_be_cut + "|" + alone[1].rest, "|right knee");
  const auto lines = whose_knee(cases::Identity{"", "", "19900131"}, "Knee", bones::Side::Right);
  ASSERT_EQ(lines.size(), 3U);
  EXPECT_EQ(lines[0].may_be_cut, "");
  EXPECT_EQ(lines[0].rest, "1990-01-31");
  const auto pseudonym = whose_knee(cases::Identity{"STS_028", "STS_028", ""}, "Knee", bones::Side::Left);
  ASSERT_EQ(pseudonym.size(), 3U) << "name and side each have a line's room";
  EXPECT_EQ(pseudonym[0].may_be_cut, "STS_028");
  EXPECT_EQ(pseudonym[1].may_be_cut, "Knee");
  EXPECT_EQ(pseudonym[2].rest, "left knee");
}

}  // namespace
}  // namespace arthronaut::window
