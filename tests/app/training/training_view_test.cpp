// Hazard 40: what an exercise asks of the theatre, ends there or wipes, when something else runs in it.
#include "app/training/training_view.h"

#include <gtest/gtest.h>
#include <imgui.h>

#include <chrono>
#include <filesystem>
#include <thread>

#include "planning/phantom/phantom_case.h"
#include "tests/temporary_folder.h"

namespace arthronaut::training_mode {
namespace {

using Phase = theatre::LiveState::Phase;

class Screen : public mode::Mode {
 public:
  [[nodiscard]] mode::ModeTitle title() const override { return {"navigate", "", "", "", 0}; }
  void add_actions(widgets::Actions& /*actions*/) override {}
  [[nodiscard]] std::vector<std::string_view> action_prefixes() const override { return {}; }
  void case_opened(const mode::OpenCase& /*opened*/) override {}
  void draw(const widgets::Ui& /*ui*/, const widgets::Rect& /*area*/) override {}
  [[nodiscard]] std::optional<sources::SourceKind> source_kind() const override { return kind; }
  std::optional<sources::SourceKind> kind;
};

// An exercise (Aim) in a theatre that says what the test lets it say, and counts what it is told.
class TrainingViewTest : public ::testing::Test {
 protected:
  TrainingViewTest() : context_(ImGui::CreateContext()) {
    theatre::LiveState nothing;
    nothing.operation = std::make_shared<const operation::OperationState>();
    live_ = std::make_shared<const theatre::LiveState>(nothing);
    view_.add_actions(actions_);
    view_.case_opened({&model_, folder_.path()});
    for (int i = 0; i < 3; ++i) actions_.run("train.list.next");
  }
  ~TrainingViewTest() override { ImGui::DestroyContext(context_); }

  void begin() {
    actions_.run("train.list.start");
    ASSERT_TRUE(source_.has_value());
    ASSERT_EQ(begun_anew_, 1);
    own_ = std::make_shared<const operation::SourceSetup>(source_->setup);
  }
  // The theatre holds this source, and a picture of it came.
  void holds(const std::shared_ptr<const operation::SourceSetup>& source, Phase phase = Phase::Running) {
    auto state = std::make_shared<operation::OperationState>();
    state->source = source;
    state->frame_count = 1;
    if (source == own_) source_->watch(*state);
    auto live = std::make_shared<theatre::LiveState>();
    live->phase = phase;
    live->operation = state;
    live_ = live;
    if (source != nullptr) screen_.kind = source->kind;
    view_.tick(++now_s_);
  }
  // One frame of it, so that the truth is known.
  void open_own() { (void)source_->open()->next(); }
  [[nodiscard]] static std::shared_ptr<const operation::SourceSetup> other(sources::SourceKind kind,
                                                                           const std::string& title) {
    auto setup = std::make_shared<operation::SourceSetup>();
    setup->kind = kind;
    setup->title = title;
    return setup;
  }
  [[nodiscard]] auto camera() const { return other(sources::SourceKind::Live, "camera"); }
  void expect_let_alone() {
    EXPECT_TRUE(asked_.empty());
    EXPECT_EQ(ended_, 0);
    EXPECT_EQ(begun_anew_, 1) << "what another source found is not wiped";
    EXPECT_FALSE(view_.has_running_work());
    EXPECT_NE(view_.notice(), "");
    EXPECT_FALSE(std::filesystem::exists(folder_ / "training.json"));
  }

  const test::TemporaryFolder folder_;
  ImGuiContext* context_;
  open_case::PlanModel model_{phantom::case_of(phantom::make_phantom_knee({.edge_length_mm = 4}), "test")};
  operation::OperationSetup setup_;
  Screen screen_;
  theatre::LiveStatePtr live_;
  std::optional<theatre::TheatreSource> source_;
  std::function<std::string()> next_step_;
  std::shared_ptr<const operation::SourceSetup> own_;
  std::vector<operation::Command> asked_;
  int ended_ = 0, begun_anew_ = 0;
  double now_s_ = 0;
  widgets::Actions actions_;
  TrainingView view_{
      {.screen = &screen_,
       .refusal = [](bones::BoneKind) { return std::string(); },
       .begin_anew = [this](const mode::OpenCase&) { ++begun_anew_; },
       .start =
           [this](bones::BoneKind, theatre::TheatreSource source, std::function<std::string()> next_step) {
             source_ = source;
             next_step_ = std::move(next_step);
           },
       .live = [this] { return live_; },
       .setup = [this] { return &setup_; },
       .ask = [this](operation::Command command) { asked_.push_back(std::move(command)); },
       .end = [this] { ++ended_; }},
      [](const widgets::Ui&, const widgets::Rect& area, const calibration::CalibrateStatus&, float) {
        return area;
      },
      folder_ / "training.json"};
};

TEST_F(TrainingViewTest, WhatIsKnownIsGivenToItsOwnSourceAsOfASimulation) {
  begin();
  open_own();
  holds(own_);
  ASSERT_EQ(asked_.size(), 2U);
  EXPECT_EQ(std::get<operation::GiveRegistration>(asked_[0]).of.source, sources::SourceKind::Simulation);
  EXPECT_TRUE(view_.has_running_work());
}

// What the operation would ask for next is no part of aiming.
TEST_F(TrainingViewTest, AsksForTheStepsOfTheExercise) {
  begin();
  EXPECT_EQ(next_step_(), "") << "nothing is in anybody's hand yet";
  open_own();
  holds(own_);
  EXPECT_EQ(next_step_(), "bring the guide into view");
}

TEST_F(TrainingViewTest, Hazard40NothingIsGivenToAnotherSource) {
  for (const auto& another :
       {camera(), other(sources::SourceKind::Simulation, "Simulated operation: probe")}) {
    source_.reset();
    begun_anew_ = 0;
    begin();
    open_own();
    holds(another);
    expect_let_alone();
  }
}

// The same words, another start: what runs is known by itself, not by its name.
TEST_F(TrainingViewTest, Hazard40ASourceOfTheSameNameIsAnother) {
  begin();
  holds(own_);
  holds(std::make_shared<const operation::SourceSetup>(*own_));
  expect_let_alone();
}

TEST_F(TrainingViewTest, Hazard40DoneEndsNoOtherSource) {
  begin();
  open_own();
  holds(own_);
  asked_.clear();
  screen_.kind = sources::SourceKind::Live;  // it is being opened: no picture yet
  actions_.run("train.run.done");
  expect_let_alone();
}

TEST_F(TrainingViewTest, Hazard40TheEndOfAnotherSourceIsNotScored) {
  begin();
  holds(own_);
  holds(camera(), Phase::Ended);
  expect_let_alone();
}

// Stopped before its first picture, wherever: it is over, and nothing waits for a picture any more.
TEST_F(TrainingViewTest, EveryEndIsTheEnd) {
  begin();
  auto live = std::make_shared<theatre::LiveState>(*live_);
  live->phase = Phase::Ended;
  live_ = live;
  view_.tick(++now_s_);
  EXPECT_FALSE(view_.has_running_work());
  EXPECT_EQ(begun_anew_, 2);
}

// The calibration is an exercise of its own: the theatre is neither asked, started nor wiped; a picture that
// is asked for at once, before the lens stands before a board near enough, is refused and counted; "done"
// ends it.
TEST_F(TrainingViewTest, ACalibrationTakesNothingOfTheTheatres) {
  for (int i = 0; i < 3; ++i) actions_.run("train.list.previous");
  actions_.run("train.list.start");
  const auto wait_until = [&](const std::function<bool()>& is_so) {
    for (int i = 0; i < 400 && !is_so(); ++i) {
      view_.tick(++now_s_);
      std::this_thread::sleep_for(std::chrono::milliseconds(25));
    }
    return is_so();
  };
  EXPECT_EQ(view_.source_kind(), sources::SourceKind::Simulation);
  const auto can = [&](const char* id) { return actions_.find(id)->can_run(); };
  ASSERT_TRUE(wait_until([&] { return can("train.board.take"); }));
  EXPECT_FALSE(can("train.run.tool"));
  actions_.run("train.run.done");
  ASSERT_TRUE(wait_until([&] { return !view_.has_running_work(); }));
  EXPECT_TRUE(can("train.score.again"));
  EXPECT_FALSE(source_.has_value());
  EXPECT_EQ(begun_anew_, 0);
  EXPECT_EQ(ended_, 0);
  EXPECT_TRUE(asked_.empty());
  const std::vector<training::Score> scores = training::read_training_file(folder_ / "training.json");
  ASSERT_EQ(scores.size(), 1U);
  EXPECT_EQ(scores[0].exercise, "calibrate");
  EXPECT_TRUE(scores[0].is_done);
  EXPECT_EQ(scores[0].session, "");
}

// A case that holds a session of which nobody can tell is somebody's.
TEST_F(TrainingViewTest, Hazard40NothingBeginsInACaseThatIsSomebodys) {
  std::filesystem::create_directories(folder_ / "sessions" / "0001");
  actions_.run("train.list.start");
  EXPECT_FALSE(source_.has_value());
  EXPECT_EQ(begun_anew_, 0);
  EXPECT_FALSE(view_.has_running_work());
}

// Two keys between two pictures: the picture is taken, and then it is finished. Neither is lost, none is
// given twice.
TEST(HandInbox, GivesOnePressAPictureInTheirOrder) {
  using simulator::Press;
  const auto inbox = std::make_shared<HandInbox>();
  const simulator::Hand hand = inbox->hand(inbox);
  inbox->press(Press::Picture);
  inbox->press(Press::Finish);
  for (const Press press : {Press::Picture, Press::Finish, Press::None})
    EXPECT_EQ(hand({}, {})->press, press);
}

}  // namespace
}  // namespace arthronaut::training_mode
