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

}  // namespace
}  // namespace arthronaut::operation
