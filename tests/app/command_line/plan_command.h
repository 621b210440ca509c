// plan and landmarks on the built-in knee, as a user types them.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "planning/cases/case.h"
#include "planning/phantom/phantom_case.h"
#include "planning/phantom/phantom_knee.h"
#include "tests/app/command_line/program.h"
#include "tests/temporary_folder.h"

namespace arthronaut {

inline const phantom::PhantomKnee& built_in_knee() {
  static const auto made = phantom::make_phantom_knee();
  return made;
}

class PlanCommand : public ::testing::Test {
 protected:
  PlanCommand() { save(knee_); }
  void save(const cases::Case& knee) const { cases::save_case(folder_ / "knee.arthro", knee); }
  // Of the tibial tunnel, as the command line takes it.
  [[nodiscard]] std::string entry_text() const {
    const Eigen::Vector3d& entry = knee_.plan.tunnels.at(bones::BoneKind::Tibia).entry_mm;
    return std::to_string(entry.x()) + "," + std::to_string(entry.y()) + "," + std::to_string(entry.z());
  }
  [[nodiscard]] test::ProgramResult run(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin() + 1, folder_ / "knee.arthro");
    return test::run_program(arguments);
  }

  const test::TemporaryFolder folder_;
  const phantom::PhantomKnee& made_ = built_in_knee();
  cases::Case knee_ = phantom::case_of(made_, "Phantom");
};

}  // namespace arthronaut
