// Inner header: the state of an operation and what changes it, for operation.cpp (what comes in) and
// operation_rules.cpp (what follows from it).
#pragma once

#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "navigation/contour/contour_check.h"
#include "navigation/contour/covered.h"
#include "navigation/guidance/drill_evidence.h"
#include "navigation/guidance/registration_bias.h"
#include "navigation/operation/guide_check.h"
#include "navigation/operation/operation.h"
#include "navigation/pipeline/medium_check.h"
#include "navigation/worker/recycler.h"

namespace arthronaut::operation {

struct Operation::Parts {
  explicit Parts(OperationSetup with)
      : setup(std::move(with)), ledger(setup.surface, setup.cartilage, setup.limits), plan(setup.plan) {
    if (setup.surface != nullptr) contour.check.emplace(setup.surface->mesh());
  }

  void note(JournalEntry entry) {
    entry.after_frame = frame_count > 0 ? frame.frame_index : -1;
    entry.timestamp_ns = frame_count > 0 ? frame.timestamp_ns : 0;
    journal.push_back(std::move(entry));
    changed = true;
  }
  void note(JournalKind kind, std::string text = "") { note(entry_of(kind, std::move(text))); }
  static JournalEntry entry_of(JournalKind kind, std::string text) {
    JournalEntry entry;
    entry.kind = kind;
    entry.text = std::move(text);
    return entry;
  }
  void ask(RegistrationRequest request) {
    requests.push_back(std::move(request));
    ++request_count;
  }

  void follow_ledger();
  void hand_registration();
  void note_in_force(bool is_given);
  void note_plan() {
    JournalEntry entry = entry_of(JournalKind::Plan, "");
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
  void take_frame();
  void check_contour(const camera::Frame& picture);
  void take_drift();
  void end_contour();
  void look_anew();
  void expect_pictures(const Eigen::Vector2i& size_px);
  void draw_tip();
  void watch_marker();
  void watch_guidance();
  void look_for_registration();
  void register_strokes();
  void strokes_changed() { fitting.is_wanted = false; }
  void clear_strokes();
  void take_touch(bool is_control_point);
  [[nodiscard]] std::optional<std::size_t> guide_in_view() const;
  [[nodiscard]] std::optional<Eigen::Vector3d> control_point_of_now_mm() const;
  [[nodiscard]] ControlPointDue control_point_due() const;
  [[nodiscard]] bool guided_lately() const;
  [[nodiscard]] int places_in_doubt() const;
  [[nodiscard]] Verification verification() const;
  [[nodiscard]] TimeOut time_out() const;
  void hide_guidance(guidance::GuidanceState reason);
  void end_frame();
  [[nodiscard]] std::optional<guidance::RegistrationBias> bias() const;
  [[nodiscard]] RegistrationStatePtr registration_state();

  void apply(const Draw& draw) { draws = has_source && draw.on; }
  void apply(const TakeTouch&) { take_touch(false); }
  void apply(const TouchControlPoint&) { take_touch(true); }
  void apply(const ForgetTouches&) {
    look_anew();
    ledger.forget_touches();
  }
  void apply(const TakeBackStroke&) {
    ask(StrokesTakenBack{strokes.take_back()});
    strokes_changed();
  }
  void apply(const ExcludeStroke& exclude) {
    strokes.exclude(exclude.curve, exclude.is_excluded);
    ask(StrokeExclusion{exclude.curve, exclude.is_excluded});
    strokes_changed();
  }
  void apply(const ClearStrokes&) {
    const bool marker_has_moved = static_cast<bool>(ledger.alarm());
    clear_strokes();
    if (marker_has_moved) return ledger.marker_placed_anew();
    ledger.forget_touches();
  }
  void apply(const RegisterStrokes&) { register_strokes(); }
  void apply(const ChooseRegistration& choose) { ledger.choose(choose.entry); }
  void apply(const OfferPlan& offer);
  void apply(const TakePlanOver&) {
    if (!offered) return;
    take_offered();
    resumed_plan_waits = false;
    confirmed_plan = plan;  // that it is the right one was just said
  }
  void apply(const SkipVerification&) { skip_verification("asked for"); }
  void apply(const MarkerPlacedAnew&) {
    clear_strokes();
    drilling.drilled = {};
    drilling.depth_stop_mm.reset();
    ledger.marker_placed_anew();
  }
  void apply(const ReadDepthStop& stop) { drilling.depth_stop_mm = stop.depth_mm; }
  void apply(const TunnelDrilled&);
  void apply(const TakeBackDrilled&);
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
  std::int64_t frame_count = 0;

  OutcomePtr outcome;  // the newest that was taken in
  std::shared_ptr<const registration::OnlineResult> online;
  // The registration of all strokes.
  struct Fitting {
    int number = 0;  // of the newest that was asked for
    std::uint64_t request = 0;
    double length_mm = 0;         // of the strokes it was asked of
    std::size_t point_count = 0;  // that were drawn then, and the strokes that were not used
    std::set<int> excluded;
    bool is_under_way = false, is_wanted = false;
    std::int64_t looked_ns = 0;
  } fitting;
  // How the registration that strokes give follows the errors of probe and camera; by stroke.
  std::map<int, guidance::BiasSums> bias_of_stroke;

  std::optional<PlannedTunnel> plan;
  std::optional<OfferPlan> offered;
  bool resumed_plan_waits = false;  // what is offered is the case's, asked for even when a source starts
  std::optional<std::size_t> skipped_entry;  // of the ledger: it guided without a touch
  struct Asked {                             // the last touch, or check of the guide
    TouchRefusal refusal = TouchRefusal::None;
    bool is_of_guide = false;
    std::int64_t time_ns = 0;
  } touch;
  GuideCheck guide_check;
  // What was in view, and when the control point was touched last; of the source.
  struct InView {
    std::int64_t world_ns = 0, control_touched_ns = 0;
    // When the control point was touched first; of a source before this one: before all of its frames.
    std::int64_t control_set_ns = std::numeric_limits<std::int64_t>::min();
    std::optional<std::int64_t> guided_ns;  // the newest picture that guided, by the registration in force
    bool world_was_seen = false, was_lost_for_long = false, guide_was_seen = false;
  } in_view;
  struct Medium {
    std::optional<pipeline::MediumCheck> check;
    std::uint64_t source_number = 0;
    std::optional<MediumLookRequest> request;
    std::optional<std::int64_t> awaited;  // the frame whose picture is being seen again
  } medium;
  struct Contour {
    std::optional<contour::ContourCheck> check;  // empty: there is no surface to look for
    std::uint64_t change = 0;                    // of the ledger, when it was begun
    contour::CoveredPlaces covered;
    std::vector<std::uint8_t> luma;  // of pictures that have none of their own
    // Told by the newest picture: in force with the next one, between the two, as everything that a run from
    // the record alone has to hear of.
    std::optional<SeenDrift> drift;
    std::optional<SeenLooks> looks;
    // In force: it does not look as it did; whether a control point was set while it was seen to lie where it
    // lay; and how many touches there were then.
    bool is_in_doubt = false, doubt_has_control_point = false;
    std::size_t touches_before_doubt = 0;
    bool begins_anew = false;  // what it looks like now is how it looks
  } contour;
  struct Drilling {
    std::optional<guidance::DrillEvidence> evidence;  // of the plan in force
    bool evidence_is_seen = false;
    std::int64_t looked_ns = 0;
    std::optional<double> depth_stop_mm;
    DrilledState drilled;
  } drilling;
  // What the time-out was confirmed of; empty: not yet.
  std::optional<registration::Provenance> confirmed;
  std::optional<PlannedTunnel> confirmed_plan;
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
