#include "app/start/side_line.h"

#include <gtest/gtest.h>

namespace arthronaut::start {
namespace {

using bones::Side;
using widgets::Severity;

using importing::SideSource;

importing::BoneImport import_of(SideSource source) {
  importing::BoneImport import;
  import.side = Side::Left;
  import.side_source = source;
  if (source == SideSource::Fibula) import.side_by_fibula = Side::Left;
  return import;
}

// Nothing but the fibula or a person makes the side sure; every doubt is a caution, says what the side is
// told by, and asks.
TEST(SideLineTest, WhatIsNotSureIsACautionThatAsks) {
  for (const auto& [source, by] : {std::pair{SideSource::SourceName, "name"},
                                   std::pair{SideSource::Shapes, "shape of the bones alone"}}) {
    const SideLine line = side_line(import_of(source), Side::Left, false);
    EXPECT_EQ(line.severity, Severity::Caution) << line.text;
    EXPECT_TRUE(line.text.starts_with("left")) << line.text;
    EXPECT_NE(line.text.find(by), std::string::npos) << line.text;
    EXPECT_NE(line.text.find("is that so?"), std::string::npos) << line.text;
  }
  EXPECT_EQ(side_line(import_of(SideSource::Person), std::nullopt, false).severity, Severity::Caution);
}

TEST(SideLineTest, AFibulaAndAPersonAreSure) {
  const SideLine fibula = side_line(import_of(SideSource::Fibula), Side::Left, false);
  EXPECT_EQ(fibula.severity, Severity::Good);
  EXPECT_EQ(fibula.text, "left, by the fibula");
  EXPECT_EQ(side_line(import_of(SideSource::Fibula), Side::Left, true).severity, Severity::Good);
  importing::BoneImport seen = import_of(SideSource::Person);
  seen.side_by_fibula = Side::Right;
  EXPECT_EQ(side_line(seen, Side::Right, true).text, "right, as you say");
  EXPECT_EQ(side_line(seen, Side::Right, true).severity, Severity::Good);
}

// No tick for a key that was pressed: it is chosen, and nothing that could be looked at says so.
TEST(SideLineTest, APersonAloneIsBelievedButHasNoTick) {
  for (const SideLine& line : {side_line(import_of(SideSource::None), Side::Right, true),
                               side_line(import_of(SideSource::SourceName), Side::Right, true),
                               side_line(import_of(SideSource::Person), Side::Right, false)}) {
    EXPECT_EQ(line.severity, Severity::Quiet) << line.text;
    EXPECT_TRUE(line.text.starts_with("right")) << line.text;
    EXPECT_NE(line.text.find("nothing in the images or the shape of the bones confirms it"),
              std::string::npos)
        << line.text;
  }
  EXPECT_FALSE(side_line(import_of(SideSource::None), Side::Right, true).needs_choice);
  EXPECT_EQ(side_line(import_of(SideSource::SourceName), Side::Left, true).severity, Severity::Good)
      << "the name had told it, too";
}

// A name that the fibula bears out is sure; and whoever then says the other side is told of the fibula.
TEST(SideLineTest, AFibulaStandsByAName) {
  importing::BoneImport import = import_of(SideSource::SourceName);
  import.side_by_fibula = Side::Left;
  EXPECT_EQ(side_line(import, Side::Left, false).text,
            "left, by the name of the source, and the fibula lies so");
  EXPECT_EQ(side_line(import, Side::Left, false).severity, Severity::Good);
  const SideLine other = side_line(import, Side::Right, true);
  EXPECT_EQ(other.severity, Severity::Bad);
  EXPECT_EQ(other.text, "right, as you say, but the fibula lies as in a left knee: look at the picture");
}

// What a person says counts, but not unsaid against the anatomy: a wrong side is a wrong operation.
TEST(SideLineTest, APersonAgainstTheAnatomyIsTold) {
  const SideLine fibula = side_line(import_of(SideSource::Fibula), Side::Right, true);
  EXPECT_EQ(fibula.severity, Severity::Bad);
  EXPECT_EQ(fibula.text, "right, as you say, but the fibula lies as in a left knee: look at the picture");
  const SideLine shape = side_line(import_of(SideSource::Shapes), Side::Right, true);
  EXPECT_EQ(shape.severity, Severity::Caution);
  EXPECT_NE(shape.text.find("shaped as in a left knee"), std::string::npos) << shape.text;
}

// How the images are marked is told where it is all there is, and against a person, the fibula or the shape.
TEST(SideLineTest, HowTheImagesAreMarkedIsTold) {
  importing::BoneImport import = import_of(SideSource::ImageMark);
  import.side_in_images = Side::Left;
  EXPECT_EQ(side_line(import, Side::Left, false).text,
            "left, as the images are marked: is that so? Press R or L");
  EXPECT_EQ(side_line(import, Side::Left, false).severity, Severity::Caution);
  EXPECT_EQ(side_line(import, Side::Left, true).text, "left, as you say");
  const SideLine other = side_line(import, Side::Right, true);
  EXPECT_EQ(other.severity, Severity::Bad);
  EXPECT_EQ(other.text,
            "right, as you say, but the images are marked as those of a left knee: look at the picture");
  importing::BoneImport fibula = import_of(SideSource::Fibula);
  fibula.side_in_images = Side::Right;
  const SideLine seen = side_line(fibula, Side::Left, false);
  EXPECT_EQ(seen.severity, Severity::Bad);
  EXPECT_TRUE(seen.text.starts_with("left, by the fibula, but the images are marked")) << seen.text;
}

// Enter alone must not pass what is doubted: a person chooses the side, and then it is chosen, whatever it
// is.
TEST(SideLineTest, Hazard52WhatIsNotSureNeedsSomebodysChoice) {
  importing::BoneImport against = import_of(SideSource::Fibula);
  against.side_in_images = Side::Right;
  for (const importing::BoneImport& import :
       {import_of(SideSource::SourceName), import_of(SideSource::ImageMark), import_of(SideSource::Shapes),
        against}) {
    const SideLine line = side_line(import, Side::Left, false);
    EXPECT_TRUE(line.needs_choice) << line.text;
    EXPECT_NE(line.text.find("ress R or L"), std::string::npos) << line.text;
    EXPECT_FALSE(side_line(import, Side::Left, true).needs_choice);
    EXPECT_FALSE(side_line(import, Side::Right, true).needs_choice);
  }
  EXPECT_FALSE(side_line(import_of(SideSource::Fibula), Side::Left, false).needs_choice);
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
  importing::BoneImport import = import_of(SideSource::Person);
  import.bones.resize(1);
  import.bones[0].shape_was_judged = true;
  import.bones[0].side_by_shape = Side::Right;
  EXPECT_EQ(side_line(import, Side::Left, true).severity, Severity::Bad);
  EXPECT_EQ(side_line(import, Side::Right, true).severity, Severity::Good);
  import.side_source = SideSource::SourceName;
  const SideLine named = side_line(import, Side::Left, false);
  EXPECT_EQ(named.severity, Severity::Bad);
  EXPECT_TRUE(named.text.starts_with("left, by the name of the source, but")) << named.text;
  import.side_source = SideSource::SegmentName;
  const SideLine of_segment = side_line(import, Side::Left, false);
  EXPECT_TRUE(of_segment.text.starts_with("left, by the name of a segment, but")) << of_segment.text;
}

}  // namespace
}  // namespace arthronaut::start
