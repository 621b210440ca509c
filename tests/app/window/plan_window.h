// Plan mode on the built-in knee, as a hand works it.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <utility>

#include "planning/cases/case.h"
#include "tests/app/window/built_in_case.h"
#include "tests/app/window/display.h"
#include "tests/temporary_folder.h"

namespace arthronaut::test {

class PlanWindow : public ::testing::Test {
 protected:
  void SetUp() override {
    if (const std::string missing = missing_for_window_tests(); !missing.empty()) GTEST_SKIP() << missing;
    put_built_in_case(case_folder());
  }
  [[nodiscard]] std::filesystem::path case_folder() const {
    return folder_.path() / "arthronaut" / "Phantom.arthro";
  }
  [[nodiscard]] tunnels::Tunnel saved_tunnel() const {
    return cases::load_case(case_folder()).plan.tunnels.at(bones::BoneKind::Femur);
  }
  static void open(const RunningWorkstation& app) {
    ASSERT_TRUE(app.wait_for_state("case", "open", 120));
    ASSERT_TRUE(app.wait_for_widget("plan.entry_handle"));
  }
  static std::pair<int, int> middle(const RunningWorkstation& app, const std::string& widget) {
    const Area area = app.widgets().at(widget);
    return {area.x + area.width / 2, area.y + area.height / 2};
  }
  const TemporaryFolder folder_;
};

}  // namespace arthronaut::test
