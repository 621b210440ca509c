// A whole operation on a live source whose tools an outside tracker sees: it guides by the tracker's poses
// and by no others, stops in the picture in which they are too old, and runs again from its record to the
// last bit.
#include <gtest/gtest.h>

#include <atomic>
#include <random>
#include <thread>

#include "navigation/openigtlink/igtl_tracker.h"
#include "navigation/recording/replay.h"
#include "navigation/sources/capture_time.h"
#include "navigation/theatre/operation_run.h"
#include "planning/geometry/error.h"
#include "tests/navigation/openigtlink/tracker_peer.h"
#include "tests/temporary_folder.h"

namespace arthronaut::openigtlink {
namespace {

using geometry::RigidTransform;
using theatre::OperationRun;

constexpr int kWidth = 160, kHeight = 120, kFemur = 0;
constexpr int kFramesCompared = 20;

// Pictures of noise, 60 a second, as a camera that sees no marker.
class NoiseSource : public sources::FrameSource {
 public:
  NoiseSource() {
    info_.name = "noise";
    info_.image_size_px = {kWidth, kHeight};
    info_.frames_per_second = 60;
    info_.kind = sources::SourceKind::Live;
  }
  [[nodiscard]] const sources::SourceInfo& info() const override { return info_; }
  [[nodiscard]] camera::FramePtr next() override {
    std::this_thread::sleep_for(std::chrono::microseconds(16'667));
    const auto frame = std::make_shared<camera::Frame>();
    frame->index = next_++;
    frame->width = kWidth;
    frame->height = kHeight;
    frame->captured_ns = frame->received_ns = frame->decoded_ns = sources::steady_now_ns();
    if (first_ns_ == 0) first_ns_ = frame->captured_ns;
    frame->timestamp_ns = frame->captured_ns - first_ns_;
    frame->bgr.resize(3 * kWidth * kHeight);
    for (auto& value : frame->bgr) value = static_cast<std::uint8_t>(100 + random_() % 64);
    return frame;
  }

 private:
  sources::SourceInfo info_;
  std::mt19937 random_{5};
  std::int64_t next_ = 0, first_ns_ = 0;
};

class NothingToRegister : public theatre::RegistrationService {
  void post(std::vector<operation::RegistrationRequest>) override {}
  [[nodiscard]] operation::OutcomePtr latest() const override { return nullptr; }
};

operation::PlannedTunnel a_plan() {
  operation::PlannedTunnel plan;
  plan.tunnel.entry_mm = {8, -5, 2};
  plan.tunnel.direction = {0, -1, 0};
  plan.length_mm = 30;
  return plan;
}

operation::SourceSetup a_setup() {
  operation::SourceSetup setup;
  setup.kind = sources::SourceKind::Live;
  camera::Calibration& camera = setup.pipeline.calibration;
  camera.image_size_px = {kWidth, kHeight};
  camera.focal_px = 100;
  camera.principal_point_px = camera.rotation_center_px = {80, 60};
  camera.boundary = {{80, 60}, 55};
  setup.pipeline.tools = tools::standard_tools();
  for (tools::Tool& tool : setup.pipeline.tools.tools) tool.provenance.origin = provenance::Origin::Measured;
  setup.pipeline.tools.tools[0].marker_id = 9;  // bodies are not in the order of their ids
  setup.pipeline.tools.tracker = tools::OutsideTracker{"", 0.2, 0.1};
  setup.draws = false;
  return setup;
}

// The guide's point a little off the entry, along the plan; the tracker is carried about.
constexpr double kOff_mm = 1.25;
RigidTransform world_from_guide(const tools::ToolAxis& axis) {
  const Eigen::Vector3d at_mm = a_plan().tunnel.entry_mm + Eigen::Vector3d(kOff_mm, 0, 0);
  const Eigen::Quaterniond turn =
      Eigen::Quaterniond::FromTwoVectors(axis.direction, a_plan().tunnel.direction);
  return {turn, at_mm - turn * axis.point_mm};
}
RigidTransform tracker_from_world(double time_s) {
  return {Eigen::Quaterniond(
              Eigen::AngleAxisd(0.5 + 0.1 * std::sin(time_s), Eigen::Vector3d(1, 2, 3).normalized())),
          {100 + 20 * std::sin(0.7 * time_s), -50, 900}};
}

// Sends on a thread of its own while it may.
class SendingPeer {
 public:
  explicit SendingPeer(const tools::ToolSet& tools) : axis_(*tools.find_tool("femoral guide")->axis) {}
  [[nodiscard]] std::string address() const { return peer_.address(); }
  void pause(bool on) { is_paused_ = on; }

 private:
  void send() {
    const double now_s = test::utc_s();
    const RigidTransform world = tracker_from_world(now_s);
    // Its clock is an hour slow.
    (void)(peer_.send(test::transform_message("WorldFemur", world, now_s - 3600)) &&
           peer_.send(test::transform_message("Guide", world * world_from_guide(axis_), now_s - 3600)));
  }
  const tools::ToolAxis axis_;
  test::TrackerPeer peer_;
  std::atomic<bool> is_paused_ = false;
  std::jthread thread_{[this](const std::stop_token& stop) {
    while (!stop.stop_requested()) {
      if (!is_paused_) send();
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
  }};
};

class TrackedOperation : public ::testing::Test {
 protected:
  [[nodiscard]] OperationRun made(bool records) {
    operation::OperationSetup setup;
    setup.plan = a_plan();
    return {setup, std::make_unique<NothingToRegister>(),
            records ? OperationRun::MakeSessionFolder([this] {
              std::filesystem::create_directory(session_);
              return session_;
            })
                    : OperationRun::MakeSessionFolder()};
  }
  [[nodiscard]] theatre::TheatreSource source() const {
    theatre::TheatreSource source;
    source.setup = setup_;
    source.open = [] { return std::make_unique<NoiseSource>(); };
    source.tracker = [address = peer_.address(), options = setup_.pipeline]() mutable {
      options.tools.tracker->address = address;
      return listen_to_tracker(options);
    };
    return source;
  }
  void begin(OperationRun& run) const {
    run.start(source());
    operation::GiveRegistration give;
    give.registration.has_pose = give.registration.reliable = true;
    give.registration.reasons.clear();
    give.registration.covariance = geometry::Matrix6d::Identity() * 1e-4;
    give.registration.predicted_tre_mm = 0.3;
    give.of = operation::provenance_of(run.operation().setup(), setup_);
    run.apply(give);
    run.apply(operation::ConfirmTimeOut{});
  }
  // Steps until guidance is or is not; false: not within 20 s.
  [[nodiscard]] bool step_until(OperationRun& run, bool guides) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
    while (std::chrono::steady_clock::now() < end) {
      if (run.step().picture == nullptr) continue;
      const pipeline::FrameResult& frame = run.state_of_frame()->frame;
      EXPECT_FALSE(frame.camera_from_world.is_valid) << "the camera is in no frame of the tracker's";
      if (frame.guidance.is_valid()) {
        EXPECT_LE(frame.outside.oldest_age_s(), tracker::PoseBook::kMaxAge_s);
      }
      if (frame.guidance.is_valid() == guides) return true;
    }
    return false;
  }

  const test::TemporaryFolder folder_;
  const std::filesystem::path session_ = folder_ / "session";
  operation::SourceSetup setup_ = a_setup();
  SendingPeer peer_{setup_.pipeline.tools};
};

TEST_F(TrackedOperation, GuidesByTheTrackerAndStopsWithIt) {
  OperationRun run = made(false);
  begin(run);
  ASSERT_TRUE(step_until(run, true)) << run.tracker_trouble();
  const guidance::GuidanceNumbers g = run.state_of_frame()->frame.guidance;
  // Poses are sent as floats, a metre away: 0.1 mm of 1000 mm would be 1000 times what they round to.
  EXPECT_NEAR(g.tip_to_entry_mm, kOff_mm, 1e-3);
  EXPECT_NEAR(g.angle_deg, 0, 1e-2);
  // Of the tracker's 0.2 mm and 0.1 degrees at least as much as one pose has.
  EXPECT_GT(g.sigma_offset_mm, 0.2);
  EXPECT_LT(g.sigma_offset_mm, 2);
  const double age_s = run.state_of_frame()->frame.outside.oldest_age_s();
  peer_.pause(true);
  const auto stalled = std::chrono::steady_clock::now();
  ASSERT_TRUE(step_until(run, false));
  std::printf("guides by poses %.1f ms old; gone %.0f ms after the last one\n", 1000 * age_s,
              std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - stalled).count());
  const pipeline::FrameResult& lost = run.state_of_frame()->frame;
  EXPECT_EQ(lost.guidance.state, guidance::GuidanceState::WorldMarkerLost);
  EXPECT_EQ(tracker::state_of(lost.outside, kFemur), tracker::BodyState::Stale);
  EXPECT_EQ(run.state_of_frame()->next_action == operation::NextAction::FollowBullseye, false);
  peer_.pause(false);
  EXPECT_TRUE(step_until(run, true)) << run.tracker_trouble();
}

TEST_F(TrackedOperation, AnErrorThatIsNotSaidGuidesNothing) {
  setup_.pipeline.tools.tracker->sigma_mm.reset();
  OperationRun run = made(false);
  begin(run);
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
  auto seen = tracker::BodyState::NotConnected;
  while (seen != tracker::BodyState::ErrorUnknown && std::chrono::steady_clock::now() < end) {
    if (run.step().picture == nullptr) continue;
    seen = tracker::state_of(run.state_of_frame()->frame.outside, kFemur);
    EXPECT_FALSE(run.state_of_frame()->frame.guidance.is_valid());
  }
  EXPECT_EQ(seen, tracker::BodyState::ErrorUnknown);
}

// What a recording or a simulation shows is of another time than the tracker's poses.
TEST_F(TrackedOperation, OnlyALiveSourceGoesWithATracker) {
  for (const auto kind : {sources::SourceKind::Recording, sources::SourceKind::Simulation}) {
    setup_.kind = kind;
    OperationRun run = made(false);
    EXPECT_THROW(run.start(source()), InvalidInput);
    EXPECT_FALSE(run.has_source());
  }
  setup_.kind = sources::SourceKind::Live;
  theatre::TheatreSource nobody = source();
  nobody.tracker = {};
  OperationRun run = made(false);
  EXPECT_THROW(run.start(nobody), InvalidInput);
}

// With the pictures and without them: every state to the last bit, lost and found again in between.
TEST_F(TrackedOperation, IsReplayedToTheLastBit) {
  for (const bool keeps_video : {true, false}) {
    std::filesystem::remove_all(session_);
    {
      OperationRun run = made(true);
      begin(run);
      run.keep_video(keeps_video);
      ASSERT_TRUE(step_until(run, true)) << run.tracker_trouble();
      peer_.pause(true);
      ASSERT_TRUE(step_until(run, false));
      peer_.pause(false);
      ASSERT_TRUE(step_until(run, true)) << run.tracker_trouble();
      // How many pictures all this took is the machine's affair: as many more as the comparison shall have.
      for (int more = 0; more < kFramesCompared;)
        if (run.step().picture != nullptr) ++more;
      run.end_source();
      EXPECT_EQ(run.record_trouble(), "");
    }
    const recording::RecordedSession session(session_);
    ASSERT_GT(session.frames().size(), std::size_t{kFramesCompared});
    EXPECT_EQ(session.frames().back().outside.bodies.size(), 5U);
    EXPECT_GT(session.frames().back().outside.bodies.front().stamp_utc_s, 1e9);
    const auto replayed = recording::replay_session(session, {});
    EXPECT_TRUE(replayed.is_same_build);
    EXPECT_EQ(replayed.states_compared, static_cast<long>(session.frames().size()));
    EXPECT_EQ(replayed.states_equal, replayed.states_compared) << "with video: " << keeps_video;
    for (const auto& difference : replayed.differences)
      ADD_FAILURE() << difference.frame << " " << difference.what << " " << difference.detail;
  }
}

}  // namespace
}  // namespace arthronaut::openigtlink
