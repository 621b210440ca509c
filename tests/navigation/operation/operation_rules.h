// The fixture of the rules: what follows from commands and frames.
#pragma once

#include <gtest/gtest.h>

#include "tests/navigation/operation/phantom_operation.h"

namespace arthronaut::test {

// An operation on the phantom whose live source shows the world marker.
class OperationRules : public ::testing::Test {
 protected:
  void SetUp() override {
    const operation::SourceSetup source = scripted_source();
    run_.start(source);
    run_.show(run_.frame());
  }
  void give() {
    run_.apply(true_registration(trial_, run_.operation().now()));
    ASSERT_EQ(run_.in_force().standing, operation::Standing::Stands);
  }
  [[nodiscard]] Eigen::Vector3d on_bone(double dx_mm, double lifted_mm = 0) const {
    return test::on_bone(trial_, dx_mm, lifted_mm);
  }
  experiments::Trial trial_ = registration::phantom_bone().trial(experiments::TrialNoise::Dry, 1);
  PhantomOperation run_;
};

}  // namespace arthronaut::test
