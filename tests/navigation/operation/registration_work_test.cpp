#include "navigation/operation/registration_work.h"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>

#include "navigation/theatre/registration_service.h"
#include "tests/navigation/operation/phantom_operation.h"

namespace arthronaut::operation {
namespace {

using registration::phantom_bone;

// Strokes, one excluded and taken back in, one taken back, all judged and fitted.
std::vector<RegistrationRequest> requests() {
  const experiments::Trial trial = phantom_bone().trial(experiments::TrialNoise::Dry, 2);
  std::vector<RegistrationRequest> requests;
  for (std::size_t i = 0; i < 500; ++i) {
    requests.emplace_back(DrawnPoint{trial.curves[i]});
    if (i == 300) requests.emplace_back(StrokeExclusion{0, true});
    if (i == 350) requests.emplace_back(StrokeExclusion{0, false});
  }
  requests.emplace_back(JudgeAll{});
  requests.emplace_back(
      FitAll{1, std::make_shared<const strokes::Curves>(trial.curves.begin(), trial.curves.begin() + 400)});
  requests.emplace_back(StrokesTakenBack{1});
  return requests;
}

void expect_same(const RegistrationOutcome& a, const RegistrationOutcome& b) {
  EXPECT_EQ(a.fit_number, b.fit_number);
  EXPECT_EQ(a.failure, b.failure);
  ASSERT_EQ(a.online == nullptr, b.online == nullptr);
  EXPECT_EQ(a.online->revision, b.online->revision);
  EXPECT_EQ(a.online->state, b.online->state);
  EXPECT_EQ(a.online->registration.marker_from_bone.translation_mm,
            b.online->registration.marker_from_bone.translation_mm);
  EXPECT_EQ(a.online->registration.covariance, b.online->registration.covariance);
  ASSERT_TRUE(a.fit != nullptr && b.fit != nullptr);
  EXPECT_EQ(a.fit->marker_from_bone.translation_mm, b.fit->marker_from_bone.translation_mm);
  EXPECT_EQ(a.fit->marker_from_bone.rotation.coeffs(), b.fit->marker_from_bone.rotation.coeffs());
}

// What comes out depends on the order of the requests alone: one by one, all at once, and on a thread of its
// own that publishes when it likes.
TEST(RegistrationWork, TheSameOrderGivesTheSameWhateverTheBatches) {
  const RegistrationWorkOptions options = work_options(test::phantom_setup());
  const auto bone = [] { return phantom_bone().prepared; };
  const std::vector<RegistrationRequest> all = requests();

  const auto one_by_one = theatre::registration_at_once(bone, options);
  for (const RegistrationRequest& request : all) one_by_one->post({request});
  const auto as_a_whole = theatre::registration_at_once(bone, options);
  as_a_whole->post(all);
  const auto beside = theatre::registration_beside(bone, options, [] {});
  for (std::size_t i = 0; i < all.size(); i += 37)
    beside->post({all.begin() + static_cast<std::ptrdiff_t>(i),
                  all.begin() + static_cast<std::ptrdiff_t>(std::min(i + 37, all.size()))});
  const std::uint64_t wanted = one_by_one->latest()->request_count;
  for (int i = 0; i < 6000 && (!beside->latest() || beside->latest()->request_count < wanted); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));

  ASSERT_TRUE(beside->latest());
  EXPECT_EQ(beside->latest()->request_count, wanted);
  expect_same(*one_by_one->latest(), *as_a_whole->latest());
  expect_same(*one_by_one->latest(), *beside->latest());
}

// Aimed at another place before the first stroke it finds what one finds that was made for that place, and
// aimed after them the next fit is judged there.
TEST(RegistrationWork, IsJudgedWhereItIsAimedAt) {
  const auto bone = [] { return phantom_bone().prepared; };
  const RegistrationWorkOptions wanted = work_options(test::phantom_setup());
  RegistrationWorkOptions other = wanted;
  other.online.target_in_bone_mm = other.fit.target_in_bone_mm =
      *wanted.fit.target_in_bone_mm + Eigen::Vector3d(25, 0, 0);
  other.online.direction_in_bone = Eigen::Vector3d::UnitX();
  const AimAt aim{wanted.online.target_in_bone_mm, wanted.online.direction_in_bone};
  const auto run = [&](const RegistrationWorkOptions& options, bool aims_first, bool aims_last) {
    RegistrationWork work(bone, options);
    if (aims_first) work.work_in(aim);
    for (const RegistrationRequest& request : requests()) {
      if (aims_last && std::holds_alternative<JudgeAll>(request)) work.work_in(aim);
      work.work_in(request);
    }
    return work.outcome();
  };
  const OutcomePtr made_for_it = run(wanted, false, false), made_for_other = run(other, false, false);
  const double there_mm = made_for_it->fit->predicted_tre_mm;
  ASSERT_NE(there_mm, made_for_other->fit->predicted_tre_mm);
  const OutcomePtr first = run(other, true, false), last = run(other, false, true);
  expect_same(*first, *made_for_it);
  EXPECT_EQ(first->online->registration.predicted_tre_mm, made_for_it->online->registration.predicted_tre_mm);
  EXPECT_EQ(first->online->predicted_angle_deg, made_for_it->online->predicted_angle_deg);
  EXPECT_EQ(first->fit->predicted_tre_mm, there_mm);
  EXPECT_EQ(last->fit->predicted_tre_mm, there_mm);
}

// A bone that cannot be made ready is an outcome like any other, beside the frames too.
TEST(RegistrationWork, AFailureBesideTheFramesIsTold) {
  const auto beside = theatre::registration_beside(
      []() -> SurfaceIndexPtr { throw std::runtime_error("no mesh"); }, {}, [] {});
  for (int i = 0; i < 1000 && !beside->latest(); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  ASSERT_TRUE(beside->latest());
  EXPECT_EQ(beside->latest()->failure, "no mesh");
  EXPECT_FALSE(beside->latest()->bone_is_ready);
}

}  // namespace
}  // namespace arthronaut::operation
