// Plan mode on the built-in knee, as a hand works it.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <utility>

#include "planning/cases/case.h"
#include "planning/painting/bone_labels.h"
#include "planning/phantom/phantom_case.h"
#include "planning/phantom/phantom_knee.h"
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
  // The phantom with a CT of it, in which the bones are as bright as bone.
  static void write_knee_with_ct(const std::filesystem::path& folder) {
    cases::Case knee = phantom::case_of(phantom::make_phantom_knee({.edge_length_mm = 4}), "imaged");
    images::Volume volume;
    volume.size = {110, 110, 140};
    volume.modality_in_file = "CT";
    volume.lps_from_index.linear() *= 1.5;
    volume.lps_from_index.translation() = -0.75 * volume.size.cast<double>();
    painting::Labels labels(static_cast<std::size_t>(volume.size.prod()), painting::kNothing);
    for (const auto& [kind, bone] : knee.bones)
      painting::add_bone(labels, volume, bone.mesh, painting::kFemur);
    for (const std::uint8_t label : labels)
      volume.values.push_back(label == painting::kNothing ? 40.F : 900.F);
    cases::save_case(folder, knee);
    knee.images.push_back({.file = "",
                           .modality = volume.modality_in_file,
                           .source = "NRRD",
                           .size = volume.size,
                           .spacing_mm = volume.spacing_mm()});
    cases::store_image(folder, 1, images::encoded(volume), knee.images.back());
    cases::save_case(folder, knee);
  }
  const TemporaryFolder folder_;
};

}  // namespace arthronaut::test
