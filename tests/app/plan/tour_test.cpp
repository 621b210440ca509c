#include "app/plan/tour.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <fstream>

#include "planning/files/atomic_file.h"
#include "tests/temporary_folder.h"

namespace arthronaut::plan {
namespace {

using bones::BoneKind;

tunnels::Tunnel tunnel_at(double x_mm) {
  tunnels::Tunnel tunnel;
  tunnel.entry_mm = {x_mm, 0, 0};
  tunnel.direction = Eigen::Vector3d::UnitZ();
  return tunnel;
}

class TourTest : public ::testing::Test {
 protected:
  TourTest() {
    facts_.tunnels = {{BoneKind::Femur, tunnel_at(0)}, {BoneKind::Tibia, tunnel_at(50)}};
    facts_.checks_shown = BoneKind::Femur;
  }
  [[nodiscard]] Tour open() const {
    Tour tour(file_);
    tour.case_opened(true);
    return tour;
  }
  // A frame or two without a change, so that a step that goes on by itself is seen.
  TourStep follow(Tour& tour) const {
    for (int i = 0; i < 3; ++i) tour.follow(facts_);
    return tour.step();
  }
  const test::TemporaryFolder folder_;
  const std::filesystem::path file_ = folder_ / "data" / "tour.json";
  TourFacts facts_;
};

// Every step waits until it is so; small tremors and another bone's state are not it.
TEST_F(TourTest, GoesOnWhenThingsAreSo) {
  Tour tour = open();
  EXPECT_TRUE(tour.is_offered());
  EXPECT_EQ(tour.card()->number, 0);
  tour.begin();
  EXPECT_EQ(follow(tour), TourStep::Look);
  facts_.view_direction = Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitZ()) * Eigen::Vector3d::UnitY();
  EXPECT_EQ(follow(tour), TourStep::Look) << "6 degrees are no turn";
  facts_.view_direction = Eigen::Vector3d::UnitX();
  EXPECT_EQ(follow(tour), TourStep::Landmarks);

  facts_.checks_shown.reset();
  facts_.landmarks_shown = BoneKind::Femur;
  facts_.unconfirmed = {BoneKind::Femur};
  EXPECT_EQ(follow(tour), TourStep::Landmarks) << "proposals are to be confirmed";
  facts_.unconfirmed.clear();
  EXPECT_EQ(follow(tour), TourStep::DefaultPlan);

  EXPECT_TRUE(tour.wants_defaults());
  EXPECT_EQ(follow(tour), TourStep::DefaultPlan) << "no default is known";
  facts_.defaults = {{BoneKind::Femur, tunnel_at(3)}, {BoneKind::Tibia, tunnel_at(50)}};
  EXPECT_EQ(follow(tour), TourStep::DefaultPlan);
  facts_.tunnels = facts_.defaults;
  EXPECT_EQ(follow(tour), TourStep::Move);
  EXPECT_FALSE(tour.wants_defaults());

  facts_.tunnels[BoneKind::Femur] = tunnel_at(3.2);
  EXPECT_EQ(follow(tour), TourStep::Move) << "0.2 mm are a tremor";
  facts_.tunnels[BoneKind::Femur] = tunnel_at(4);
  facts_.is_saved = false;
  EXPECT_EQ(follow(tour), TourStep::Move) << "the hand has not come to rest";
  facts_.is_saved = true;
  EXPECT_EQ(follow(tour), TourStep::Checks);

  facts_.landmarks_shown.reset();
  facts_.checks_shown = BoneKind::Femur;
  EXPECT_EQ(follow(tour), TourStep::Checks);
  facts_.checks_shown = BoneKind::Tibia;
  facts_.wrong = {BoneKind::Femur};
  EXPECT_EQ(follow(tour), TourStep::Checks) << "what is wrong is to be mended";
  facts_.wrong.clear();
  EXPECT_EQ(follow(tour), TourStep::TakeBack);

  facts_.can_redo = true;
  EXPECT_EQ(follow(tour), TourStep::Keep);
  facts_.kept_versions = 1;
  EXPECT_EQ(follow(tour), TourStep::Theatre);
  EXPECT_TRUE(tour.is_running());
  EXPECT_EQ(tour.card()->number, kTourStepCount);
  tour.plan_mode_left();
  EXPECT_FALSE(tour.card().has_value());
  EXPECT_FALSE(open().card().has_value()) << "done stays done";
}

// What was on the screen when a step began counts although it is gone with the next frame.
TEST_F(TourTest, ChecksThatWereOnTheScreenAreSeen) {
  std::filesystem::create_directories(file_.parent_path());
  std::ofstream(file_)
      << R"({"format": "arthronaut.tour", "version": 1, "state": "running", "step": "move"})";
  Tour tour = open();
  tour.follow(facts_);
  facts_.tunnels[BoneKind::Femur] = tunnel_at(4);
  tour.follow(facts_);
  EXPECT_EQ(tour.step(), TourStep::Checks);
  facts_.checks_shown = BoneKind::Tibia;
  tour.follow(facts_);
  EXPECT_EQ(tour.step(), TourStep::TakeBack);
}

TEST_F(TourTest, IsLeftAndTakenUpWhereItWas) {
  {
    Tour tour = open();
    tour.begin();
    follow(tour);
    facts_.view_direction = Eigen::Vector3d::UnitX();
    EXPECT_EQ(follow(tour), TourStep::Landmarks);
    tour.leave();
    EXPECT_FALSE(tour.card().has_value());
  }
  Tour tour = open();
  EXPECT_FALSE(tour.card().has_value()) << "not offered again";
  tour.begin();
  EXPECT_EQ(tour.step(), TourStep::Landmarks);
  Tour cut_off = open();  // a program that ended without leaving it
  EXPECT_TRUE(cut_off.is_running());
  EXPECT_EQ(cut_off.step(), TourStep::Landmarks);
}

TEST_F(TourTest, BeginsAnewAfterItsEnd) {
  std::filesystem::create_directories(file_.parent_path());
  std::ofstream(file_)
      << R"({"format": "arthronaut.tour", "version": 1, "state": "done", "step": "theatre"})";
  Tour tour = open();
  EXPECT_FALSE(tour.card().has_value());
  tour.begin();
  EXPECT_EQ(tour.step(), TourStep::Look);
}

// On a patient's knee nothing is offered, and what runs waits.
TEST_F(TourTest, IsOfTheBuiltInKneeAlone) {
  Tour tour(file_);
  EXPECT_FALSE(tour.card().has_value());
  tour.case_opened(false);
  EXPECT_FALSE(tour.card().has_value());
  tour.case_opened(true);
  tour.begin();
  follow(tour);
  tour.case_opened(false);
  facts_.view_direction = Eigen::Vector3d::UnitX();
  EXPECT_EQ(follow(tour), TourStep::Look);
  EXPECT_FALSE(tour.is_possible());
}

// It is a convenience: a broken file offers nothing, one that cannot be written stops nothing.
TEST_F(TourTest, ABrokenFileIsNoHarm) {
  std::filesystem::create_directories(file_.parent_path());
  std::ofstream(file_) << "{ broken";
  Tour tour = open();
  EXPECT_FALSE(tour.card().has_value());
  tour.begin();
  EXPECT_NE(files::read_text(file_).find("running"), std::string::npos);
  Tour nowhere("/proc/nowhere/tour.json");
  nowhere.case_opened(true);
  nowhere.begin();
  EXPECT_TRUE(nowhere.is_running());
}

}  // namespace
}  // namespace arthronaut::plan
