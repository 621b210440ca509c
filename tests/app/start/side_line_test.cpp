#include "app/start/side_line.h"

#include <gtest/gtest.h>

namespace arthronaut::start {
namespace {

using bones::Side;
using widgets::Severity;

importing::BoneImport import_of(bool guessed, bool seen, bool by_shape) {
  importing::BoneImport import;
  import.side = Side::Left;
  import.side_was_guessed = guessed;
  import.side_was_seen = seen;
  import.side_is_by_shape = by_shape;
  return import;
}

// Nothing but the fibula or a person makes the side sure; every doubt is a caution, says what the side is
// told by, and asks.
TEST(SideLineTest, WhatIsNotSureIsACautionThatAsks) {
  for (const auto& [import, by] : {std::pair{import_of(true, false, false), "name"},
                                   std::pair{import_of(false, true, true), "shape of the bones alone"}}) {
    const SideLine line = side_line(import, Side::Left, false);
    EXPECT_EQ(line.severity, Severity::Caution) << line.text;
    EXPECT_TRUE(line.text.starts_with("left")) << line.text;
    EXPECT_NE(line.text.find(by), std::string::npos) << line.text;
    EXPECT_NE(line.text.find("is that so?"), std::string::npos) << line.text;
  }
  EXPECT_EQ(side_line(import_of(false, false, false), std::nullopt, false).severity, Severity::Caution);
}

TEST(SideLineTest, AFibulaAndAPersonAreSure) {
  const SideLine fibula = side_line(import_of(false, true, false), Side::Left, false);
  EXPECT_EQ(fibula.severity, Severity::Good);
  EXPECT_EQ(fibula.text, "left, by the fibula");
  EXPECT_EQ(side_line(import_of(false, true, false), Side::Left, true).severity, Severity::Good);
  EXPECT_EQ(side_line(import_of(false, false, false), Side::Right, true).text, "right, as you say");
}

// What a person says counts, but not unsaid against the anatomy: a wrong side is a wrong operation.
TEST(SideLineTest, APersonAgainstTheAnatomyIsTold) {
  const SideLine fibula = side_line(import_of(false, true, false), Side::Right, true);
  EXPECT_EQ(fibula.severity, Severity::Bad);
  EXPECT_EQ(fibula.text, "right, as you say, but the fibula lies as in a left knee: look at the picture");
  const SideLine shape = side_line(import_of(false, true, true), Side::Right, true);
  EXPECT_EQ(shape.severity, Severity::Caution);
  EXPECT_NE(shape.text.find("shaped as in a left knee"), std::string::npos) << shape.text;
}

// How the images are marked is told where it is all there is, and against a person, the fibula or the shape.
TEST(SideLineTest, HowTheImagesAreMarkedIsTold) {
  importing::BoneImport import = import_of(true, false, false);
  import.side_is_by_images = true;
  import.side_in_images = Side::Left;
  EXPECT_EQ(side_line(import, Side::Left, false).text,
            "left, as the images are marked: is that so? Press R or L");
  EXPECT_EQ(side_line(import, Side::Left, false).severity, Severity::Caution);
  EXPECT_EQ(side_line(import, Side::Left, true).text, "left, as you say");
  const SideLine other = side_line(import, Side::Right, true);
  EXPECT_EQ(other.severity, Severity::Bad);
  EXPECT_EQ(other.text,
            "right, as you say, but the images are marked as those of a left knee: look at the picture");
  importing::BoneImport fibula = import_of(false, true, false);
  fibula.side_in_images = Side::Right;
  const SideLine seen = side_line(fibula, Side::Left, false);
  EXPECT_EQ(seen.severity, Severity::Bad);
  EXPECT_TRUE(seen.text.starts_with("left, by the fibula, but the images are marked")) << seen.text;
}

// Where a bone alone was looked at, which tells nothing by itself.
TEST(SideLineTest, APersonAgainstTheShapeOfABoneAloneIsTold) {
  importing::BoneImport import;
  import.bones.resize(1);
  import.bones[0].shape_was_judged = true;
  import.bones[0].side_by_shape = Side::Left;
  EXPECT_EQ(side_line(import, Side::Right, true).severity, Severity::Caution);
  EXPECT_EQ(side_line(import, Side::Left, true).severity, Severity::Good);
}

// Said before the bones were made, as of images of both knees, or told by a name.
TEST(SideLineTest, ASideThatTheBonesSpeakAgainstIsNotGood) {
  importing::BoneImport import = import_of(false, false, false);
  import.side_is_contradicted = true;
  EXPECT_EQ(side_line(import, Side::Left, true).severity, Severity::Bad);
  EXPECT_EQ(side_line(import, Side::Right, true).severity, Severity::Good);
  import.side_was_guessed = true;
  const SideLine named = side_line(import, Side::Left, false);
  EXPECT_EQ(named.severity, Severity::Bad);
  EXPECT_TRUE(named.text.starts_with("left, by the name of the source, but")) << named.text;
  import.side_is_by_segment = true;
  const SideLine of_segment = side_line(import, Side::Left, false);
  EXPECT_TRUE(of_segment.text.starts_with("left, by the name of a segment, but")) << of_segment.text;
}

}  // namespace
}  // namespace arthronaut::start
