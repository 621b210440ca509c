// A case whose plan is edited.
#pragma once

#include <gtest/gtest.h>

#include "app/case/plan_history.h"
#include "planning/phantom/phantom_case.h"
#include "tests/temporary_folder.h"

namespace arthronaut::open_case {

class PlanHistoryTest : public ::testing::Test {
 protected:
  PlanHistoryTest() : model_(saved_and_loaded()) { history_.open(&model_, folder_); }
  // As the workstation gets it.
  cases::Case saved_and_loaded() {
    cases::save_case(folder_, knee());
    return cases::load_case(folder_);
  }
  static cases::Case knee() {
    return phantom::case_of(phantom::make_phantom_knee({.edge_length_mm = 4}), "test");
  }
  [[nodiscard]] PlanEdit wider(double by_mm, bool continues) const {
    tunnels::Tunnel tunnel = *model_.tunnel(bones::BoneKind::Femur);
    tunnel.diameter_mm += by_mm;
    return {bones::BoneKind::Femur, tunnel, "Change the diameter of the femoral tunnel", continues};
  }
  [[nodiscard]] double saved_diameter_mm() const {
    return cases::load_case(folder_).plan.tunnels.at(bones::BoneKind::Femur).diameter_mm;
  }

  const test::TemporaryFolder temporary_;
  const std::filesystem::path& folder_ = temporary_.path();
  PlanModel model_;
  PlanHistory history_;
  const double start_mm_ = model_.tunnel(bones::BoneKind::Femur)->diameter_mm;
};

}  // namespace arthronaut::open_case
