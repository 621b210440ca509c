#include "navigation/recording/drilled_before.h"

#include <fstream>

#include "navigation/recording/session_check.h"
#include "navigation/theatre/operation_run.h"
#include "tests/navigation/theatre/resumable_fixture.h"
#include "tests/navigation/theatre/theatre_sources.h"

namespace arthronaut::recording {
namespace {

class DrilledBeforeTest : public ResumableTest {
 protected:
  // An operation on the femur of which all is said but the end.
  void drill(PhantomOperation& run, SourceKind kind = SourceKind::Live) {
    operate(run, test::scripted_source(kind));
    run.touch(test::on_bone(trial_, -5));
    for (int i = 0; i < 200; ++i) run.show_guide(0.02 * i - 1);
    run.apply(TunnelDrilled{});
    ASSERT_EQ(run.state()->drilled.outcome, DrilledState::Outcome::Recorded);
  }
  void drill_and_end(SourceKind kind = SourceKind::Live) {
    PhantomOperation run;
    continues_.clear();
    drill(run, kind);
    end(run);
  }
  [[nodiscard]] DrilledBefore before(const std::string& mesh = "the phantom's") const {
    return drilled_before(folder_.path(), {{bones::BoneKind::Femur, mesh}});
  }
  [[nodiscard]] static const DrilledTunnel* drilled(const DrilledBefore& before) {
    return before.tunnels.find(test::phantom_plan());
  }
};

// What a program knew that was ended between the bones is what its records say.
TEST_F(DrilledBeforeTest, ATunnelIsDrilledMeasuredAndVerifiedAsTheOperationSaid) {
  EXPECT_EQ(before().tunnels.count(), 0U);
  PhantomOperation run;
  drill(run);
  DrilledTunnels said;
  said.follow(*run.state());
  ASSERT_TRUE(said.find(test::phantom_plan())->was_verified);
  run.operation().end_source();
  run.apply(MarkerOut{});
  end(run);
  const DrilledBefore known = before();
  ASSERT_NE(drilled(known), nullptr);
  EXPECT_EQ(drilled(known)->measured->measured.entry_mm,
            said.find(test::phantom_plan())->measured->measured.entry_mm);
  EXPECT_TRUE(drilled(known)->was_verified) << "whatever becomes of the marker";
  EXPECT_TRUE(known.tunnels.marker_is_out(bones::BoneKind::Femur));
  EXPECT_EQ(known.newest.at(bones::BoneKind::Femur), cases::session_folders(folder_.path()).back());
  PlannedTunnel other = test::phantom_plan();
  other.tunnel.entry_mm.x() += 1;
  EXPECT_EQ(known.tunnels.find(other), nullptr) << "planned anew";
  EXPECT_EQ(before("another surface").tunnels.count(), 0U);
}

TEST_F(DrilledBeforeTest, ARehearsalAndARecordingSayNothingOfThePatient) {
  for (const SourceKind kind : {SourceKind::Simulation, SourceKind::Recording}) drill_and_end(kind);
  EXPECT_EQ(before().tunnels.count(), 0U);
  EXPECT_TRUE(before().newest.empty());
}

TEST_F(DrilledBeforeTest, TheWordAloneIsEnoughAndCanBeTakenBack) {
  PhantomOperation run;
  begin(run, test::scripted_source());
  run.show(run.frame());
  run.apply(TunnelDrilled{});
  end(run);
  ASSERT_NE(drilled(before()), nullptr);
  EXPECT_FALSE(drilled(before())->measured);
  EXPECT_FALSE(drilled(before())->was_verified);
  begin(run, test::scripted_source());  // the same operation goes on
  run.show(run.frame());
  EXPECT_NE(drilled(before()), nullptr);
  run.apply(TakeBackDrilled{});
  end(run);
  EXPECT_EQ(drilled(before()), nullptr);
  drill_and_end();
  EXPECT_TRUE(drilled(before())->measured);
}

// Also where no picture showed the drilling, the registration that it went by was verified.
TEST_F(DrilledBeforeTest, WhatWasVerifiedIsKnownOfATunnelByWord) {
  PhantomOperation run;
  operate(run, test::scripted_source());
  run.touch(test::on_bone(trial_, -5));
  ASSERT_EQ(run.state()->verification, Verification::ByTouches);
  run.apply(TunnelDrilled{});
  ASSERT_EQ(run.state()->drilled.outcome, DrilledState::Outcome::NoEvidence);
  end(run);
  EXPECT_TRUE(drilled(before())->was_verified);
}

// With the marker out it came to its end: the next one, of the same plan, has drilled nothing yet.
TEST_F(DrilledBeforeTest, TheNextOperationBeginsAfresh) {
  PhantomOperation run;
  drill(run);
  run.operation().end_source();
  run.apply(MarkerOut{});
  end(run);
  PhantomOperation next;
  continues_.clear();
  begin(next, test::scripted_source());
  next.show(next.frame());
  end(next);
  EXPECT_EQ(before().tunnels.count(), 0U);
  EXPECT_FALSE(before().tunnels.marker_is_out(bones::BoneKind::Femur));
}

TEST_F(DrilledBeforeTest, ABrokenSessionHidesNoOther) {
  drill_and_end();
  const std::filesystem::path broken = cases::create_session_folder(folder_.path());
  std::ofstream(broken / "session.json") << "{";
  EXPECT_NE(drilled(before()), nullptr);
  ASSERT_EQ(before().passed_over.size(), 1U);
  EXPECT_NE(before().passed_over.front().find(broken.filename().string()), std::string::npos);
}

// The program was ended before the marker was out, or the tunnel was said to be drilled too early: what is
// said in the next one, without any source, stands in the record of the operation that it is of.
TEST_F(DrilledBeforeTest, WhatIsSaidInTheNextProgramIsKeptToo) {
  drill_and_end();
  const DrilledBefore left = before();
  const auto say = [&](const Command& command) {
    const OperationSetup setup = test::phantom_setup();
    theatre::OperationRun run(setup, test::at_once(setup),
                              [&] { return cases::create_session_folder(folder_.path()); });
    run.goes_on_after(left.newest.at(bones::BoneKind::Femur));
    run.apply(command);
    EXPECT_EQ(run.record_trouble(), "");
  };
  say(MarkerOut{});
  EXPECT_TRUE(before().tunnels.marker_is_out(bones::BoneKind::Femur));
  EXPECT_NE(drilled(before()), nullptr);
  EXPECT_FALSE(found());
  say(TakeBackDrilled{});
  EXPECT_EQ(drilled(before()), nullptr);
  EXPECT_TRUE(found()) << "it is not at its end any more";
  EXPECT_FALSE(before().tunnels.marker_is_out(bones::BoneKind::Femur));
  ASSERT_EQ(cases::session_folders(folder_.path()).size(), 1U);
  const std::filesystem::path folder = cases::session_folders(folder_.path()).front();
  EXPECT_EQ(check_session(folder).outcome, SessionCheck::Outcome::Unbroken);
  const RecordedSession session(folder);
  EXPECT_EQ(session.events().back().kind, kSaidTooEarlyEvent);
  EXPECT_GE(session.events().back().timestamp_ns, session.frames().back().timestamp_ns);
}

}  // namespace
}  // namespace arthronaut::recording
