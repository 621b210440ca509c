// How an operation begins: what is confirmed before anything guides, and what one that was cut off had come
// to.
#include "navigation/camera/medium.h"
#include "navigation/operation/operation_parts.h"
#include "planning/files/format.h"

namespace arthronaut::operation {

namespace {

// What stood on the screen, as the record keeps it: hashes, and no patient.
std::string in_words(const SourceSetup& source, const registration::Provenance& now,
                     const std::string& guides, const std::optional<PlannedTunnel>& plan,
                     bool patient_was_shown) {
  std::string text = std::string(bones::to_text(source.pipeline.side)) + " " +
                     std::string(bones::to_text(now.bone)) +
                     (patient_was_shown ? ", patient shown" : ", patient not known");
  const bool is_named = plan && plan->tunnel.bundle != norms::Bundle::Whole;
  if (is_named) text += ", tunnel " + tunnels::name_of(plan->tunnel.key());
  text +=
      plan ? files::format(", plan %.1f mm wide and %.1f mm long", plan->tunnel.diameter_mm, plan->length_mm)
           : std::string(", no plan");
  return text + ", mesh " + now.mesh_sha256.substr(0, 12) + ", camera " + now.camera.substr(0, 12) +
         ", tools " + now.tools.substr(0, 12) + ", guides " + guides.substr(0, 12) + ", " +
         camera::medium_to_text(now.refractive_index);
}

}  // namespace

void Operation::Parts::apply(const ConfirmTimeOut& time_out_of) {
  if (time_out() != TimeOut::Due) return;
  confirmed.confirm(ledger.now(), plan);
  std::string words =
      in_words(*source, ledger.now(), confirmed.guides_now(), plan, time_out_of.patient_was_shown);
  if (!time_out_of.beside.empty()) words = "BESIDE " + time_out_of.beside + "; " + words;
  note(JournalKind::TimeOutConfirmed, std::move(words));
}

// Held against the control point by the one guide that this source has; what it shows guides from the next
// frame on, or no more from this one.
void Operation::Parts::apply(const CheckGuide&) {
  if (holds_for_time_out() && guide_check.state().standing != GuideStanding::NotAsked) {
    touch = {TouchRefusal::TimeOutDue, true, frame.timestamp_ns};
    return;
  }
  draws = false;
  if (guide_check.state().standing == GuideStanding::NotAsked) return;
  touch = {TouchRefusal::NoSource, true, frame.timestamp_ns};
  if (!has_source) return;
  touch.refusal = guide_check.check(control_point_of_now_mm(), setup.limits);
  if (touch.refusal != TouchRefusal::None) return;
  const GuideCheckState& state = guide_check.state();
  note(JournalKind::GuideChecked,
       files::format("its tip lies %.1f mm from the control point", state.error_mm) +
           (state.may_guide() ? "" : files::format(", more than %.1f mm", setup.limits.max_guide_error_mm)));
  if (state.may_guide()) return;
  // What was seen of it was seen by wrong numbers.
  drilling.forget_guide();
  if (frame.guidance.is_valid()) hide_guide();
}

// Where the guide is held: none while the control point itself tells that the marker has moved.
std::optional<Eigen::Vector3d> Operation::Parts::control_point_of_now_mm() const {
  return ledger.alarm() ? std::nullopt : ledger.touches().control_point_mm(ledger.now());
}

// Each record says how the guide stands from its beginning on.
void Operation::Parts::note_guide_check() {
  const GuideCheckState& state = guide_check.state();
  if (state.standing == GuideStanding::Checked)
    note(JournalKind::GuideChecked,
         files::format("before this source: its tip lay %.1f mm from the control point", state.error_mm));
  if (state.standing == GuideStanding::Trusted)
    note(JournalKind::GuideChecked, "nominal, and nobody checked it");
}

void Operation::Parts::apply(const TrustGuide&) {
  if (guide_check.state().may_guide()) return;
  guide_check.trust();
  note_guide_check();
}

// Once, and before the first source: what is known of this operation by then is its plan.
void Operation::Parts::apply(const ResumeOperation& resume) {
  if (source != nullptr || resumed != nullptr) return;
  resumed = std::make_shared<const ResumeOperation>(resume);
  drilling.read_depth_stop(resume.depth_stop_mm);
  ledger.bring_back(resume.of, resume.touches_mm, resume.control_point_mm);
  if (resume.plan && resume.plan != plan) {
    // The one that guided then guides on; the case's, which is another one by now, waits to be taken over.
    offered = OfferPlan{plan, resume.moves_target};
    resumed_plan_waits = true;
    set_plan(resume.plan, resume.moves_target);
  }
  if (resume.registration) apply(GiveRegistration{*resume.registration, resume.registration_of, true});
  changed = true;
}

}  // namespace arthronaut::operation
