#include "app/command_line/navigation_report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace arthronaut::command_line {
namespace {

// A part of the offset is as long as it is, and goes the way that is named: "-0.06 mm anterior" was neither.
// Nor is there another offset beside it.
TEST(NavigationReport, NamesTheWayThatTheOffsetGoes) {
  theatre::NavigationSummary summary;
  guidance::GuidanceNumbers& numbers = summary.last_guidance;
  numbers.state = guidance::GuidanceState::Valid;
  numbers.across_plan.side_is = landmarks::AnatomicalDirection::Anterior;
  numbers.across_plan.up_is = landmarks::AnatomicalDirection::Proximal;
  numbers.axis_to_entry_mm = 1.17;
  numbers.offset_mm = 1.21;
  numbers.offset_anterior_mm = -0.06;
  numbers.offset_proximal_mm = 1.2;
  testing::internal::CaptureStdout();
  say_navigation(Context{}, summary);
  const std::string said = testing::internal::GetCapturedStdout();
  EXPECT_THAT(said, testing::HasSubstr("1.21 mm: 0.06 mm posterior, 1.20 mm proximal;"));
  EXPECT_THAT(said, testing::Not(testing::HasSubstr("1.17"))) << "the same, measured otherwise";
}

}  // namespace
}  // namespace arthronaut::command_line
