#include "app/scene/plan_picture.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>

#include "planning/geometry/error.h"
#include "planning/phantom/phantom_case.h"

namespace arthronaut::scene {
namespace {

const cases::Case& knee() {
  static const cases::Case coarse =
      phantom::case_of(phantom::make_phantom_knee({.edge_length_mm = 2.5}), "test");
  return coarse;
}

PictureRequest request_of(ViewDirection view) {
  PictureRequest request;
  request.knee = &knee();
  request.view = view;
  request.width = 320;
  request.height = 240;
  return request;
}

// Pixels whose colour leans the way `is_it` asks.
template <typename Predicate>
double share_of(const Image& image, const Predicate& is_it) {
  int count = 0;
  for (std::size_t i = 0; i < image.rgb.size(); i += 3)
    count += is_it(image.rgb[i], image.rgb[i + 1], image.rgb[i + 2]) ? 1 : 0;
  return 3.0 * count / static_cast<double>(image.rgb.size());
}
bool is_bone(int r, int g, int b) { return r > 70 && r > b + 12 && g > b; }
bool is_plan(int r, int g, int b) { return b > r + 40 && b > 110 && g > r; }
bool is_achieved(int r, int, int b) { return r > 120 && r > b + 90; }

class PlanPicture : public ::testing::Test {
 protected:
  // The pictures must come without a display, wherever the tests run.
  void SetUp() override { unsetenv("DISPLAY"); }
};

// Every view shows bone and a planned tunnel, and no two views look alike.
TEST_F(PlanPicture, EveryViewShowsBoneAndPlan) {
  std::vector<Image> pictures;
  for (const ViewDirection view :
       {ViewDirection::Anterior, ViewDirection::Posterior, ViewDirection::Medial, ViewDirection::Lateral,
        ViewDirection::Distal, ViewDirection::Notch, ViewDirection::Plateau}) {
    pictures.push_back(render_plan_picture(request_of(view)));
    const Image& image = pictures.back();
    ASSERT_EQ(image.rgb.size(), 3U * 320 * 240);
    EXPECT_GT(share_of(image, is_bone), 0.2) << to_text(view) << ": what matters is small";
    EXPECT_LT(share_of(image, is_bone), 0.90) << to_text(view);
    EXPECT_GT(share_of(image, is_plan), 0.001) << to_text(view);
  }
  for (std::size_t i = 0; i < pictures.size(); ++i)
    for (std::size_t k = i + 1; k < pictures.size(); ++k) EXPECT_NE(pictures[i].rgb, pictures[k].rgb);
}

// The same request gives the same pixels.
TEST_F(PlanPicture, IsDeterministic) {
  EXPECT_EQ(render_plan_picture(request_of(ViewDirection::Notch)).rgb,
            render_plan_picture(request_of(ViewDirection::Notch)).rgb);
}

// A tunnel as drilled is drawn in a colour of its own.
TEST_F(PlanPicture, AchievedTunnelIsSeen) {
  PictureRequest request = request_of(ViewDirection::Anterior);
  const double before = share_of(render_plan_picture(request), is_achieved);
  request.achieved = {knee().plan.tunnels.at(bones::BoneKind::Femur)};
  request.achieved.front().entry_mm += Eigen::Vector3d(0, -4, 4);
  EXPECT_GT(share_of(render_plan_picture(request), is_achieved), before + 0.001);
}

// Bad requests are refused with a reason.
TEST_F(PlanPicture, RefusesWhatItCannotDraw) {
  PictureRequest request = request_of(ViewDirection::Anterior);
  request.width = 4;
  EXPECT_THROW((void)render_plan_picture(request), InvalidInput);
  cases::Case empty;
  request = request_of(ViewDirection::Anterior);
  request.knee = &empty;
  EXPECT_THROW((void)render_plan_picture(request), InvalidInput);
}

}  // namespace
}  // namespace arthronaut::scene
