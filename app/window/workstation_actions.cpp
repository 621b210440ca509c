// What the window itself can do, whichever mode is shown.
#include <GLFW/glfw3.h>

#include "app/plan/plan_view.h"
#include "app/window/workstation_window.h"

namespace arthronaut::window {

void WorkstationWindow::add_actions() {
  const auto is_open = [this] { return model() != nullptr; };
  for (std::size_t i = 0; i < modes_.size(); ++i) {
    const mode::ModeTitle title = modes_[i]->title();
    actions_.add(
        {std::string(title.action), std::string(title.label), std::string(title.tooltip), title.key, 0, false,
         [this, is_open, i] {
           // What writes the bones, or is about to be another case, is left by nothing but its own end.
           if (!is_open() || opening_ != nullptr || paint_.has_running_work()) return false;
           return !case_->is_read_only() || modes_[i]->works_read_only();
         },
         [this, i] { return shown_ == i && !shows_start() && !shows_paint(); }, [this, i] { show(i); }});
  }
  actions_.add({"app.cases",
                "Cases",
                "Open another case, or import one; drop a folder on the window for the same",
                GLFW_KEY_F5,
                0,
                false,
                // An import that waits for an answer is here, and nowhere else.
                [this] { return case_ != nullptr && !works_elsewhere() && opening_ == nullptr; },
                [this] { return shows_start(); },
                [this] {
                  if (shows_start_) return close_start();
                  leave_shown();
                  shows_start_ = true;
                  start_.enter(case_->folder());
                },
                {},
                [this] {
                  return !works_elsewhere()           ? ""
                         : paint_.has_running_work()  ? "bones are being written"
                         : shown().has_running_work() ? "end what runs here first"
                                                      : "end what runs in another mode first";
                }});
  add_markups_action();
  actions_.add(
      {"app.take_over",
       "Take over",
       "The case is this program's to write from then on: only where the program of the other machine "
       "that has it is gone, or this folder is a copy of its case",
       GLFW_KEY_T,
       GLFW_MOD_CONTROL,
       false,
       [this] {
         return case_ != nullptr && case_->is_of_other_host() && opening_ == nullptr && !has_running_work() &&
                !shows_start();
       },
       {},
       [this] {
         if (case_->take_over()) reopen();
       },
       {"take the case over from the other machine"}});
  actions_.add({"app.stop_opening",
                "Stop opening",
                "The case stays closed; one that was open stays so",
                GLFW_KEY_ESCAPE,
                0,
                false,
                [this] { return can_stop_opening(); },
                {},
                [this] { opening_->cancel(); }});
  actions_.add({"app.keys",
                "Keys",
                "Every key of this mode",
                GLFW_KEY_F10,
                0,
                false,
                {},
                [this] { return shows_keys_; },
                [this] { shows_keys_ = !shows_keys_; }});
  actions_.add({"app.quit",
                "Quit",
                "Everything is saved",
                GLFW_KEY_Q,
                GLFW_MOD_CONTROL,
                false,
                {},
                {},
                [this] { quits_ = true; },
                {"quit", [this] { return has_running_work(); }}});
  add_screen_actions();
  start_.add_actions(actions_);
  actions_.add({"start.tour",
                "Tour",
                "Opens the built-in knee and leads through planning on it, in some minutes",
                GLFW_KEY_F9,
                0,
                false,
                [this] { return start_.shows_cases(); },
                {},
                [this] {
                  plan_->begin_tour_when_opened();
                  start_.open_built_in();
                }});
  paint_.add_actions(actions_);
  for (const auto& mode : modes_) mode->add_actions(actions_);
  if (!options_.list_widgets) return;
  for (const widgets::Action& action : actions_.all())
    if (action.key != 0)
      log_.note_state("key." + action.id, widgets::key_name(action.key, action.mods) + " " + action.label);
}

}  // namespace arthronaut::window
