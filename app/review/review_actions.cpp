#include <GLFW/glfw3.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>

#include "app/review/review_view.h"
#include "navigation/recording/case_sessions.h"
#include "planning/cases/plan_file.h"
#include "planning/geometry/error.h"

namespace arthronaut::review {

void ReviewView::step(long frames) {
  if (!has_frames()) return;
  const long last = static_cast<long>(open_->timeline().frames().size()) - 1;
  go_to(open_->playback, open_->timeline(),
        static_cast<std::size_t>(std::clamp(static_cast<long>(open_->playback.frame) + frames, 0L, last)));
}

void ReviewView::jump(bool forward) {
  const auto frames = frames_to_jump_to(open_->review.moments, open_->marks.marks(), open_->timeline());
  const std::size_t now = open_->playback.frame;
  if (const auto to = forward ? moment_after(frames, now) : moment_before(frames, now))
    go_to(open_->playback, open_->timeline(), *to);
}

void ReviewView::change_marks(const std::function<void(MarkBook&)>& change) {
  try {  // the disk may refuse: that must not end the looking
    change(open_->marks);
    notice_.clear();
  } catch (const IoError& error) {
    notice_ = error.what();
  }
}

void ReviewView::begin_mark() {
  open_->playback.plays = false;
  const recording::SessionMark* const there = open_->marks.find(open_->glance().index);
  note_ = {true,
           true,
           there != nullptr ? there->note : "",
           {open_->glance().index, open_->glance().timestamp_ns, ""}};
}

void ReviewView::keep_mark() {
  recording::SessionMark mark = note_.at;
  mark.note = note_.text;
  change_marks([&](MarkBook& marks) { marks.put(mark); });
  if (notice_.empty()) note_ = {};  // what could not be kept stays to be tried again
}

void ReviewView::draw_note_field(const widgets::Ui& ui) {
  ui.log.note_state("note_field", note_.is_open ? "open" : "closed");
  if (!open_->marks.problem().empty())
    widgets::status_row(ui, widgets::Severity::Caution, "No marks", open_->marks.problem());
  if (!note_.is_open) return;
  widgets::text_in(ui.theme.strong, widgets::kAccent,
                   "Note: Enter keeps it, Esc does not; no patient's name");
  if (note_.takes_focus) ImGui::SetKeyboardFocusHere();
  note_.takes_focus = false;
  ImGui::SetNextItemWidth(-1);
  const bool is_entered = ImGui::InputText("##mark", &note_.text, ImGuiInputTextFlags_EnterReturnsTrue);
  ui.log.note("review.note", ImGui::GetItemRectMin(), ImGui::GetItemRectMax());
  if (is_entered) return keep_mark();
  const bool is_escape = ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape));
  if (is_escape && ImGui::IsItemDeactivated()) note_ = {};
}

std::string ReviewView::no_report_reason() {
  if (!read_only_.empty()) return "the case cannot be written: " + read_only_;
  if (open_ && recording::is_exercise(open_->review.session->header))
    return "an exercise is no operation on anybody; its score stands on the right";
  const bool has_plan = model_ != nullptr && !model_->knee().plan.tunnels.empty();
  return open_ || has_plan || postop_.has_any()
             ? ""
             : "there is nothing to tell of: no session, no CT after an operation and no planned tunnel";
}

void ReviewView::toggle_today() {
  if (runs_today())
    open_->today->stop();
  else
    open_->today = std::make_unique<TodayRun>(case_folder_, open_->review.folder, wake_);
}

void ReviewView::add_playing_actions(widgets::Actions& actions) {
  const auto has = [this] { return shows_frames(); };
  const auto now = [] { return widgets::GraphicsWindow::now_s(); };
  actions.add({"review.play", "Play", "From here at the pace that is set; a loop goes round", GLFW_KEY_SPACE,
               0, false, has, [this] { return open_ && open_->playback.plays; },
               [this, now] { toggle_play(open_->playback, open_->timeline(), now()); }});
  actions.add({"review.loop", "Loop", "Sets where the loop begins, then where it ends, then none", GLFW_KEY_L,
               0, false, has, [this] { return open_ && open_->playback.from.has_value(); },
               [this] { set_loop(open_->playback); }});
  const auto speed = [&](const char* id, const char* label, int key, int by) {
    actions.add(
        {id, label, "From an eighth of the pace to eight times it", key, 0, true, has, {}, [this, now, by] {
           change_speed(open_->playback, open_->timeline(), by, now());
         }});
  };
  speed("review.slower", "Slower", GLFW_KEY_COMMA, -1);
  speed("review.faster", "Faster", GLFW_KEY_PERIOD, 1);
  const auto move = [&](const char* id, const char* label, const char* hint, int key, int mods, long frames) {
    actions.add({id, label, hint, key, mods, true, has, {}, [this, frames] { step(frames); }});
  };
  move("review.back", "1 back", "The picture before this", GLFW_KEY_LEFT, 0, -1);
  move("review.forward", "1 forward", "The picture after this", GLFW_KEY_RIGHT, 0, 1);
  move("review.back_far", "60 back", "By 60 pictures", GLFW_KEY_LEFT, GLFW_MOD_SHIFT, -60);
  move("review.forward_far", "60 forward", "By 60 pictures", GLFW_KEY_RIGHT, GLFW_MOD_SHIFT, 60);
  move("review.first", "First", "The first picture of the session", GLFW_KEY_HOME, 0, -1'000'000'000);
  move("review.last", "Last", "The last picture of the session", GLFW_KEY_END, 0, 1'000'000'000);
  actions.add({"review.event_before",
               "Before",
               "To the command, step, alarm or mark before this",
               GLFW_KEY_B,
               0,
               true,
               has,
               {},
               [this] { jump(false); }});
  actions.add({"review.event_after",
               "Next",
               "To the next command, step, alarm or mark",
               GLFW_KEY_N,
               0,
               true,
               has,
               {},
               [this] { jump(true); }});
}

void ReviewView::add_mark_actions(widgets::Actions& actions) {
  const auto may_mark = [this] { return shows_frames() && open_->marks.problem().empty(); };
  actions.add(
      {"review.mark", "Mark", "Marks this moment, with a note", GLFW_KEY_M, 0, false, may_mark, {}, [this] {
         begin_mark();
       }});
  actions.add({"review.unmark",
               "Unmark",
               "Takes the mark of this moment away",
               GLFW_KEY_DELETE,
               0,
               false,
               [this, may_mark] { return may_mark() && open_->marks.find(open_->glance().index) != nullptr; },
               {},
               [this] { change_marks([this](MarkBook& marks) { marks.remove(open_->glance().index); }); }});
  actions.add({"review.undo",
               "Undo",
               "Takes the last change of the marks back",
               GLFW_KEY_Z,
               GLFW_MOD_CONTROL,
               true,
               [this] { return open_ && open_->marks.can_undo(); },
               {},
               [this] { change_marks([](MarkBook& marks) { marks.undo(); }); }});
  actions.add({"review.redo",
               "Redo",
               "Makes the change of the marks again",
               GLFW_KEY_Y,
               GLFW_MOD_CONTROL,
               true,
               [this] { return open_ && open_->marks.can_redo(); },
               {},
               [this] { change_marks([](MarkBook& marks) { marks.redo(); }); }});
}

void ReviewView::take_dropped(const std::filesystem::path& images, const std::string& series) {
  shows_postop_ = true;
  postop_.compare_with(images, series);
}

void ReviewView::add_postop_actions(widgets::Actions& actions) {
  actions.add({"review.achieved", "CT after", "Planned against achieved, from the images after the operation",
               GLFW_KEY_P, 0, false, [this] { return model_ != nullptr; }, [this] { return shows_postop_; },
               [this] { shows_postop_ = !shows_postop_; }});
  actions.add({"review.find_ct",
               "Find a CT...",
               "Looks for the images after the operation in the folders of this machine; or drop them on the "
               "window",
               GLFW_KEY_O,
               0,
               false,
               [this] { return model_ != nullptr && !postop_.is_running() && !browses(); },
               {},
               [this] {
                 shows_postop_ = true;
                 postop_.browse();
               }});
  actions.add({"review.postop",
               "Write its path",
               "The folder or file of the images after the operation; or drop it on the window",
               GLFW_KEY_C,
               0,
               false,
               [this] { return model_ != nullptr && !postop_.is_running(); },
               {},
               [this] {
                 shows_postop_ = true;
                 postop_.leave_browser();
                 postop_.ask_for_path();
               }});
  actions.add({"review.postop_stop",
               "Stop",
               "Ends the comparison; what the case keeps stays",
               GLFW_KEY_ESCAPE,
               0,
               false,
               [this] { return postop_.is_running(); },
               {},
               [this] { postop_.stop(); }});
  actions.add({"review.postop_replace",
               "Keep these",
               "What these images show takes the place of the tunnels that the case keeps from before",
               GLFW_KEY_K,
               0,
               false,
               [this] { return shows_postop_ && postop_.may_replace_kept(); },
               {},
               [this] { postop_.replace_kept(); }});
  actions.add({"review.postop_next",
               "Next tunnel",
               "Shows another of the planned tunnels",
               GLFW_KEY_TAB,
               0,
               false,
               [this] { return shows_postop_ && postop_.has_any(); },
               {},
               [this] { postop_.choose_next(); }});
}

void ReviewView::add_folder_actions(widgets::Actions& actions) {
  const auto looks = [this] { return browses(); };
  const auto take = [this](const std::filesystem::path& images) { postop_.compare_with(images); };
  struct Step {
    const char *id, *label;
    int key, by;
  };
  for (const Step& step : {Step{"review.folder_previous", "Up", GLFW_KEY_UP, -1},
                           Step{"review.folder_next", "Down", GLFW_KEY_DOWN, 1},
                           Step{"review.folder_page_up", "Ten up", GLFW_KEY_PAGE_UP, -10},
                           Step{"review.folder_page_down", "Ten down", GLFW_KEY_PAGE_DOWN, 10}})
    actions.add({step.id,
                 step.label,
                 "Goes through the list of the folder",
                 step.key,
                 0,
                 true,
                 looks,
                 {},
                 [this, by = step.by] { postop_.browser()->move_selection(by); }});
  actions.add({"review.folder_open",
               "Open",
               "Goes into the folder, or compares the file that is selected",
               GLFW_KEY_ENTER,
               0,
               false,
               looks,
               {},
               [this, take] {
                 if (const auto found = postop_.browser()->open_selected()) take(*found);
               }});
  actions.add({"review.folder_up",
               "Folder above",
               "Goes to the folder that this one is in",
               GLFW_KEY_BACKSPACE,
               0,
               false,
               looks,
               {},
               [this] { postop_.browser()->up(); }});
  actions.add({"review.folder_home",
               "Home",
               "Goes to the user's own folder",
               GLFW_KEY_HOME,
               0,
               false,
               looks,
               {},
               [this] { postop_.browser()->home(); }});
  actions.add({"review.folder_take",
               "Compare this folder",
               "Looks for a CT in this folder and all that are in it, and compares it with the plan",
               GLFW_KEY_I,
               0,
               false,
               looks,
               {},
               [this, take] { take(std::filesystem::path(postop_.browser()->folder())); }});
  actions.add(
      {"review.folder_back", "Back", "Leaves the folders", GLFW_KEY_ESCAPE, 0, false, looks, {}, [this] {
         postop_.leave_browser();
       }});
}

void ReviewView::resume() {
  try {
    recording::take_back_declined_resume(open_->review.folder);
    open_->can_be_resumed = false;
    to_theatre_(open_->review.session->header.bone);
  } catch (const IoError& error) {
    notice_ = error.what();
  }
}

void ReviewView::add_resume_action(widgets::Actions& actions) {
  actions.add({"review.resume",
               "Resume",
               "Offers in Navigate to go on with this operation, which was declined there",
               GLFW_KEY_G,
               0,
               false,
               [this] { return open_ && open_->can_be_resumed; },
               {},
               [this] { resume(); }});
}

void ReviewView::add_actions(widgets::Actions& actions) {
  add_playing_actions(actions);
  add_mark_actions(actions);
  add_postop_actions(actions);
  add_folder_actions(actions);
  add_resume_action(actions);
  actions.add(
      {"review.today", "Today",
       "What today's program makes of the same pictures and commands, beside the screen; again to stop",
       GLFW_KEY_T, 0, false, [this] { return has_frames() && open_->pictures != nullptr; },
       [this] { return runs_today(); }, [this] { toggle_today(); }});
  actions.add(
      {"review.report",
       "Report",
       "Writes the report of this session, or of a CT after the operation, or else of the plan, as PDF "
       "into the plan's own folder within \"export\" of the case; it names nobody. Again to stop",
       GLFW_KEY_R,
       0,
       false,
       [this] { return is_writing_report() || no_report_reason().empty(); },
       [this] { return is_writing_report(); },
       [this] {
         if (is_writing_report()) return report_->stop();
         // It tells of what is on the disk: never of another plan than the one that is seen.
         no_report_ = model_ != nullptr ? model_->save_now() : std::string();
         if (!no_report_.empty()) return;
         report_ = std::make_unique<ReportRun>(
             case_folder_, model_ != nullptr ? cases::with_named_meshes(model_->knee()) : cases::Plan{},
             open_ ? open_->review.folder.filename().string() : "", wake_);
       },
       {},
       [this] { return no_report_reason(); }});
  actions.add({"review.newer",
               "Newer",
               "The session after this one",
               GLFW_KEY_UP,
               0,
               false,
               [this] { return chosen_ && *chosen_ > 0 && !browses(); },
               {},
               [this] { look_at(*chosen_ - 1); }});
  actions.add({"review.older",
               "Older",
               "The session before this one",
               GLFW_KEY_DOWN,
               0,
               false,
               [this] { return chosen_ && *chosen_ + 1 < sessions_.folders().size() && !browses(); },
               {},
               [this] { look_at(*chosen_ + 1); }});
}

}  // namespace arthronaut::review
