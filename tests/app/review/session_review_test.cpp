#include "app/review/session_review.h"

#include <gtest/gtest.h>

#include <fstream>

#include "tests/navigation/recording/recorded_frames.h"
#include "tests/temporary_folder.h"

namespace arthronaut::review {
namespace {

// Stretches cover exactly what held, and gaps of up to `bridge` frames are closed.
TEST(SessionReview, StretchesBridgeShortGaps) {
  const std::vector<bool> holds{true, true, false, true, false, false, false, true};
  const auto stretches = stretches_of(holds, 1);
  ASSERT_EQ(stretches.size(), 2U);
  EXPECT_EQ(stretches[0].first, 0U);
  EXPECT_EQ(stretches[0].last, 3U);
  EXPECT_EQ(stretches[1].first, 7U);
  EXPECT_EQ(stretches[1].last, 7U);
  EXPECT_TRUE(stretches_of({false, false}, 3).empty());
  EXPECT_TRUE(stretches_of({}, 3).empty());
}

// Each moment is looked at with the plan and the registration of that moment, whatever came after it and
// whatever the case plans by now: an offset to another plan is no offset.
TEST(SessionReview, HoldsWhatGuidedAtEachMoment) {
  const test::TemporaryFolder folder;
  registration::RegistrationSummary registration;
  registration.has_pose = registration.reliable = true;
  {
    recording::SessionRecorder recorder(folder.path(), test::session_header(), test::scripted_options());
    tunnels::Tunnel plan;
    for (const int i : {0, 1, 2, 3}) {
      if (i == 1) recorder.set_registration(registration);
      if (i == 3) recorder.add_event({test::frame_result(i).timestamp_ns, "registration void", "bumped"});
      plan.entry_mm = {static_cast<double>(i / 2), 0, 0};
      if (i % 2 == 0) recorder.set_plan(plan, 30 + i);
      recorder.append(test::frame_result(i));
    }
    recorder.finish();
  }
  const SessionReview review = read_review(folder.path());
  for (const int i : {0, 1, 2, 3}) {
    const Standing& standing = review.standing_at(i);
    ASSERT_TRUE(standing.plan.plan) << i;
    EXPECT_EQ(standing.plan.plan->entry_mm.x(), i / 2) << i;
    EXPECT_EQ(standing.plan.planned_length_mm, i < 2 ? 30 : 32) << i;
    EXPECT_EQ(standing.registration != nullptr, i == 1 || i == 2) << i;
  }
  EXPECT_TRUE(review.problems.empty());
  EXPECT_TRUE(review.drilled.empty());
}

// Each tunnel is drawn from when it was drilled on; of a depth that nobody knows it is as long as what guided
// there was planned, whatever is planned at the moment that is looked at.
TEST(SessionReview, DrawsATunnelFromWhenItWasDrilledAndAsLongAsItsOwnPlan) {
  const test::TemporaryFolder folder;
  tunnels::Tunnel am{.entry_mm = {1, 2, 3}, .direction = {0, 0, 1}, .bundle = norms::Bundle::Anteromedial};
  tunnels::Tunnel pl = am;
  pl.bundle = norms::Bundle::Posterolateral;
  {
    recording::SessionRecorder recorder(folder.path(), test::session_header(), test::scripted_options());
    for (int i = 0; i < 6; ++i) {
      if (i == 1) recorder.set_plan(am, 31);
      if (i == 3) recorder.add_event({0, std::string(recording::kDrilledEvent), "achieved_am.json", -1});
      if (i == 4) recorder.set_plan(pl, 25);
      if (i == 5) recorder.add_event({0, std::string(recording::kDrilledEvent), "achieved_pl.json", -1});
      recorder.append(test::frame_result(i));
    }
    recorder.finish();
  }
  operation::write_achieved_file(folder / "achieved_am.json",
                                 {.planned = am, .measured = am, .depth_mm = {}, .truth = {}});
  operation::write_achieved_file(folder / "achieved_pl.json",
                                 {.planned = pl, .measured = pl, .depth_mm = 18, .truth = {}});
  const SessionReview review = read_review(folder.path());
  EXPECT_TRUE(review.drilled_at(1).empty());
  ASSERT_EQ(review.drilled_at(2).size(), 1U);
  EXPECT_EQ(review.drilled_at(2).front()->length_mm, 31);
  ASSERT_EQ(review.drilled_at(5).size(), 2U);
  EXPECT_EQ(review.drilled_at(5).front()->length_mm, 31);
  EXPECT_EQ(review.drilled_at(5).back()->length_mm, 18);
}

// In the picture with which it ends a registration is not praised above the words that nothing stands any
// more.
TEST(SessionReview, SaysInWhichPictureARegistrationEnds) {
  const test::TemporaryFolder folder;
  {
    recording::SessionRecorder recorder(folder.path(), test::session_header(), test::scripted_options());
    registration::RegistrationSummary registration;
    registration.has_pose = registration.reliable = true;
    recorder.append(test::frame_result(0));
    recorder.set_registration(registration);
    recorder.append(test::frame_result(1));
    recorder.append(test::frame_result(2));
    recorder.add_event({0, std::string(recording::kVoidEvent), "the marker was moved", -1});
    recorder.finish();
  }
  const SessionReview review = read_review(folder.path());
  const RegistrationRow found = registration_row(review, 0);
  EXPECT_EQ(found.severity, widgets::Severity::Quiet) << "nothing guided in this picture";
  EXPECT_TRUE(found.text.starts_with("found with this picture, in force from the next one on")) << found.text;
  EXPECT_EQ(registration_row(review, 1).severity, widgets::Severity::Good);
  const RegistrationRow last = registration_row(review, 2);
  EXPECT_EQ(last.severity, widgets::Severity::Quiet);
  EXPECT_NE(last.text.find("for the last time"), std::string::npos) << last.text;
}

// Pictures that never came are no reason to hide what was asked for and what came of it.
TEST(SessionReview, TellsWhatHappenedWhereNoFrameWasRecorded) {
  const test::TemporaryFolder folder;
  {
    recording::SessionRecorder recorder(folder.path(), test::session_header(), test::scripted_options());
    recorder.add_event({5'000'000'000, "note", "the source was opened", -1});
    recorder.add_event({7'500'000'000, std::string(recording::kDrilledByWordEvent), "femur", -1});
    recorder.finish();
  }
  const SessionReview review = read_review(folder.path());
  ASSERT_TRUE(review.timeline->frames().empty());
  ASSERT_GE(review.moments.size(), 2U);
  EXPECT_EQ(review.moments.front().time_s, 0);
  const auto drilled = std::ranges::find_if(
      review.moments, [](const Moment& one) { return one.words.starts_with("Tunnel drilled, by word"); });
  ASSERT_NE(drilled, review.moments.end());
  EXPECT_NEAR(drilled->time_s, 2.5, 1e-9);
}

// Of the strokes only those stand that were drawn by the moment that is looked at.
TEST(SessionReview, HoldsWhatWasDrawnByEachMoment) {
  const test::TemporaryFolder folder;
  recording::SessionHeader header = test::session_header();
  const auto record = [&](const std::filesystem::path& into, const strokes::Curves& curves) {
    std::filesystem::create_directory(into);
    recording::SessionRecorder recorder(into, header, test::scripted_options());
    for (int i = 0; i < 8; ++i) recorder.append(test::frame_result(i));
    recorder.set_curves(curves);
    recorder.finish();
    return read_review(into);
  };
  const auto point = [](int curve, int frame) {
    const pipeline::FrameResult at = test::frame_result(frame);
    return strokes::CurvePoint{curve, static_cast<double>(at.timestamp_ns) * 1e-9, at.tip_in_world_mm};
  };
  const auto drawn = [](const SessionReview& review, std::size_t frame) {
    return review.drawn_until(review.timeline->frames()[frame].timestamp_ns).size();
  };
  const strokes::Curves own{point(3, 2), point(3, 4), point(4, 6)};
  const SessionReview alone = record(folder / "alone", own);
  for (const auto& [frame, count] : {std::pair(0U, 0U), {1U, 0U}, {2U, 1U}, {4U, 2U}, {5U, 2U}, {7U, 3U}})
    EXPECT_EQ(drawn(alone, frame), count) << frame;

  // What earlier sessions of the operation drew stood all along, whatever their clocks say.
  header.continues = "0001";
  strokes::Curves both{{0, 0.05, {50, 0, 0}}, {1, 70.0, {51, 0, 0}}};
  both.insert(both.end(), own.begin(), own.end());
  const SessionReview later = record(folder / "later", both);
  for (const auto& [frame, count] : {std::pair(0U, 2U), {2U, 3U}, {4U, 4U}, {7U, 5U}})
    EXPECT_EQ(drawn(later, frame), count) << frame;
}

// A registration that cannot be read is told, and the session is shown.
TEST(SessionReview, SaysWhichRegistrationIsBroken) {
  const test::TemporaryFolder folder;
  {
    recording::SessionRecorder recorder(folder.path(), test::session_header(), test::scripted_options());
    registration::RegistrationSummary registration;
    registration.has_pose = true;
    recorder.set_registration(registration);
    recorder.append(test::frame_result(0));
    recorder.finish();
  }
  std::ofstream(folder / "registration_1.json") << "{";
  const SessionReview review = read_review(folder.path());
  EXPECT_EQ(review.standing_at(0).registration, nullptr);
  ASSERT_FALSE(review.problems.empty());
  EXPECT_TRUE(review.problems.front().starts_with("registration_1.json: ")) << review.problems.front();
}

// Its pictures are opened while the time line is read; who asks for them where there are none is told why.
TEST(SessionReview, BringsItsPicturesAlong) {
  const test::TemporaryFolder folder;
  {
    recording::SessionRecorder recorder(folder.path(), test::session_header(), test::scripted_options());
    for (const int i : {0, 1, 2}) {
      auto picture = std::make_shared<camera::Frame>();
      picture->index = i;
      picture->width = 64;
      picture->height = 48;
      picture->bgr.assign(std::size_t{3} * 64 * 48, static_cast<std::uint8_t>(50 * i));
      recorder.append_picture(picture);
      recorder.append(test::frame_result(i));
    }
    recorder.finish();
  }
  const SessionReview review = read_review(folder.path());
  ASSERT_NE(review.pictures, nullptr);
  const auto picture = review.pictures->picture(1, review.timeline->frames()[1].timestamp_ns);
  ASSERT_NE(picture, nullptr);
  EXPECT_NEAR(picture->bgr[0], 50, 2);
  std::filesystem::remove(review.session->video());
  EXPECT_EQ(read_review(folder.path()).pictures, nullptr);
}

// What a session was made of is told with the word that it is a recording: a simulated one is nobody's knee.
TEST(SessionReview, Hazard2SaysWhatTheRecordingIsOf) {
  recording::SessionHeader header = test::session_header();
  EXPECT_EQ(origin_in_words(header), "RECORDING") << "older records do not say it";
  header.source_kind = sources::SourceKind::Live;
  EXPECT_EQ(origin_in_words(header), "RECORDING of a live camera");
  header.source_kind = sources::SourceKind::Recording;
  EXPECT_EQ(origin_in_words(header), "RECORDING of a video");
  header.source_kind = sources::SourceKind::Simulation;
  EXPECT_EQ(origin_in_words(header), "RECORDING of a simulation");
}

}  // namespace
}  // namespace arthronaut::review
