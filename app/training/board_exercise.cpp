// The calibration of a camera as an exercise: its start, its actions, its screen.
#include <GLFW/glfw3.h>

#include <utility>

#include "app/training/training_view.h"
#include "planning/files/format.h"

namespace arthronaut::training_mode {

using files::format;
using simulator::Press;

void TrainingView::add_board_actions(widgets::Actions& actions) {
  const auto runs = [this] { return is_with_board() && run_->is_prepared && !run_->is_ended; };
  actions.add({"train.board.take",
               "Take",
               "Takes the picture that is seen; one that is not good is refused, and counted",
               GLFW_KEY_SPACE,
               0,
               false,
               runs,
               {},
               [this] { run_->inbox->press(Press::Picture); }});
  actions.add({"train.board.drop",
               "Drop last",
               "Forgets the picture taken last",
               GLFW_KEY_BACKSPACE,
               0,
               false,
               [this, runs] { return runs() && !run_->board->latest()->job.taken.empty(); },
               {},
               [this] { run_->inbox->press(Press::DropPicture); },
               {"forget the last picture"}});
}

void TrainingView::start_board() {
  notice_.clear();
  run_.emplace();
  run_->setup = training::standard_setup(chosen(), level_, next_seed());
  run_->held = simulator::Held::Board;
  run_->inbox = std::make_shared<HandInbox>();
  run_->inbox->set({.held = run_->held});
  score_.reset();
  page_ = Page::Running;
  run_->board = std::make_unique<BoardWork>(
      worker::Backlog::Lossless,
      [setup = run_->setup, hand = run_->inbox->hand(run_->inbox)](BoardWork::Inbox& inbox) {
        training::BoardRun run(setup, hand, /*in_real_time=*/true);
        for (bool goes_on = true; goes_on && !inbox.stops();) {
          goes_on = run.step();
          inbox.publish(BoardShown{run.status(), run.facts(), !goes_on});
        }
      });
}

void TrainingView::tick_board(double now_s) {
  const auto shown = run_->board->latest();
  const std::string failure = run_->board->failure();
  if (!failure.empty() || (shown != nullptr && shown->is_over))
    return keep_score(shown != nullptr ? shown->facts : training::ExerciseFacts(),
                      std::string(training::kBoardAlone), "", failure);
  run_->is_prepared = shown != nullptr;
  if (!run_->is_ended) push(now_s);
}

void TrainingView::draw_board(const widgets::Ui& ui, const widgets::Rect& area) const {
  const auto shown = run_->board->latest();
  const BoardShown now = shown != nullptr ? *shown : BoardShown();
  const widgets::Rect keys = draw_board_(ui, area, now.job, ui.theme.px(330));
  widgets::begin_panel(ui, "train.board", keys,
                       std::string(chosen().title) + ", " + std::string(to_text(level_)));
  widgets::text_in(ui.theme.strong, widgets::kText,
                   format("%.0f s   %d refused", now.facts.time_s, now.facts.refused_pictures));
  widgets::text_in(ui.theme.body, widgets::kQuietText,
                   "A D W S Q E the board, J L I K tilt, U O roll, Z X the lens, Enter done, hold Esc stop");
  for (const char* id : {"train.board.take", "train.board.drop"})
    widgets::action_button(ui, id, keys.width - ui.theme.px(32), ui.theme.px(56));
  widgets::end_panel();
  ui.log.note_state("train_hand", run_->is_prepared ? "board" : "");
  ui.log.note_state("train_time", format("%.1f", now.facts.time_s));
  ui.log.note_state("train_taken", std::to_string(now.job.taken.size()));
  ui.log.note_state("train_refused", std::to_string(now.facts.refused_pictures));
}

}  // namespace arthronaut::training_mode
