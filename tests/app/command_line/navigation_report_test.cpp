#include "app/command_line/navigation_report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace arthronaut::command_line {
namespace {

// A part of the offset is as long as it is, and goes the way that is named: "-0.06 mm anterior" was neither.
TEST(NavigationReport, NamesTheWayThatTheOffsetGoes) {
  theatre::NavigationSummary summary;
  guidance::GuidanceNumbers& numbers = summary.last_guidance;
  numbers.state = guidance::GuidanceState::Valid;
  numbers.across_plan.side_is = landmarks::AnatomicalDirection::Anterior;
  numbers.across_plan.up_is = landmarks::AnatomicalDirection::Proximal;
  numbers.offset_anterior_mm = -0.06;
  numbers.offset_proximal_mm = 1.2;
  testing::internal::CaptureStdout();
  say_navigation(Context{}, summary);
  EXPECT_THAT(testing::internal::GetCapturedStdout(),
              testing::HasSubstr("0.00 mm: 0.06 mm posterior, 1.20 mm proximal;"));
}

}  // namespace
}  // namespace arthronaut::command_line
