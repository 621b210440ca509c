// Inner header: the state of an operation and what changes it, for operation.cpp (what comes in) and
// operation_rules.cpp (what follows from it).
//
// What an operation knows is true of something: a picture, a source, a plan, a registration, the marker where
// it sits. It ends with that, in the class that holds it and by a member that says so (on_source(),
// on_plan(), ...). The whole of it, which what_ends_test.cpp walks over; x: it ends.
//
//   S  a source begins: live, of the same camera, tools and medium as the one before
//   O  the same, of something else: another medium
//   E  the source ends
//   P  another plan is taken over
//   R  another registration comes into force
//   C  strokes are cleared, without an alarm
//   A  they are cleared in an alarm
//   M  the marker is placed anew
//   W  a picture is through the wrong medium
//   D  and it is known that the pictures of this source have been since before all of that
//   L  the marker was out of sight for long: the scope went to another port
//
//   what                              | S O E P R C A M W D L
//   numbers of the newest picture     | x x x x x . x x x x x
//   guidance a moment ago             | x x x x x . x x . . x
//   how good the numbers are          | x x x x x . x x x x x
//   what was seen of guide and drill  | x x . x x . x x x x .
//   what the depth stop reads         | . . . x . . x x . . .
//   the word that it is drilled       | x x . x . . x x . . .
//   a registration that stands        | . x . . . . x x . . .
//   that touches verified it          | . x . . . x x x . x .
//   the same, without a control point | x x . . . x x x . x x
//   touches                           | . . . . . x x x . x .
//   the control point                 | . . . . . x x x . x .
//   that the bone looks otherwise     | x x x . x . x x . . .
//   strokes                           | . x . . . x x x . x .
//   which strokes were tried          | . x . x . x x x . x .
//   what is found while drawing       | . x . . . x x x . x .
//   the time-out's confirmation       | . x . x . . . . . . .
//   the check of a nominal guide      | . x . . . . . . . x .
//   why no touch was taken            | x x . . . . . . . . .
//   that the probe draws              | x x x x . . . . . . .
//
// Without a control point nothing of before can tell whether a marker that nobody saw sits where it sat; with
// one, it is to be touched (place_doubt.h).
// The probe draws again by itself where the source that begins says so and no registration stands, once its
// time-out is confirmed. Another registration is verified at once where touches lie on the bone by it, too.
// The word that the marker is out stands without a registration: it ends with S, O and M, where a live source
// shows the marker, and where the tunnel is said not to be drilled (marker_out_test.cpp).
// Of what a registration is of (another mesh, camera, probe, kind of source: as O), see
// registration_ledger.h.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "navigation/operation/bone_watch.h"
#include "navigation/operation/confirmed_time_out.h"
#include "navigation/operation/drilling.h"
#include "navigation/operation/guidance_grades.h"
#include "navigation/operation/guide_check.h"
#include "navigation/operation/in_view.h"
#include "navigation/operation/medium_watch.h"
#include "navigation/operation/operation.h"
#include "navigation/operation/place_doubt.h"
#include "navigation/operation/stroke_bias.h"
#include "navigation/operation/stroke_fit.h"
#include "navigation/worker/recycler.h"

namespace arthronaut::operation {

struct Operation::Parts {
  explicit Parts(OperationSetup with)
      : setup(std::move(with)),
        ledger(setup.surface, setup.cartilage, setup.limits),
        plan(setup.plan),
        bone_watch(setup.surface.get()) {}

  void note(JournalEntry entry) {
    entry.after_frame = frame_count > 0 ? frame.frame_index : -1;
    entry.timestamp_ns = frame_count > 0 ? frame.timestamp_ns : 0;
    journal.push_back(std::move(entry));
    changed = true;
  }
  void note(JournalKind kind, std::string text = "") { note(entry_of(kind, std::move(text))); }
  void ask(RegistrationRequest request) {
    requests.push_back(std::move(request));
    ++request_count;
  }

  void follow_ledger();
  void hand_registration();
  void note_in_force(bool is_given);
  void note_plan() {
    JournalEntry entry = entry_of(JournalKind::Plan);
    entry.plan = plan;
    note(std::move(entry));
  }
  void set_plan(const std::optional<PlannedTunnel>& next, bool moves_target);
  void take_offered() {
    const OfferPlan taken = *std::exchange(offered, std::nullopt);
    set_plan(taken.plan, taken.moves_target);
  }
  void check_medium();
  void take_look(const MediumLookPtr& look);
  void follow_medium(pipeline::MediumFit before);
  void hold_for_medium();
  void take_frame();
  void watch_bone(const camera::Frame& picture) {
    bone_watch.look(picture, frame, source->pipeline.tools, ledger.in_force(), setup.hears_of_drifts);
  }
  // What the last pictures showed and is not in force yet.
  void take_seen();
  void take_medium();
  void draw_tip();
  void watch_guidance();
  void look_for_registration();
  void register_strokes();
  void clear_strokes();
  // Nothing that was found by the marker holds where it sits now; as the record is to say why.
  void find_anew(std::string why);
  void take_touch(bool is_control_point);
  [[nodiscard]] std::optional<std::size_t> guide_in_view() const;
  [[nodiscard]] std::optional<Eigen::Vector3d> control_point_of_now_mm() const;
  [[nodiscard]] ControlPointDue control_point_due() const;
  [[nodiscard]] bool guided_lately() const { return has_source && in_view.guided_lately(frame.timestamp_ns); }
  [[nodiscard]] int places_in_doubt() const;
  // Whether anything is known that is wrong where the marker sits elsewhere by now.
  [[nodiscard]] bool rests_on_marker() const;
  void marker_may_have_moved();
  void look_for_end_of_loss();
  [[nodiscard]] Verification verification() const;
  [[nodiscard]] TimeOut time_out() const { return confirmed.standing(source.get(), ledger.now(), plan); }
  [[nodiscard]] bool holds_for_time_out() const {
    return has_source && source->time_out_first && time_out() == TimeOut::Due;
  }
  [[nodiscard]] bool is_live() const { return has_source && source->kind == sources::SourceKind::Live; }
  void hide_guidance(guidance::GuidanceState reason);
  void hide_guide();
  void end_frame();
  [[nodiscard]] RegistrationStatePtr registration_state();

  void apply(const Draw& draw) { draws = has_source && draw.on; }
  void apply(const TakeTouch&) { take_touch(false); }
  void apply(const TouchControlPoint&) { take_touch(true); }
  void apply(const ForgetTouches&) {
    bone_watch.look_anew();
    ledger.forget_touches();
  }
  void apply(const TakeBackStroke&) {
    ask(StrokesTakenBack{strokes.take_back()});
    fit.on_strokes_gone();
  }
  void apply(const ExcludeStroke& exclude) {
    strokes.exclude(exclude.curve, exclude.is_excluded);
    ask(StrokeExclusion{exclude.curve, exclude.is_excluded});
    fit.on_strokes_excluded();
  }
  void apply(const ClearStrokes&) {
    if (ledger.alarm()) return find_anew("all was cleared in an alarm");
    clear_strokes();
    ledger.forget_touches();
  }
  void apply(const RegisterStrokes&) { register_strokes(); }
  void apply(const ChooseRegistration& choose) { ledger.choose(choose.entry); }
  void apply(const OfferPlan& offer);
  void apply(const TakePlanOver& take) {
    if (!offered) return;
    take_offered();
    resumed_plan_waits = false;
    if (!take.asks_time_out) confirmed.on_plan_taken_over(plan);
  }
  void apply(const SkipVerification&) { skip_verification("asked for"); }
  void apply(const MarkerPlacedAnew&) { find_anew("the world marker was placed anew"); }
  void apply(const MarkerOut& out);
  void apply(const ReadDepthStop& stop) { drilling.read_depth_stop(stop.depth_mm); }
  void apply(const TunnelDrilled& drilled) {
    if (auto entry = drilling.say_drilled(plan, setup.surface.get(), drilled.without_picture_s))
      note(std::move(*entry));
  }
  void apply(const TakeBackDrilled&) {
    marker_is_out = false;  // it is wanted again
    if (auto entry = drilling.take_back(plan)) note(std::move(*entry));
  }
  void apply(const GiveRegistration& give);
  void apply(const ConfirmTimeOut& time_out);
  void apply(const CheckGuide&);
  void apply(const TrustGuide&);
  void apply(const ResumeOperation& resume);
  void skip_verification(const std::string& how);
  void note_guide_check();

  OperationSetup setup;
  RegistrationLedger ledger;
  StrokeBook strokes;
  registration::Provenance strokes_of;  // what the strokes were drawn under
  std::size_t set_aside_count = 0;
  SteadyTip tip;

  std::shared_ptr<const SourceSetup> source;
  std::unique_ptr<pipeline::NavigationPipeline> pipeline;
  bool has_source = false, draws = false;
  pipeline::FrameResult frame;
  PictureTiming timing = PictureTiming::InTime;  // of that frame
  std::int64_t frame_count = 0;

  OutcomePtr outcome;  // the newest that was taken in
  std::shared_ptr<const registration::OnlineResult> online;
  StrokeFit fit;
  StrokeBias stroke_bias;
  std::string why_none;        // is in force any more
  bool marker_is_out = false;  // by the surgeon's word, and no live source has shown it since

  std::optional<PlannedTunnel> plan;
  std::optional<OfferPlan> offered;
  bool resumed_plan_waits = false;  // what is offered is the case's, asked for even when a source starts
  std::optional<std::size_t> skipped_entry;  // of the ledger: it guided without a touch
  struct Asked {  // the last touch, check of the guide, or word that the marker is out
    TouchRefusal refusal = TouchRefusal::None;
    bool is_of_guide = false;
    std::int64_t time_ns = 0;
  } touch;
  GuideCheck guide_check;
  InView in_view;
  PlaceDoubt loss;  // the marker was out of sight for long, or between two live sources
  HeldGrades grades;
  MediumWatch medium;
  std::optional<SeenMedium> seen_medium;  // contradicted, and not in force yet
  BoneWatch bone_watch;
  Drilling drilling;
  ConfirmedTimeOut confirmed;
  std::shared_ptr<const ResumeOperation> resumed;  // null: nothing was

  // The ledger as it was told of last.
  struct Followed {
    std::uint64_t change = 0;
    Standing standing = Standing::None;
    std::optional<std::size_t> entry;
    bool is_verified = false;
    std::optional<std::size_t> verified_entry;  // that the journal says is verified, whatever stands now
  } followed;
  std::vector<RegistrationRequest> requests;
  std::uint64_t request_count = 0;
  std::vector<JournalEntry> journal;

  bool changed = true;  // something but the frame, since the last snapshot
  RegistrationStatePtr published_registration;
  std::uint64_t revision = 0;
  // One a frame: whoever holds one holds it alone, and what all have let go is written over.
  worker::Recycler<OperationState> states{[](OperationState& state) {
    state.source = nullptr;
    state.registration = nullptr;
    state.resumed = nullptr;
  }};
};

}  // namespace arthronaut::operation
