// The numbers of a drilled tunnel, as a session keeps them, against those of today.
#include "navigation/recording/event_comparison.h"

#include <gtest/gtest.h>

#include <set>

#include "tests/navigation/recording/recorded_frames.h"
#include "tests/temporary_folder.h"

namespace arthronaut::recording {
namespace {

class AchievedComparison : public ::testing::Test {
 protected:
  void SetUp() override {
    SessionRecorder recorder(folder_.path(), test::session_header(), test::scripted_options());
    recorder.append(test::frame_result(0));
    recorder.finish();
    now_.measured.entry_mm = {1, 2, 3};
    now_.depth_mm = 30;
    keep(now_);
  }
  void keep(const operation::AchievedTunnel& then) const { operation::write_achieved_file(file_, then); }
  // What differs, once the tunnel is said to be drilled, or that and what follows.
  [[nodiscard]] std::set<std::string> differing(bool is_taken_back_now = false) const {
    std::vector<operation::JournalEntry> journal(1);
    journal[0].kind = operation::JournalKind::Drilled;
    journal[0].achieved = now_;
    if (is_taken_back_now) {
      journal.push_back(journal[0]);
      journal[1].kind = operation::JournalKind::DrilledTakenBack;
    }
    ReplaySummary summary;
    compare_achieved(RecordedSession(folder_.path()), journal, 1e-3, 1e-3, summary);
    std::set<std::string> whats;
    for (const Difference& difference : summary.differences) whats.insert(difference.what);
    return whats;
  }

  const test::TemporaryFolder folder_;
  const std::filesystem::path file_ = folder_ / "achieved.json";
  operation::AchievedTunnel now_;
};

TEST_F(AchievedComparison, TellsNothingOfTheSameWithinTheLimits) {
  EXPECT_EQ(differing(), std::set<std::string>{});
  operation::AchievedTunnel then = now_;
  then.measured.entry_mm.x() += 5e-4;
  keep(then);
  EXPECT_EQ(differing(), std::set<std::string>{});
}

// Only that a tunnel was drilled was compared, and none of its numbers.
TEST_F(AchievedComparison, TellsEveryNumberThatDiffers) {
  operation::AchievedTunnel then = now_;
  then.measured.entry_mm.x() += 0.01;
  then.measured.direction = Eigen::Vector3d(0.001, 0, 1).normalized();
  then.measured.diameter_mm += 0.01;
  then.planned.entry_mm.y() += 0.01;
  then.planned.diameter_mm += 0.01;
  then.sigma_offset_mm += 0.01;
  then.sigma_angle_deg += 0.01;
  *then.depth_mm += 0.01;
  keep(then);
  EXPECT_EQ(differing(),
            (std::set<std::string>{"drilled entry", "drilled direction", "drilled diameter",
                                   "drilled planned entry", "drilled planned diameter",
                                   "drilled sigma of offset", "drilled sigma of angle", "drilled depth"}));
}

TEST_F(AchievedComparison, TellsWhatIsNotThereOrStandsOtherwise) {
  operation::AchievedTunnel then = now_;
  then.depth_mm.reset();
  keep(then);
  EXPECT_EQ(differing(), std::set<std::string>{"drilled"});
  then = now_;
  then.is_taken_back = true;
  keep(then);
  EXPECT_EQ(differing(), std::set<std::string>{"drilled"});
  EXPECT_EQ(differing(true), std::set<std::string>{});
  std::filesystem::remove(file_);
  EXPECT_EQ(differing(), std::set<std::string>{"drilled"});
}

}  // namespace
}  // namespace arthronaut::recording
