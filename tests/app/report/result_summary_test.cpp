#include "app/report/result_summary.h"

#include <gtest/gtest.h>

#include "navigation/operation/achieved_tunnel.h"
#include "planning/postop/achieved_file.h"
#include "tests/app/report/reported_case.h"

namespace arthronaut::report {
namespace {

class ResultSummary : public Report {
 protected:
  // In the bone, across the planned axis.
  [[nodiscard]] tunnels::Tunnel beside_the_plan(double by_mm) const {
    tunnels::Tunnel tunnel = plan();
    tunnel.entry_mm += by_mm * tunnel.direction.unitOrthogonal();
    return tunnel;
  }
  [[nodiscard]] const tunnels::Tunnel& plan() const { return knee_.plan.tunnels.at(bones::BoneKind::Femur); }
  void navigate(const std::string& source_kind, double off_mm) const {
    (void)text_of_session(source_kind, {});
    operation::write_achieved_file(cases::session_folders(knee_folder()).back() / "achieved.json",
                                   {.planned = plan(),
                                    .measured = beside_the_plan(off_mm),
                                    .depth_mm = 30,
                                    .pose_count = 42,
                                    .truth = {}});
  }
  void image(double off_mm, bool is_reliable) const {
    std::map<tunnels::TunnelKey, postop::Comparison> comparisons;
    postop::Comparison& comparison = comparisons[plan().key()];
    comparison.bone = {.is_found = true,
                       .plan_from_postop = {},
                       .rms_mm = 0.2,
                       .on_edge_share = 0.9,
                       .in_view_share = 1,
                       .reliable = true,
                       .reasons = {}};
    comparison.tunnel.is_found = true;
    comparison.tunnel.reliable = is_reliable;
    comparison.tunnel.reasons.clear();
    if (!is_reliable) comparison.tunnel.reasons = {"metal hides most of the wall"};
    comparison.tunnel.tunnel = beside_the_plan(off_mm);
    comparison.tunnel.offset_mm = std::abs(off_mm);
    comparison.tunnel.length_mm = 27;
    postop::write_achieved_file(knee_folder() / "achieved.json", comparisons);
  }
};

// Of a case that is planned and no more there is no result.
TEST_F(ResultSummary, IsNotThereBeforeTheOperation) {
  write(pdf());
  EXPECT_EQ(pdf_text().find("CT against navigation"), std::string::npos);
}

// 1.2 mm to the one side and 1.8 mm to the other are 3 mm between the two: what neither says by itself.
TEST_F(ResultSummary, SetsNavigationAndCtAgainstEachOther) {
  navigate("live", 1.2);
  image(-1.8, true);
  const Content content = gather(knee_folder(), {});
  const std::vector<TunnelResult> results = results_of(content);
  ASSERT_FALSE(results.empty());
  ASSERT_TRUE(results.front().navigated_to_imaged);
  EXPECT_NEAR(results.front().navigated_to_imaged->entry_mm, 3.0, 1e-6);
  EXPECT_NEAR(results.front().navigated_to_imaged->angle_deg, 0, 1e-6);
  write(pdf());
  const std::string text = pdf_text();
  const std::string first_page = text.substr(0, text.find('\f'));
  for (const char* const part : {"1.2 mm, 0.0\u00B0", "1.8 mm, 0.0\u00B0", "3.0 mm, 0.0\u00B0"})
    expect_contains(first_page, part);
  EXPECT_EQ(first_page.find("SIMULATION"), std::string::npos);
  const auto json_file = pdf().parent_path() / "report.json";
  write(json_file);
  const auto json = nlohmann::json::parse(files::read_text(json_file));
  const auto& off = json.at("postoperative").at(0).at("off_navigation");
  EXPECT_NEAR(off.at("entry_mm").get<double>(), 3.0, 1e-6) << "the same number for other programs";
}

TEST_F(ResultSummary, ADoubtedCtSaysNothingAboutTheNavigation) {
  navigate("live", 1.2);
  image(-1.8, false);
  EXPECT_FALSE(results_of(gather(knee_folder(), {})).front().navigated_to_imaged);
  write(pdf());
  expect_contains(pdf_text(), "1.8 mm, 0.0\u00B0; not");
}

// Against a plan on a surface that the bone has no more, no planned number stands beside the CT's: it would
// be measured on another bone.
TEST_F(ResultSummary, OfAnotherSurfaceTheCtIsOfAnEarlierPlan) {
  image(-1.8, true);
  write(pdf());
  expect_contains(pdf_text(), "; planned");
  cases::Case other = cases::load_case(knee_folder());
  other.bones.at(bones::BoneKind::Femur).mesh.vertices_mm.front().x() += 0.01;
  cases::save_case(knee_folder(), other);
  write(pdf());
  const std::string text = pdf_text();
  expect_contains(text, "of an earlier plan");
  EXPECT_EQ(text.find("; planned"), std::string::npos) << text;
}

TEST_F(ResultSummary, SaysFirstThatItWasASimulation) {
  navigate("simulation", 1.2);
  write(pdf());
  const std::string text = pdf_text();
  expect_contains(text.substr(0, text.find('\f')), "SIMULATION: nobody's knee");
  expect_contains(text, "not drilled in this session");  // the tibia
}

}  // namespace
}  // namespace arthronaut::report
