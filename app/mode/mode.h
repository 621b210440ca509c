// One mode of the workstation as the window sees it. The window holds a list of these and knows nothing else
// of them: another mode is another entry of that list.
//
// A life: add_actions() once; case_opened() whenever another case is open; then enter(), draw() in every
// frame while it is shown, leave(). tick() is called in every frame once a case is open, shown or not.
// Threads: all of it on the window's thread, none of it waits.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "app/case/plan_model.h"
#include "app/widgets/controls.h"
#include "navigation/sources/frame_source.h"

namespace arthronaut::mode {

struct ModeTitle {
  std::string_view name;     // "navigate": in the list of states
  std::string_view action;   // "mode.navigate": the id of the action that shows it
  std::string_view label;    // "Navigate"
  std::string_view tooltip;  // "In theatre"
  int key = 0;               // GLFW_KEY_*, shows it
};

// The case that is open. The model outlives every use of it, until the next case_opened().
struct OpenCase {
  open_case::PlanModel* model = nullptr;  // not null
  std::filesystem::path folder;
  // Why nothing may be written into the case ("is open elsewhere: ..."): no plan, no set-up, no session.
  // Empty where it may.
  std::string read_only = {};
  // Whoever had it open last ended without closing it, as by a crash: since when it was open there, in UTC.
  std::string left_by_crash_since = {};
};

// Keys that do something for as long as they are down, and are no actions.
struct HeldKeys {
  std::string keys, words;
};

class Mode {
 public:
  virtual ~Mode() = default;
  [[nodiscard]] virtual ModeTitle title() const = 0;
  // Whether the mode is of use in a case that is read-only; one that is not cannot be entered there.
  [[nodiscard]] virtual bool works_read_only() const { return true; }
  // Called once, before any case is open. They live as long as this mode.
  virtual void add_actions(widgets::Actions& actions) = 0;
  // What the ids of the actions start with whose keys work while this mode is shown.
  [[nodiscard]] virtual std::vector<std::string_view> action_prefixes() const = 0;

  // Of what is shown now, for the list of keys.
  [[nodiscard]] virtual std::vector<HeldKeys> held_keys() const { return {}; }

  // Another case: ends what runs on the one before and forgets it.
  virtual void case_opened(const OpenCase& opened) = 0;
  virtual void enter() {}  // comes to the front
  virtual void leave() {}  // another mode comes to the front, or the program ends
  // The window's list of keys lies over it, or no more: told in every frame that it is in front, before
  // tick().
  virtual void cover(bool /*is_covered*/) {}
  virtual void tick(double /*now_s*/) {}  // once a frame, shown or not, before anything is drawn
  virtual void draw(const widgets::Ui& ui, const widgets::Rect& area) = 0;
  // What draw() made last stands on the screen now. Called after every frame while the mode is in front, also
  // where a page of the window covered it.
  virtual void on_screen() {}

  // Where in the window this mode wants what every screen must say (where the pictures come from, whose knee
  // it is): it takes the whole window then, and there are no bars. nullopt: it is content with what the bars
  // leave.
  [[nodiscard]] virtual std::optional<widgets::Rect> header_in(const widgets::Ui& /*ui*/,
                                                               const widgets::Rect& /*window*/) const {
    return std::nullopt;
  }

  // While true the screen must be drawn again soon: pictures or a result are to come, or something moves.
  [[nodiscard]] virtual bool is_busy() const { return false; }
  // Live pictures are looked at too late to guide: the screen leaves them more of the processor's time.
  [[nodiscard]] virtual bool pictures_are_late() const { return false; }
  // Something that a crash cut off waits for an answer that stands on this mode's screen: it comes to the
  // front without being asked for, once after a case was opened. Asked in every frame until then.
  [[nodiscard]] virtual bool asks_for_front() { return false; }
  // Something runs that the end of the program would cut off: ending it is then guarded.
  [[nodiscard]] virtual bool has_running_work() const { return false; }
  // A text field was opened in this frame and has not the keyboard yet.
  [[nodiscard]] virtual bool awaits_text() const { return false; }
  // The kind of the source whose pictures are shown or waited for; nullopt: none.
  [[nodiscard]] virtual std::optional<sources::SourceKind> source_kind() const { return std::nullopt; }
  // Whether what is shown of a live source is what it sees now: not the last picture of one that has ended,
  // has failed, or gives none.
  [[nodiscard]] virtual bool pictures_are_of_now() const { return true; }
  // One line for the status bar; empty when there is nothing to say.
  [[nodiscard]] virtual std::string notice() const { return {}; }
};

}  // namespace arthronaut::mode
