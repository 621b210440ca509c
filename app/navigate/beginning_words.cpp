#include "app/navigate/beginning_words.h"

#include "app/navigate/plan_words.h"
#include "navigation/camera/medium.h"
#include "planning/cases/case.h"
#include "planning/files/format.h"
#include "planning/files/local_time.h"
#include "planning/files/typed_number.h"
#include "planning/files/utc_clock.h"

namespace arthronaut::navigate {

namespace {

using widgets::Severity;

std::string plan_in_words(const std::optional<operation::PlannedTunnel>& plan) {
  if (!plan) return "none";
  const std::string which = plan->tunnel.bundle == norms::Bundle::Whole
                                ? ""
                                : "tunnel " + tunnels::name_of(plan->tunnel.key()) + ", ";
  return which + files::format("%.1f mm wide, %.1f mm long", plan->tunnel.diameter_mm, plan->length_mm);
}

Severity severity_of(const plan_review::TunnelVerdict& verdict) {
  return verdict.is_wrong() ? Severity::Bad : verdict.is_fine() ? Severity::Quiet : Severity::Caution;
}

// Behind the plan's own words.
std::string in_words(const plan_review::TunnelVerdict& verdict) {
  return verdict.is_fine()
             ? ""
             : (verdict.is_wrong() ? "; WRONG: " : "; check: ") + in_plain_words(verdict).in_short();
}

// All of it: what is confirmed was read.
std::string in_full(const plan_review::TunnelVerdict& verdict) {
  std::string words;
  const auto add = [&](const char* head, const std::vector<std::string>& reasons) {
    for (const std::string& reason : reasons) words += (&reason == &reasons.front() ? head : "; ") + reason;
  };
  const plan_review::TunnelVerdict plain = in_plain_words(verdict);
  add("; WRONG: ", plain.wrong);
  add("; check: ", plain.look);
  return words;
}

std::string plan_and_verdict(const std::optional<operation::PlannedTunnel>& plan,
                             const plan_review::TunnelVerdict& verdict) {
  return plan_in_words(plan) + in_words(verdict);
}

std::string count_of(std::size_t count, const std::string& what) {
  return std::to_string(count) + " " + what + (count == 1 ? "" : what == "touch" ? "es" : "s");
}

std::string ago(std::chrono::system_clock::duration time) {
  const auto minutes = std::chrono::duration_cast<std::chrono::minutes>(time).count();
  if (minutes < 0) return "at a time that this clock has not reached";
  if (minutes < 1) return "less than a minute ago";
  if (minutes < 120) return count_of(static_cast<std::size_t>(minutes), "minute") + " ago";
  if (minutes < 48 * 60) return std::to_string(minutes / 60) + " hours ago";
  return std::to_string(minutes / (24 * 60)) + " days ago";
}

// "21:03", as the clock on the wall shows it.
std::string clock_of(std::chrono::system_clock::time_point moment) {
  return files::local_time_in_words(files::utc_of(moment)).substr(11, 5);
}

CardLine medium_line(const operation::OperationState& state) {
  const std::string medium = camera::medium_to_text(state.source->pipeline.refractive_index);
  const bool is_wrong = state.medium.fit == pipeline::MediumFit::Contradicts;
  return {is_wrong ? Severity::Bad : Severity::Quiet, "Medium",
          is_wrong
              ? medium + ", but the markers look as in " + camera::medium_to_text(state.medium.other_index)
              : medium,
          CardLine::Topic::Medium};
}

CardLine registration_line(const recording::Resumable& left) {
  if (!left.operation.registration)
    return {Severity::Bad, "Registration", "is not brought back: " + left.refusal};
  return {Severity::Caution, "Registration",
          widgets::plus_minus(left.operation.registration->predicted_tre_mm) + " mm" +
              (left.was_verified ? ", was verified" : "") + "; guides after one touch on the bone"};
}

// By its number, as Review lists it: its day and time say nothing that "cut off 4 minutes ago" does not.
std::string session_in_words(const std::string& id) {
  const std::int64_t number = cases::session_number(id);
  return number > 0 ? std::to_string(number) : id;
}

// Of the probe's tip and the guide's axis, one that nobody measured.
bool has_nominal_tool(const pipeline::PipelineOptions& of) {
  const tools::Tool *const probe = of.tools.find_tool(of.probe_name), *const guide =
                                                                          of.tools.find_tool(of.guide_name);
  return (probe != nullptr && tools::nominal_parts(*probe).tip) ||
         (guide != nullptr && tools::nominal_parts(*guide).axis);
}

}  // namespace

bool is_fluid(double refractive_index) {
  return refractive_index > (camera::kAirIndex + camera::kWaterIndex) / 2;
}

std::vector<CardLine> time_out_lines(const operation::OperationState& state, const std::string& patient,
                                     const plan_review::TunnelVerdict& verdict) {
  const operation::SourceSetup& source = *state.source;
  using Topic = CardLine::Topic;
  return {
      {patient.empty() ? Severity::Caution : Severity::Quiet, "Patient",
       patient.empty() ? "not known: the case names none" : patient, Topic::Patient},
      {Severity::Quiet, "Knee",
       std::string(bones::to_text(source.pipeline.side)) + ", " + std::string(bones::to_text(state.bone)) +
           (verdict.side_note.empty() ? "" : "; " + verdict.side_note),
       Topic::Knee},
      {state.plan || !verdict.is_fine() ? severity_of(verdict) : Severity::Caution, "Plan",
       plan_and_verdict(state.plan, verdict), Topic::Plan},
      {has_nominal_tool(source.pipeline) ? Severity::Caution : Severity::Quiet, "Camera and tools",
       source.calibration, Topic::CameraAndTools},
      medium_line(state)};
}

// What is asked, and how it is answered, stands above it as the next step.
Card time_out_card(const operation::OperationState& state, const std::string& patient,
                   const plan_review::TunnelVerdict& verdict) {
  Card card{"navigate.time_out", "", time_out_lines(state, patient, verdict),
            std::string("V: in ") + (is_fluid(state.source->pipeline.refractive_index) ? "air" : "saline") +
                " instead"};
  for (CardLine& line : card.lines) {
    if (line.topic == CardLine::Topic::Plan) line.text = plan_in_words(state.plan) + in_full(verdict);
    if (line.topic != CardLine::Topic::CameraAndTools) continue;
    line.name.clear();  // its text names them
    line.text = state.source->calibration_in_short;
  }
  return card;
}

std::string words_of_edited(const std::optional<operation::PlannedTunnel>& edited,
                            const plan_review::TunnelVerdict& verdict) {
  return edited ? "now " + plan_and_verdict(edited, verdict) : "now none is planned";
}

Card resume_card(const LeftBehind& left, const std::optional<operation::PlannedTunnel>& plan,
                 const plan_review::TunnelVerdict& verdict, std::chrono::system_clock::time_point now) {
  const recording::Resumable& found = left.found;
  const operation::ResumeOperation& was = found.operation;
  Card card{"navigate.resume", "", {}, "Page up or Esc: begin afresh"};
  card.lines.push_back({Severity::Quiet, "Session",
                        session_in_words(was.session) + ", " +
                            std::string(bones::to_text(found.header.bone)) + ", " +
                            (found.was_finished ? "ended " : "cut off ") + ago(now - found.last_written)});
  card.lines.push_back(
      {Severity::Quiet, "Source",
       std::string(sources::to_text(found.header.source_kind.value())) + ": " + found.header.source});
  card.lines.push_back(registration_line(found));
  card.lines.push_back({Severity::Quiet, "Kept as history",
                        count_of(static_cast<std::size_t>(was.stroke_count), "stroke") +
                            files::format(" (%.0f mm), ", found.drawn_length_mm) +
                            count_of(was.touches_mm.size(), "touch") +
                            (was.control_point_mm ? ", the control point" : "")});
  const bool is_same_plan = was.plan == plan;
  card.lines.push_back(
      {is_same_plan || !verdict.is_fine() ? severity_of(verdict) : Severity::Caution, "Plan",
       plan_in_words(was.plan) + in_words(verdict) +
           (is_same_plan ? "" : "; the case's is another one by now and waits to be taken over")});
  for (const tunnels::TunnelKey& key : found.drilled) {
    const bool is_in_force = was.plan && was.plan->tunnel.key() == key;
    card.lines.push_back(
        {is_in_force ? Severity::Caution : Severity::Quiet, "Drilled already",
         tunnels::name_of(key) + (is_in_force ? "; that is the one in force: choose the other one" : "")});
  }
  for (const recording::SaidDrilled& said : found.said_drilled)
    card.lines.push_back(
        {Severity::Caution, "Said to be drilled",
         said.tunnel + ", at " + clock_of(said.when) + "; by word alone, nothing shows where"});
  card.lines.push_back({left.has_same_camera && left.has_same_tools ? Severity::Quiet : Severity::Caution,
                        "Camera and tools",
                        left.has_same_camera && left.has_same_tools ? "the case's"
                        : left.has_same_camera                      ? "the tools are not the case's of now"
                        : left.has_same_tools                       ? "the camera is not the case's of now"
                                                                    : "neither is the case's of now"});
  if (was.depth_stop_mm)
    card.lines.push_back(
        {Severity::Quiet, "Depth stop", files::format("%.1f mm, as read", *was.depth_stop_mm)});
  for (const std::string& broken : left.passed_over)
    card.lines.push_back({Severity::Bad, "Newer, cannot be read", broken});
  return card;
}

std::optional<double> depth_from_text(const std::string& text) {
  constexpr double kLongest_mm = 150;
  const auto depth_mm = files::typed_number(text, "mm");
  return depth_mm && *depth_mm >= 0 && *depth_mm <= kLongest_mm ? depth_mm : std::nullopt;
}

}  // namespace arthronaut::navigate
