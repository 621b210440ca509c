#include <GLFW/glfw3.h>

#include <array>

#include "app/navigate/navigate_view.h"
#include "app/navigate/overlay_lines.h"
#include "app/navigate/picture_keeping.h"

namespace arthronaut::navigate {

void NavigateView::add_actions(widgets::Actions& actions) {
  const auto running = [this] { return is_running(); };
  const auto simulates = [this] { return can_simulate(); };
  actions.add({"navigate.next",
               "Next step",
               "Starts, registers, drills: whatever comes next",
               GLFW_KEY_SPACE,
               0,
               false,
               [this] { return model_ != nullptr; },
               {},
               [this] { take_next_step(); }});
  actions.add({"navigate.back", "Step back", "Goes back a step, to do it again with the next step's key",
               GLFW_KEY_PAGE_UP, 0, false, [this] { return model_ != nullptr; },
               [this] { return choices_.looked_at.has_value(); }, [this] { take_step_back(); }});
  actions.add({"navigate.menu", "Menu", "Everything that can be done here, and every state", GLFW_KEY_ENTER,
               0, false, [this] { return model_ != nullptr; }, [this] { return choices_.shows_menu; },
               [this] {
                 if (cameras_.is_open()) return take_next_step();
                 choices_.shows_menu = !choices_.shows_menu;
                 choices_.shows_more = false;
               }});
  actions.add({"navigate.more", "More", "Sources, window, and what can't be used now", GLFW_KEY_ENTER,
               GLFW_MOD_SHIFT, false, [this] { return choices_.shows_menu; },
               [this] { return choices_.shows_more; },
               [this] { choices_.shows_more = !choices_.shows_more; }});
  actions.add({"navigate.scratch",
               "Simulate: probe",
               "The simulated surgeon touches the bone with the probe",
               GLFW_KEY_S,
               0,
               false,
               simulates,
               [this] { return is_running() && holds_simulated_probe(); },
               [this] { start_simulation(SimulatedPart::Scratch); },
               {"start the simulation instead", running}});
  actions.add({"navigate.drill",
               "Simulate: drill",
               "The simulated surgeon aims the guide and drills",
               GLFW_KEY_G,
               0,
               false,
               simulates,
               [this] { return is_running() && started_.is_simulated(SimulatedPart::Drill); },
               [this] { start_simulation(SimulatedPart::Drill); },
               {"start the simulation instead", running}});
  actions.add({"navigate.video",
               "Video of the case",
               "Navigates on the next video in the case's folder",
               GLFW_KEY_O,
               0,
               false,
               [this] { return model_ != nullptr; },
               {},
               [this] { start_video(); },
               {"start the video instead", running}});
  actions.add({"navigate.stop",
               "Stop",
               "Ends the source",
               GLFW_KEY_ESCAPE,
               0,
               false,
               [this] { return is_under_way(*live_) || cameras_.is_open() || left_behind() != nullptr; },
               {},
               [this] {
                 if (cameras_.is_open()) return cameras_.close();
                 if (left_behind() != nullptr) return decline_resume();
                 end_source();
               },
               {"stop", [this] { return is_under_way(*live_) && !cameras_.is_open(); }}});
  // Of a source that gives none there is nothing to lose by a slip of the hand.
  const auto gives_pictures = [this] {
    return is_running() && !cameras_.is_open() && live_->trouble != theatre::SourceTrouble::NoPicture;
  };
  actions.add({"navigate.camera",
               "Camera",
               "Navigates with a camera that is connected, or with a stream",
               GLFW_KEY_K,
               0,
               false,
               [this] { return model_ != nullptr && model_->has_bone(choices_.bone); },
               [this] { return cameras_.is_open(); },
               [this] { choose_camera(); },
               {"choose a camera instead", gives_pictures}});
  actions.add({"navigate.address",
               "Type an address",
               "Of a stream, of a camera, or of an outside tracker that sees the tools (igtl://HOST:PORT)",
               GLFW_KEY_K,
               GLFW_MOD_SHIFT,
               false,
               [this] { return model_ != nullptr && model_->has_bone(choices_.bone); },
               {},
               [this] { type_address(); },
               {"choose a camera instead", gives_pictures}});
  actions.add({"navigate.digitise", "Probe draws",
               "While on, where the probe's tip goes is kept for the registration", GLFW_KEY_D, 0, false,
               [this] { return is_running() && !holds_for_time_out(*live_->operation); },
               [this] { return is_running() && live_->operation->draws; },
               [this] { ask(operation::Draw{!live_->operation->draws}); }});
  actions.add({"navigate.register",
               "Register",
               "Fits the bone to what the probe drew",
               GLFW_KEY_R,
               0,
               false,
               [this] { return registration().point_count > 0 && !registration().is_fitting; },
               {},
               [this] { ask(operation::RegisterStrokes{}); }});
  actions.add(
      {"navigate.record",
       "Record",
       "Keeps the video too, of this and every later source, a stream's from up to 20 s before; poses and "
       "decisions are kept in any case",
       GLFW_KEY_R,
       GLFW_MOD_CONTROL,
       false,
       running,
       [this] { return live_->keeps_video; },
       [this] { bones_.keep_video(!live_->keeps_video); },
       {"end the video's record", [this] { return live_->keeps_video; }}});
  actions.add({"navigate.overlay",
               "Plan on video",
               "Full, off; it fades by itself",
               GLFW_KEY_V,
               0,
               false,
               {},
               [this] { return choices_.overlay_on; },
               // While a camera or a tunnel is chosen, or the medium is confirmed, the third pedal goes on to
               // the next one.
               [this] {
                 if (cameras_.is_open()) return cameras_.choose_next_offered();
                 if (choices_.asked == Question::TimeOut) {
                   if (choices_.was_asked_for(theatre::LiveOperation::now_s(), kReadable_s))
                     take_other_medium();
                   return;
                 }
                 if (model_ != nullptr && bones_.must_choose(choices_.bone)) {
                   ++choices_.offered_tunnel;
                   return;
                 }
                 cycle_overlay();
               }});
  actions.add({"navigate.sounds",
               "Muted",
               "Lost, doubtful and reached are not heard while on; what is wrong with the sound device is "
               "said in the "
               "menu",
               GLFW_KEY_Y,
               0,
               false,
               {},
               [this] { return player_.is_muted(); },
               [this] { player_.mute(!player_.is_muted()); }});
  actions.add({"navigate.undistort",
               "Undistorted",
               "The picture without the lens' distortion: what is straight is straight",
               GLFW_KEY_U,
               0,
               false,
               {},
               [this] { return choices_.undistorts; },
               [this] { choices_.undistorts = !choices_.undistorts; }});
  actions.add({"navigate.bone",
               "Other bone",
               "Navigate on the other bone",
               GLFW_KEY_TAB,
               0,
               false,
               [this] { return model_ != nullptr && model_->has_bone(choices_.other_bone()); },
               {},
               [this] { take_other_bone(); }});
  actions.add({"navigate.medium",
               "Next: saline",
               "The next video or camera looks through saline while on, through air while off; the source "
               "that runs keeps its medium",
               GLFW_KEY_M,
               0,
               false,
               {},
               [this] { return choices_.saline; },
               [this] { choices_.saline = !choices_.saline; }});
  add_tunnel_actions(actions);
  add_registration_actions(actions);
  add_answer_actions(actions);
  add_picture_actions(actions);
}

// The command line's --pictures.
void NavigateView::add_picture_actions(widgets::Actions& actions) {
  using recording::PicturesAs;
  struct Way {
    PicturesAs as;
    const char *id, *label, *tooltip;
    int key;
  };
  constexpr std::array kWays{
      Way{PicturesAs::AsTheyCame, "navigate.pictures_as_came", "Keep as it came",
          "Record keeps a stream's video as it came, any other without loss; from the next source on",
          GLFW_KEY_1},
      Way{PicturesAs::Lossless, "navigate.pictures_lossless", "Keep lossless",
          "Record keeps every video without loss, in much room; from the next source on", GLFW_KEY_2},
      Way{PicturesAs::H264, "navigate.pictures_h264", "Keep as H.264",
          "Record keeps video in far less room; replayed, poses differ slightly; from the next source on",
          GLFW_KEY_3}};
  for (const Way& way : kWays)
    actions.add({way.id,
                 way.label,
                 way.tooltip,
                 way.key,
                 GLFW_MOD_CONTROL,
                 false,
                 {},
                 [this, as = way.as] { return bones_.pictures_as() == as; },
                 [this, as = way.as] {
                   save_picture_keeping(picture_keeping_file(), as);
                   bones_.keep_pictures_as(as);
                 }});
}

void NavigateView::add_answer_actions(widgets::Actions& actions) {
  actions.add({"navigate.depth_stop", "Depth stop",
               "Keeps what the drill's depth stop reads: type the millimetres, then Enter", GLFW_KEY_E, 0,
               false, [this] { return is_running(); }, [this] { return depth_.is_open(); },
               [this] {
                 choices_.shows_menu = false;  // it would stand over the field
                 depth_.open();
               }});
  actions.add({"navigate.marker_anew",
               "Marker anew",
               "The world marker was taken off or placed elsewhere: all that rests on it is void",
               GLFW_KEY_N,
               0,
               false,
               [this] { return is_running() || !registration().history->empty(); },
               {},
               [this] { ask(operation::MarkerPlacedAnew{}); },
               {"say that the marker was placed anew"}});
  actions.add({"navigate.drilled",
               "Tunnel drilled",
               "The tunnel is drilled, also where nothing of it was seen: then it is recorded as said",
               GLFW_KEY_J,
               0,
               false,
               // Also of pictures that have ended: the record of what they showed takes it in.
               [this] {
                 const bool were_there = live_->picture != nullptr && !is_under_way(*live_);
                 return (is_running() || were_there) && live_->operation->plan.has_value();
               },
               {},
               [this] { ask(operation::TunnelDrilled{}); },
               {"say that the tunnel is drilled"}});
}

void NavigateView::add_registration_actions(widgets::Actions& actions) {
  const auto has_tip = [this] { return is_running(); };
  const auto has_drawn = [this] { return registration().point_count > 0; };
  const auto select = [this](int step) {
    choices_.stroke = neighbour_stroke(words_.strokes, choices_.stroke, step);
  };
  actions.add({"navigate.panel", "Registration", "Shows the registration or the way to the plan", GLFW_KEY_H,
               0, false, [this] { return model_ != nullptr; },
               [this] { return layout(theatre::LiveOperation::now_s()) == NavigateLayout::Register; },
               [this] {
                 choices_.layout = layout(theatre::LiveOperation::now_s()) == NavigateLayout::Register
                                       ? NavigateLayout::Guide
                                       : NavigateLayout::Register;
               }});
  actions.add({"navigate.take_back",
               "Take back",
               "Forgets the stroke drawn last",
               GLFW_KEY_BACKSPACE,
               0,
               false,
               has_drawn,
               {},
               [this] { ask(operation::TakeBackStroke{}); },
               {"forget the last stroke"}});
  actions.add({"navigate.stroke_up",
               "Newer stroke",
               "Selects the stroke drawn after this one",
               GLFW_KEY_UP,
               0,
               true,
               has_drawn,
               {},
               [select] { select(1); }});
  actions.add({"navigate.stroke_down",
               "Older stroke",
               "Selects the stroke drawn before this one",
               GLFW_KEY_DOWN,
               0,
               true,
               has_drawn,
               {},
               [select] { select(-1); }});
  actions.add(
      {"navigate.exclude", "Exclude", "Takes the selected stroke out of the fit, or back in", GLFW_KEY_X, 0,
       false, [this] { return neighbour_stroke(words_.strokes, choices_.stroke, 0) >= 0; },
       [this] { return registration().excluded.contains(choices_.stroke); },
       [this] {
         choices_.stroke = neighbour_stroke(words_.strokes, choices_.stroke, 0);
         ask(operation::ExcludeStroke{choices_.stroke, !registration().excluded.contains(choices_.stroke)});
       }});
  actions.add({"navigate.touch",
               "Verify touch",
               "Measures how far the tip is from the bone, here; not used in the fit",
               GLFW_KEY_T,
               0,
               false,
               has_tip,
               {},
               [this] { take_touch(false); }});
  actions.add(
      {"navigate.control_point", "Control point",
       "A mark on the bone: touched first it is kept, later it tells whether the world marker has moved",
       GLFW_KEY_P, 0, false, has_tip, [this] { return registration().touches.has_control_point(); },
       [this] { take_touch(true); }});
  actions.add(
      {"navigate.check_guide",
       "Check guide",
       "The guide's tip rests on the control point: a nominal guide guides live only when it is there",
       GLFW_KEY_A,
       0,
       false,
       [this] {
         return is_running() && live_->operation->guide_check.standing != operation::GuideStanding::NotAsked;
       },
       {},
       [this] { ask(operation::CheckGuide{}); }});
  actions.add({"navigate.forget_touches",
               "Forget touches",
               "Touches, control point or picture were wrong, not the marker: takes an alarm away",
               GLFW_KEY_T,
               GLFW_MOD_SHIFT,
               false,
               [this] {
                 const operation::RegistrationState& known = registration();
                 return known.touches.count() > 0 || known.touches.has_control_point() || known.alarm;
               },
               {},
               [this] { ask(operation::ForgetTouches{}); },
               {"forget the touches"}});
  actions.add({"navigate.clear",
               "Clear points",
               "Forgets what the probe drew and the touches; after an alarm the registration too",
               GLFW_KEY_C,
               0,
               false,
               [this] { return registration().point_count > 0 || registration().alarm; },
               {},
               [this] { ask(operation::ClearStrokes{}); },
               {"clear the points"}});
  actions.add({"navigate.earlier",
               "Earlier",
               "Goes back to the registration before",
               GLFW_KEY_LEFT,
               0,
               false,
               [this] { return registration().entry_in_force.value_or(0) > 0; },
               {},
               [this] { ask(operation::ChooseRegistration{*registration().entry_in_force - 1}); }});
  actions.add({"navigate.later",
               "Later",
               "Goes on to the registration after",
               GLFW_KEY_RIGHT,
               0,
               false,
               [this] {
                 return registration().entry_in_force &&
                        *registration().entry_in_force + 1 < registration().history->size();
               },
               {},
               [this] { ask(operation::ChooseRegistration{*registration().entry_in_force + 1}); }});
}

float NavigateView::overlay_opacity(double now_s) const {
  if (!choices_.overlay_on) return 0;
  return navigate::overlay_opacity(now_s - choices_.overlay_shown_at_s);
}

void NavigateView::cycle_overlay() {
  const double now = theatre::LiveOperation::now_s();
  const bool is_full = choices_.overlay_on && overlay_opacity(now) > 0.99F;
  choices_.overlay_on = !is_full;
  choices_.overlay_shown_at_s = now;
}

}  // namespace arthronaut::navigate
