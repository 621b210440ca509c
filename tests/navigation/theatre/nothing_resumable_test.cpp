// Where nothing was left in the middle, or a part of it cannot be read: what is said of it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "navigation/operation/achieved_tunnel.h"
#include "navigation/recording/session_check.h"
#include "tests/navigation/theatre/resumable_fixture.h"

namespace arthronaut::recording {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

TEST_F(ResumableTest, IsNoneWhereNothingWasLeftInTheMiddle) {
  EXPECT_THAT(search().why_none, HasSubstr("no operation on the femur is recorded"));
  const SourceSetup source = test::scripted_source(SourceKind::Live);
  {
    PhantomOperation run;
    begin(run, source);
    run.apply(Draw{false});
    run.show(run.frame());
    end(run);
    EXPECT_FALSE(found());
    EXPECT_THAT(search().why_none, HasSubstr("it came to nothing"));
  }
  {
    PhantomOperation run;
    operate(run, source);
    end(run);
  }
  EXPECT_TRUE(found());
  EXPECT_FALSE(found("another"));
  EXPECT_THAT(search("another").why_none, HasSubstr(continues_ + ": it is of another surface"));
  EXPECT_THAT(find_resumable(folder_.path(), bones::BoneKind::Tibia, "", planned_).why_none,
              HasSubstr("no operation on the tibia is recorded"));
  {
    OperationSetup setup = test::phantom_setup();
    setup.registers_after_mm = 40;
    PhantomOperation run(setup);
    operate(run, source);
    end(run);
    EXPECT_FALSE(found());
    EXPECT_THAT(search().why_none, HasSubstr("nobody was at its pedal"));
  }
  {
    PhantomOperation run;
    operate(run, source);
    for (int i = 0; i < 200; ++i) run.show_guide(0.02 * i - 1);
    run.apply(TunnelDrilled{});
    ASSERT_EQ(run.state()->drilled.outcome, DrilledState::Outcome::Recorded);
    end(run);
    EXPECT_FALSE(found());
    EXPECT_THAT(search().why_none, HasSubstr("its tunnels are drilled"));
  }
  {
    PhantomOperation run;
    operate(run, source);
    for (int i = 0; i < 200; ++i) run.show_guide(0.02 * i - 1);
    run.apply(TunnelDrilled{});
    run.apply(TakeBackDrilled{});
    end(run);
    EXPECT_TRUE(found()) << "it was not drilled after all";
    const std::filesystem::path session = cases::session_folders(folder_.path()).back();
    EXPECT_TRUE(std::filesystem::exists(session / "achieved.json")) << "as a part of the record";
    EXPECT_TRUE(operation::achieved_files(session).empty()) << "nothing tells of it as achieved";
    EXPECT_EQ(check_session(session).outcome, SessionCheck::Outcome::Unbroken);
  }
}

// The first of two bundles' tunnels is drilled: the operation is not at its end while the other one is
// planned.
TEST_F(ResumableTest, GoesOnWhileTheOtherBundlesTunnelIsNotDrilled) {
  const tunnels::TunnelKey am{bones::BoneKind::Femur, norms::Bundle::Anteromedial};
  const tunnels::TunnelKey pl{bones::BoneKind::Femur, norms::Bundle::Posterolateral};
  planned_ = {am, pl};
  const SourceSetup source = test::scripted_source(SourceKind::Live);
  const auto drill = [&](PhantomOperation& run) {
    for (int i = 0; i < 200; ++i) run.show_guide(0.02 * i - 1);
    run.apply(TunnelDrilled{});
    ASSERT_EQ(run.state()->drilled.outcome, DrilledState::Outcome::Recorded);
  };
  OperationSetup setup = test::phantom_setup();
  setup.plan->tunnel.bundle = am.bundle;
  PhantomOperation run(setup);
  operate(run, source);
  drill(run);
  end(run);
  const auto left = found();
  ASSERT_TRUE(left) << "PL is not drilled";
  EXPECT_EQ(left->drilled, std::vector<tunnels::TunnelKey>{am});
  EXPECT_TRUE(left->operation.registration);
  planned_ = {am};
  EXPECT_FALSE(found()) << "nothing else is planned";
  planned_ = {am, pl};
  PlannedTunnel other = *setup.plan;
  other.tunnel.bundle = pl.bundle;
  run.on_journal = [this](const auto& entries) {
    early_.insert(early_.end(), entries.begin(), entries.end());
  };
  run.apply(OfferPlan{other});  // in the next record, which goes on from this one
  begin(run, source);
  drill(run);
  end(run);
  EXPECT_FALSE(found()) << "both are drilled";
}

// A newer session that cannot be read is passed over, and that is told.
TEST_F(ResumableTest, ABrokenSessionIsToldNotSilentlyPassedOver) {
  PhantomOperation run;
  operate(run, test::scripted_source(SourceKind::Live));
  end(run);
  const std::filesystem::path broken = cases::create_session_folder(folder_.path());
  std::ofstream(broken / "session.json") << "{";
  const auto left = found();
  ASSERT_TRUE(left);
  EXPECT_EQ(left->operation.session, continues_);
  ASSERT_EQ(search().passed_over.size(), 1U);
  EXPECT_THAT(search().passed_over.front(), HasSubstr(broken.filename().string()));
}

// Also where it is the only one, and nothing is left.
TEST_F(ResumableTest, ABrokenSessionIsToldWhereThereIsNoOther) {
  const std::filesystem::path broken = cases::create_session_folder(folder_.path());
  std::ofstream(broken / "session.json") << "{";
  EXPECT_FALSE(found());
  EXPECT_THAT(search().passed_over, ElementsAre(HasSubstr(broken.filename().string())));
  EXPECT_THAT(search().why_none, HasSubstr("in what can be read"));
}

}  // namespace
}  // namespace arthronaut::recording
