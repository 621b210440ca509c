// Landmarks in plan mode, from outside.
#include <gtest/gtest.h>

#include <cmath>

#include "planning/geometry/surface.h"
#include "planning/landmarks/anatomical_axes.h"
#include "tests/app/window/plan_window.h"

namespace arthronaut::test {
namespace {

// Its page with the second landmark, whose handle is in sight.
class PlanLandmarks : public PlanWindow {
 protected:
  static void open_landmark(RunningWorkstation& app) {
    open(app);
    app.press("l");
    app.press("Next");
    ASSERT_TRUE(app.wait_for_state("landmark", "blumensaat_posterior"));
    ASSERT_TRUE(app.wait_for_widget("plan.blumensaat_posterior_handle"));
  }
};

// What a click would do is what is shown: a landmark that was being placed is not, once its page is left or
// the other bone is worked on, and a click that is meant for an entry moves no landmark.
TEST_F(PlanLandmarks, AClickForAnEntryMovesNoLandmark) {
  const VirtualDisplay display(1280, 720);
  RunningWorkstation app(display, folder_.path());
  open_landmark(app);
  app.press("p");
  ASSERT_TRUE(app.wait_for_state("placing", "landmark"));
  app.press("c");
  EXPECT_TRUE(app.wait_for_state("placing", "nothing", 5));
  app.press("p");
  ASSERT_TRUE(app.wait_for_state("placing", "entry", 5));
  const Area view = app.widgets().at("plan.view");
  app.click_at(view.x + view.width / 2, view.y + view.height / 4);  // the femur's shaft
  EXPECT_TRUE(app.wait_for_state("undo", "Place the entry of the femoral tunnel"));
  app.press("l");
  app.press("p");
  ASSERT_TRUE(app.wait_for_state("placing", "landmark"));
  app.press("Tab");
  EXPECT_TRUE(app.wait_for_state("tunnel", "tibia"));
  EXPECT_TRUE(app.wait_for_state("placing", "nothing", 5));
  EXPECT_EQ(app.state("landmark"), "plateau_anterior") << "the first of this bone's";
}

// On this page the arrows go through the list, which follows; they aimed the tunnel, which nothing there
// shows.
TEST_F(PlanLandmarks, TheArrowsGoThroughTheListAndMoveNoTunnel) {
  const VirtualDisplay display(1280, 720);
  RunningWorkstation app(display, folder_.path());
  open(app);
  app.press("l");
  ASSERT_TRUE(app.wait_for_state("landmark", "blumensaat_anterior"));
  app.press("Down");
  ASSERT_TRUE(app.wait_for_state("landmark", "blumensaat_posterior"));
  app.press("Up");
  ASSERT_TRUE(app.wait_for_state("landmark", "blumensaat_anterior"));
  app.press("Up");  // round: the last of the list
  ASSERT_TRUE(app.wait_for_state("landmark", "native_footprint"));
  EXPECT_TRUE(app.wait_for_widget("plan.landmark.native_footprint", 5)) << "scrolled to";
  for (const char* key : {"Left", "Right", "shift+Up", "equal", "Delete"}) app.press(key);
  app.press("c");
  ASSERT_TRUE(app.wait_for_state("landmark", ""));
  EXPECT_EQ(app.state("undo"), "") << "no tunnel was moved";
}

// What is meant by the landmark is drawn beside its words, of this knee's side, and over no handle.
TEST_F(PlanLandmarks, APictureShowsWhatIsMeant) {
  const VirtualDisplay display(1280, 720);
  RunningWorkstation app(display, folder_.path());
  open(app);
  EXPECT_FALSE(app.widgets().contains("plan.landmark_picture"));
  app.press("l");
  ASSERT_TRUE(app.wait_for_state("landmark_picture", "blumensaat_anterior, notch, right", 60));
  ASSERT_TRUE(app.wait_for_widget("plan.landmark_picture"));
  const Area picture = app.widgets().at("plan.landmark_picture"), view = app.widgets().at("plan.view");
  EXPECT_GE(picture.x, view.x + view.width) << "it would cover handles";
  EXPECT_LE(picture.x + picture.width, 1280);
  EXPECT_GT(picture.height, 100);
  for (const char* button : {"plan.landmark_confirm", "plan.landmark_place", "plan.roof"}) {
    ASSERT_TRUE(app.wait_for_widget(button)) << button;
    EXPECT_GE(app.widgets().at(button).y, picture.y + picture.height) << button;
  }
  app.press("Next");
  ASSERT_TRUE(app.wait_for_state("landmark_picture", "blumensaat_posterior, notch, right"));
  app.press("Tab");
  ASSERT_TRUE(app.wait_for_state("landmark_picture", "plateau_anterior, plateau, right"));
}

// A click places, also where a landmark lies that could be taken hold of.
TEST_F(PlanLandmarks, ALandmarkIsPlacedWhereOneLies) {
  const VirtualDisplay display(1280, 720);
  RunningWorkstation app(display, folder_.path());
  open_landmark(app);
  app.press("p");
  ASSERT_TRUE(app.wait_for_state("placing", "landmark"));
  const auto [x, y] = middle(app, "plan.blumensaat_posterior_handle");
  app.click_at(x, y);
  EXPECT_TRUE(app.wait_for_state("undo", "Place: Blumensaat's line, posterior end", 5));
  EXPECT_EQ(app.state("placing"), "nothing");
}

// A hand that clicks on a landmark to look at it trembles: that confirms nothing. One that presses beside it
// turns the view.
TEST_F(PlanLandmarks, AClickThatTremblesMovesNoLandmark) {
  const VirtualDisplay display(1280, 720);
  RunningWorkstation app(display, folder_.path());
  open_landmark(app);
  const auto [x, y] = middle(app, "plan.blumensaat_posterior_handle");
  app.drag(x, y, x + 1, y + 1);
  EXPECT_FALSE(app.wait_for_state("plan", "moving", 1));
  const int beside = x + static_cast<int>(0.7 * app.widgets().at("plan.blumensaat_posterior_handle").width);
  app.drag(beside, y, beside + 8, y);
  EXPECT_FALSE(app.wait_for_state("plan", "moving", 1));
  EXPECT_EQ(app.state("undo"), "");
  const auto [turned_x, turned_y] = middle(app, "plan.blumensaat_posterior_handle");
  app.drag(turned_x, turned_y, turned_x + 8, turned_y);
  EXPECT_TRUE(app.wait_for_state("undo", "Drag: Blumensaat's line, posterior end", 5));
}

// A place within the bone is clicked on and dragged through its surface.
TEST_F(PlanLandmarks, ALandmarkWithinTheBoneIsPlacedAndDraggedThere) {
  const VirtualDisplay display(1280, 720);
  RunningWorkstation app(display, folder_.path());
  open(app);
  app.press("l");
  const std::string name = "lateral_condyle_center";
  for (const char* next : {"blumensaat_posterior", "notch_apex", name.c_str()}) {
    app.press("Next");
    ASSERT_TRUE(app.wait_for_state("landmark", next));
  }
  app.press("4");
  ASSERT_TRUE(app.wait_for_state("view_direction", "lateral"));
  app.press("p");
  ASSERT_TRUE(app.wait_for_state("placing", "landmark"));
  const Area view = app.widgets().at("plan.view");
  app.click_at(view.x + view.width / 2, view.y + view.height * 2 / 5);
  ASSERT_TRUE(app.wait_for_state("undo", "Place: Lateral condyle, centre", 5)) << app.state("hint");
  ASSERT_TRUE(app.wait_for_state("plan", "saved"));
  const cases::Case placed = cases::load_case(case_folder());
  const geometry::Surface femur(placed.bones.at(bones::BoneKind::Femur).mesh);
  const Eigen::Vector3d at = placed.landmarks.at(bones::BoneKind::Femur).at(name);
  EXPECT_GT((femur.closest_point(at).point_mm - at).norm(), 4) << "no place on the surface";
  const auto [x, y] = middle(app, "plan." + name + "_handle");
  app.drag(x, y, x + 20, y);
  ASSERT_TRUE(app.wait_for_state("undo", "Drag: Lateral condyle, centre", 5));
  ASSERT_TRUE(app.wait_for_state("plan", "saved"));
  const Eigen::Vector3d moved =
      cases::load_case(case_folder()).landmarks.at(bones::BoneKind::Femur).at(name) - at;
  EXPECT_GT(moved.norm(), 2);
  EXPECT_LT(moved.norm(), 20);
  const auto axes = landmarks::anatomical_axes(bones::BoneKind::Femur, placed.side,
                                               placed.landmarks.at(bones::BoneKind::Femur),
                                               placed.bones.at(bones::BoneKind::Femur).mesh);
  EXPECT_LT(std::abs(moved.dot(axes.lateral)), 2) << "as deep as it was, seen from lateral";
}

}  // namespace
}  // namespace arthronaut::test
