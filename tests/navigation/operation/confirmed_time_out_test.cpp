// What a time-out was confirmed of, and what makes it due again.
#include "navigation/operation/confirmed_time_out.h"

#include <gtest/gtest.h>

#include "tests/navigation/operation/phantom_operation.h"

namespace arthronaut::operation {
namespace {

TEST(ConfirmedTimeOut, HoldsForProvenanceAndPlanAlone) {
  const SourceSetup live = test::scripted_source();
  const SourceSetup recording = test::scripted_source(sources::SourceKind::Recording);
  const registration::Provenance now = provenance_of(test::phantom_setup(), live);
  const std::optional<PlannedTunnel> plan = test::phantom_plan();
  ConfirmedTimeOut time_out;
  EXPECT_EQ(time_out.standing(nullptr, now, plan), TimeOut::NotAsked);
  EXPECT_EQ(time_out.standing(&recording, now, plan), TimeOut::NotAsked);
  EXPECT_EQ(time_out.standing(&live, now, plan), TimeOut::Due);
  time_out.confirm(now, plan);
  EXPECT_EQ(time_out.standing(&live, now, plan), TimeOut::Confirmed);
  registration::Provenance other = now;
  other.refractive_index = 1.3345;
  EXPECT_EQ(time_out.standing(&live, other, plan), TimeOut::Due);
  other = now;
  ++other.placement;
  EXPECT_EQ(time_out.standing(&live, other, plan), TimeOut::Confirmed) << "the marker was not read out";
  std::optional<PlannedTunnel> edited = plan;
  edited->length_mm += 1;
  EXPECT_EQ(time_out.standing(&live, now, edited), TimeOut::Due);
  time_out.on_plan_taken_over(edited);
  EXPECT_EQ(time_out.standing(&live, now, edited), TimeOut::Confirmed);
}

// The registration depends on no guide, and the time-out does.
TEST(ConfirmedTimeOut, HoldsForGuideAndDrillsAlone) {
  SourceSetup source = test::scripted_source();
  const registration::Provenance now = provenance_of(test::phantom_setup(), source);
  ConfirmedTimeOut time_out;
  const auto standing_with = [&](const auto& change) {
    SourceSetup other = source;
    change(other.pipeline.tools.tools.back());
    time_out.on_source(other.pipeline);
    EXPECT_FALSE(registration::mismatch_of(now, provenance_of(test::phantom_setup(), other)));
    return time_out.standing(&other, now, std::nullopt);
  };
  time_out.on_source(source.pipeline);
  time_out.confirm(now, std::nullopt);
  EXPECT_EQ(standing_with([](tools::Tool&) {}), TimeOut::Confirmed);
  EXPECT_EQ(standing_with([](tools::Tool& guide) { guide.axis->point_mm.y() -= 20; }), TimeOut::Due);
  EXPECT_EQ(standing_with([](tools::Tool& guide) { guide.axis->direction = -guide.axis->direction; }),
            TimeOut::Due);
  EXPECT_EQ(standing_with([](tools::Tool& guide) { guide.size_mm += 1; }), TimeOut::Due);
  EXPECT_EQ(standing_with([](tools::Tool& guide) { guide.residual_mm = 0.3; }), TimeOut::Confirmed)
      << "it is the same guide";
  time_out.on_source(source.pipeline);
  EXPECT_EQ(time_out.standing(&source, now, std::nullopt), TimeOut::Confirmed);
}

}  // namespace
}  // namespace arthronaut::operation
