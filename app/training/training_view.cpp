#include "app/training/training_view.h"

#include <GLFW/glfw3.h>

#include <algorithm>
#include <chrono>
#include <utility>

#include "app/case/exercise_case.h"
#include "navigation/training/exercise_step.h"
#include "planning/files/utc_clock.h"
#include "planning/phantom/phantom_case.h"

namespace arthronaut::training_mode {

namespace {

using Phase = theatre::LiveState::Phase;
using simulator::Held;
using training::Level;

}  // namespace

void HandInbox::set(const simulator::HandInput& input) {
  const std::lock_guard lock(mutex_);
  input_ = input;
}

void HandInbox::press(simulator::Press press) {
  const std::lock_guard lock(mutex_);
  presses_.push_back(press);
}

void HandInbox::hold_up(bool on) {
  const std::lock_guard lock(mutex_);
  is_held_up_ = on;
  goes_on_.notify_all();
}

void HandInbox::end() {
  const std::lock_guard lock(mutex_);
  is_over_ = true;
  goes_on_.notify_all();
}

simulator::Hand HandInbox::hand(const std::shared_ptr<HandInbox>& self) const {
  return [self](const simulator::HandScene&,
                const simulator::HandState&) -> std::optional<simulator::HandInput> {
    std::unique_lock lock(self->mutex_);
    const auto asked = std::chrono::steady_clock::now();
    self->goes_on_.wait(lock, [&] { return self->is_over_ || !self->is_held_up_; });
    if (self->is_over_) return std::nullopt;
    simulator::HandInput input = self->input_;
    input.held_up_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - asked).count();
    if (!self->presses_.empty()) {
      input.press = self->presses_.front();
      self->presses_.pop_front();
    }
    return input;
  };
}

TrainingView::TrainingView(Theatre theatre, DrawBoard draw_board, std::filesystem::path scores)
    : theatre_(std::move(theatre)), draw_board_(std::move(draw_board)), scores_file_(std::move(scores)) {}

mode::ModeTitle TrainingView::title() const {
  return {"train", "mode.training", "Train", "Exercises on the simulator, with a score", GLFW_KEY_F6};
}

std::vector<std::string_view> TrainingView::action_prefixes() const {
  switch (page_) {
    case Page::List:
      return {"train.list."};
    case Page::Score:
      return {"train.score."};
    case Page::Running:
      if (is_with_board()) return {"train.run.", "train.board."};
      // The pedal is the theatre's; its letters are the hands' here.
      return {"train.run.", "navigate.next", "navigate.back", "navigate.overlay", "navigate.sounds"};
  }
  return {};
}

void TrainingView::add_actions(widgets::Actions& actions) {
  const auto move = [this](int step) {
    const auto count = static_cast<int>(training::exercises().size());
    chosen_ = static_cast<std::size_t>((static_cast<int>(chosen_) + step + count) % count);
  };
  const auto change_level = [this](int step) {
    level_ = static_cast<Level>(std::clamp(static_cast<int>(level_) + step, 0, 2));
  };
  const auto can_start = [this] { return refusal().empty(); };
  actions.add({"train.list.start",
               "Start",
               "Begins the exercise on the simulator",
               GLFW_KEY_SPACE,
               0,
               false,
               can_start,
               {},
               [this] { start(); }});
  actions.add(
      {"train.list.next", "Next exercise", "Chooses the one below", GLFW_KEY_DOWN, 0, true, {}, {}, [move] {
         move(1);
       }});
  actions.add({"train.list.previous",
               "Exercise before",
               "Chooses the one above",
               GLFW_KEY_UP,
               0,
               true,
               {},
               {},
               [move] { move(-1); }});
  actions.add({"train.list.harder",
               "Harder",
               "More goes wrong",
               GLFW_KEY_RIGHT,
               0,
               false,
               [this] { return level_ != Level::Hard; },
               {},
               [change_level] { change_level(1); }});
  actions.add({"train.list.easier",
               "Easier",
               "Less goes wrong",
               GLFW_KEY_LEFT,
               0,
               false,
               [this] { return level_ != Level::Easy; },
               {},
               [change_level] { change_level(-1); }});
  const auto runs = [this] { return run_ && run_->is_prepared && !run_->is_ended; };
  actions.add({"train.run.done",
               "Done",
               "Says that the exercise is done: it ends, and is scored",
               GLFW_KEY_ENTER,
               0,
               false,
               runs,
               {},
               [this] { done(); }});
  actions.add({"train.run.tool", "Other tool",
               "Puts the probe down and takes the guide, or the other way round", GLFW_KEY_G, 0, false,
               [this, runs] { return runs() && !is_with_board(); },
               [this] { return run_ && run_->held == Held::Guide; },
               [this] { run_->held = run_->held == Held::Probe ? Held::Guide : Held::Probe; }});
  actions.add({"train.run.stop",
               "Stop",
               "Ends the exercise; one that is not done counts nothing",
               GLFW_KEY_ESCAPE,
               0,
               false,
               [this] { return run_.has_value() && !run_->is_ended; },
               {},
               [this] { stop(false); },
               {"stop the exercise"}});
  add_board_actions(actions);
  actions.add({"train.score.again",
               "Once more",
               "The same exercise again",
               GLFW_KEY_ENTER,
               0,
               false,
               can_start,
               {},
               [this] { start(); }});
  actions.add({"train.score.list", "Exercises", "Back to the list", GLFW_KEY_SPACE, 0, false, {}, {}, [this] {
                 page_ = Page::List;
               }});
}

void TrainingView::case_opened(const mode::OpenCase& opened) {
  if (run_) run_->inbox->end();
  run_.reset();
  score_.reset();
  page_ = Page::List;
  notice_.clear();
  opened_ = opened;
  case_refusal_ = open_case::refusal_to_train(opened.folder);
}

std::string TrainingView::refusal() const {
  if (!opened_) return "No case is open";
  return case_refusal_.empty() ? theatre_.refusal(chosen().bone) : case_refusal_;
}

void TrainingView::read_scores() {
  try {
    scores_ = training::read_training_file(scores_file_);
  } catch (const std::runtime_error& error) {  // a broken list is told, and training goes on without it
    scores_.clear();
    notice_ = error.what();
  }
}

void TrainingView::enter() {
  is_shown_ = true;
  notice_.clear();
  if (opened_ && !run_) case_refusal_ = open_case::refusal_to_train(opened_->folder);
  read_scores();
  if (page_ == Page::Running && !is_with_board()) theatre_.screen->enter();
}

void TrainingView::leave() {
  is_shown_ = false;
  // It is not the theatre's, where a real operation may begin now, and takes a core of its own.
  if (is_with_board()) return stop(false);
  if (!run_) return;
  run_->inbox->set({.held = run_->held});
  run_->inbox->hold_up(false);
}

void TrainingView::cover(bool is_covered) {
  if (run_) run_->inbox->hold_up(is_covered);
}

// Another place for everything each time: who learns the places learns nothing.
std::uint64_t TrainingView::next_seed() const {
  return static_cast<std::uint64_t>(
      1 + std::count_if(scores_.begin(), scores_.end(),
                        [&](const training::Score& score) { return score.exercise == chosen().id; }));
}

void TrainingView::start() {
  const training::Exercise& exercise = chosen();
  const open_case::PlanModel& model = *opened_->model;
  // Once more, at the last moment: what the case holds decides, not what was seen of it.
  case_refusal_ = open_case::refusal_to_train(opened_->folder);
  if (!case_refusal_.empty()) return;
  if (exercise.goal == training::Goal::Calibrate) return start_board();
  const std::optional<tunnels::Tunnel> plan = model.tunnel(tunnels::TunnelKey(exercise.bone));
  if (!plan) {
    notice_ = "There is no planned tunnel in the " + std::string(bones::to_text(exercise.bone));
    return;
  }
  notice_.clear();
  run_.emplace();
  run_->setup = {
      .exercise = exercise,
      .level = level_,
      .knee = phantom::knee_of(model.knee()),
      .plan = *plan,
      .seed = next_seed(),
      .plan_length_mm = tunnels::length_along(*plan, *model.shared_surface(exercise.bone)).value_or(0)};
  run_->watch = std::make_shared<training::ExerciseWatch>(run_->setup);
  run_->inbox = std::make_shared<HandInbox>();
  run_->held = exercise.goal == training::Goal::Aim ? Held::Guide : Held::Probe;
  run_->inbox->set({.held = run_->held});
  score_.reset();
  page_ = Page::Running;
  theatre_.begin_anew(*opened_);
  theatre_.screen->enter();
  theatre::TheatreSource source =
      training::exercise_source(run_->setup, run_->inbox->hand(run_->inbox), run_->watch, true);
  constexpr double kHeldUp_s = 8 * 3600;  // that long nobody reads a list of keys
  source.patience_s = kHeldUp_s;
  run_->source = source.setup;
  theatre_.start(exercise.bone, std::move(source),
                 [watch = run_->watch, goal = exercise.goal, live = theatre_.live]() -> std::string {
                   const auto truth = watch->log()->newest();
                   return truth ? training::exercise_step(goal, *live()->operation, truth->hand) : "";
                 });
}

// Something else has the theatre: it is not ended, asked or wiped from here.
bool TrainingView::is_another(const theatre::LiveState& live) const {
  // Before its first picture the screen alone knows what is being opened.
  const auto kind = theatre_.screen->source_kind();
  if (kind && *kind != sources::SourceKind::Simulation) return true;
  const auto& source = live.operation->source;
  if (source == nullptr) return false;  // nothing has come of it yet
  const bool is_alike =
      source->kind == sources::SourceKind::Simulation && source->title == run_->source.title;
  return !is_alike || (run_->watch->has_begun() && !run_->watch->is_of(*live.operation));
}

void TrainingView::drop() {
  run_->inbox->end();
  run_.reset();
  page_ = Page::List;
  notice_ = "The exercise is over: another source was started in Navigate";
}

// With the first picture: what the exercise takes for known.
void TrainingView::prepare(const theatre::LiveState& live) {
  const auto truth = run_->watch->log()->at(0);
  const operation::OperationSetup* const setup = theatre_.setup();
  if (!truth || setup == nullptr || !run_->watch->is_of(*live.operation)) return;
  run_->is_prepared = true;
  if (!training::begins_registered(run_->setup.exercise)) return;
  theatre_.ask(operation::GiveRegistration{training::known_registration(*truth),
                                           operation::provenance_of(*setup, run_->source), false});
  theatre_.ask(operation::SkipVerification{});
}

void TrainingView::done() { stop(true); }

void TrainingView::stop(bool is_done) {
  if (!run_ || run_->is_ended) return;
  if (is_with_board()) {
    run_->is_ended = true;
    return is_done ? run_->inbox->press(simulator::Press::Finish) : run_->inbox->end();
  }
  if (is_another(*theatre_.live())) return drop();
  if (is_done) run_->watch->finish();
  run_->is_ended = true;
  run_->inbox->end();
  theatre_.end();
}

void TrainingView::take_score(const theatre::LiveState& live) {
  keep_score(run_->watch->facts(), opened_->model->knee().name, live.session_folder.filename().string(),
             live.phase == Phase::Failed ? live.message : "");
  // Nothing of it stays in the theatre, where the next thing may be real.
  theatre_.begin_anew(*opened_);
}

void TrainingView::keep_score(const training::ExerciseFacts& facts, const std::string& knee,
                              const std::string& session, const std::string& failure) {
  training::Score score = training::score_of(run_->setup.exercise, run_->setup.level, facts);
  score.seed = run_->setup.seed;
  score.when_utc = files::utc_now();
  score.knee = knee;
  score.session = session;
  if (!session.empty()) score.case_created_utc = opened_->model->knee().created_utc;
  score.trainee = training::kByHand;
  if (!failure.empty())
    notice_ = failure;
  else if (facts.frames > 0) {
    try {
      training::add_to_training_file(scores_file_, score);
    } catch (const std::runtime_error& error) {
      notice_ = error.what();
    }
    read_scores();
  }
  score_ = std::move(score);
  run_.reset();
  page_ = Page::Score;
}

void TrainingView::push(double now_s) {
  const double dt_s = std::clamp(now_s - last_push_s_, 0.001, 0.2);
  last_push_s_ = now_s;
  // Behind another mode no device moves anything, the gamepad's drill least of all.
  const DeviceState devices = is_shown_ ? devices_.read(ImGui::GetIO().DisplaySize.y) : DeviceState();
  run_->inbox->set(hand_input(devices, run_->held, dt_s));
}

void TrainingView::tick(double now_s) {
  if (!run_) return;
  if (is_with_board()) return tick_board(now_s);
  const theatre::LiveStatePtr live = theatre_.live();
  if (is_another(*live)) return drop();
  // Whoever ended it, and however early: it was begun with nothing in the theatre, so the end is this one's.
  if (live->phase == Phase::Ended || live->phase == Phase::Failed) return take_score(*live);
  if (!run_->is_prepared && live->phase == Phase::Running) prepare(*live);
  if (!run_->is_ended) push(now_s);
}

std::optional<sources::SourceKind> TrainingView::source_kind() const {
  if (is_with_board()) return sources::SourceKind::Simulation;
  return page_ == Page::Running ? theatre_.screen->source_kind() : std::nullopt;
}

widgets::Rect TrainingView::strip_of(const widgets::Ui& ui, widgets::Rect& area) const {
  return area.cut_bottom(ui.theme.px(84), ui.theme.px(10));
}

std::optional<widgets::Rect> TrainingView::header_in(const widgets::Ui& ui,
                                                     const widgets::Rect& window) const {
  if (page_ != Page::Running || is_with_board()) return std::nullopt;
  widgets::Rect rest = window;
  (void)strip_of(ui, rest);
  return theatre_.screen->header_in(ui, rest);
}

void TrainingView::draw(const widgets::Ui& ui, const widgets::Rect& area) {
  ui.log.note_state("train_page", page_ == Page::List      ? "list"
                                  : page_ == Page::Running ? "running"
                                                           : "score");
  if (page_ != Page::Running) return page_ == Page::List ? draw_list(ui, area) : draw_score(ui, area);
  const PadPresses pad = devices_.presses();
  if (pad.do_it) (void)ui.actions.run(is_with_board() ? "train.board.take" : "navigate.next");
  if (pad.back) (void)ui.actions.run(is_with_board() ? "train.board.drop" : "navigate.back");
  if (pad.other_tool) (void)ui.actions.run("train.run.tool");
  if (pad.done) (void)ui.actions.run("train.run.done");
  if (is_with_board()) return draw_board(ui, area);
  widgets::Rect rest = area;
  const widgets::Rect strip = strip_of(ui, rest);
  theatre_.screen->draw(ui, rest);
  draw_strip(ui, strip);
}

}  // namespace arthronaut::training_mode
