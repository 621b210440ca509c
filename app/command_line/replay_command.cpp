#include <memory>

#include "app/command_line/command.h"
#include "app/command_line/named_session.h"
#include "app/command_line/option_checks.h"
#include "app/command_line/tracking_report.h"
#include "navigation/camera/calibration_words.h"
#include "navigation/guidance/guidance_counts.h"
#include "navigation/recording/cut_short.h"
#include "navigation/recording/recording_lock.h"
#include "navigation/recording/replay.h"
#include "navigation/recording/session_check.h"
#include "planning/files/atomic_file.h"
#include "planning/files/csv_cell.h"

namespace arthronaut::command_line {

namespace {

struct ReplayArguments {
  std::string case_folder, session, output;
};

std::string line_of(const recording::Difference& difference) {
  const std::string where = difference.frame < 0 ? "session" : "frame " + std::to_string(difference.frame);
  if (difference.unit.empty()) return where + ": " + difference.what + ": " + difference.detail;
  return where + ": " + difference.what + ": " + format("%.6f ", difference.amount) + difference.unit;
}

std::string table_of(const std::vector<recording::Difference>& differences) {
  std::string text = "frame,what,amount,unit,detail\n";
  for (const recording::Difference& d : differences) {
    text += (d.frame < 0 ? "" : std::to_string(d.frame)) + "," + files::csv_cell(d.what) + "," +
            (d.unit.empty() ? "" : format("%.9g", d.amount)) + "," + d.unit + "," +
            files::csv_cell(d.detail) + "\n";
  }
  return text;
}

// What there is to say of a session that was run again, beside its differences.
void say_result(const Context& context, const recording::RecordedSession& session,
                const recording::ReplaySummary& summary) {
  context.say(format("session %s: %ld of %ld frames replayed", session.header().id.c_str(),
                     summary.replayed_frames, summary.recorded_frames));
  if (const auto& camera = session.pipeline_options().calibrated)
    context.say("camera: " + camera::in_words(*camera));
  if (const std::string cut = recording::cut_short_in_words(session.was_finished(), session.events(),
                                                            recording::is_being_recorded(session.folder()));
      !cut.empty())
    context.say("the recording was cut short: " + cut);
  if (summary.frames_without_picture > 0)
    context.say(format("%ld frames have no picture: what was decided on them was run again from the record",
                       summary.frames_without_picture));
  for (const recording::SessionEvent& event : session.events())
    if (event.kind == recording::kPicturesKeptEvent) context.say("pictures: " + event.text);
  if (summary.states_compared > 0)
    context.say(format("states the same to the last bit: %ld of %ld%s", summary.states_equal,
                       summary.states_compared,
                       summary.is_lossy        ? " (pictures were kept as H.264, which changes them slightly)"
                       : summary.is_same_build ? ""
                                               : " (recorded by another build)"));
  context.say(format("largest differences: pose %.6f mm, %.6f deg; tip %.6f mm; guidance %.6f mm, %.6f deg",
                     summary.worst_pose_mm, summary.worst_pose_deg, summary.worst_tip_mm,
                     summary.worst_offset_mm, summary.worst_angle_deg));
  guidance::GuidanceCounts guidance;
  for (const recording::RecordedFrame& frame : session.frames()) guidance.add(frame.guidance.state);
  if (const std::string why_not = guidance.reasons_of_most(); !why_not.empty())
    context.say(format("guidance was recorded in %ld frames; in the others: %s",
                       guidance.of(guidance::GuidanceState::Valid), why_not.c_str()));
  if (summary.registration_mm) {
    context.say(format("registration found again: %.4f mm from the recorded one at the target",
                       *summary.registration_mm));
  }
  for (const recording::Difference& difference : summary.differences) context.say(line_of(difference));
  if (summary.is_same())
    context.say(summary.states_equal == summary.states_compared ? "the same" : "the same within the limits");
}

// What speaks against it: empty where the session is as it was recorded and comes out the same.
std::vector<std::string> doubts_of(const recording::ReplaySummary& summary,
                                   const recording::SessionCheck& check) {
  std::vector<std::string> reasons;
  // The same again from a record that was changed is no proof of what was done.
  if (check.outcome == recording::SessionCheck::Outcome::Broken)
    reasons.push_back("the record is not as it was recorded: " + recording::check_words(check));
  if (!summary.is_same())
    reasons.push_back(summary.replayed_frames + summary.frames_without_picture == 0
                          ? "no frame could be replayed"
                          : std::to_string(summary.differences.size()) + " differences above tolerance");
  if (const std::string cold = recording::cold_start_in_words(summary); !cold.empty())
    reasons.push_back(cold);
  return reasons;
}

void replay(Context& context, const ReplayArguments& arguments) {
  refuse_before_the_work({.read = {}, .written = {arguments.output}});
  const std::filesystem::path folder = sessions_named(arguments.case_folder, arguments.session).back();
  const recording::RecordedSession session(folder);
  const recording::ReplayOptions options = recording::replay_options_of(arguments.case_folder, session);
  recording::ReplaySummary summary;
  {
    Progress progress("replaying", static_cast<long>(session.frames().size()));
    summary = recording::replay_session(session, options, [&](long done) { progress.advance_to(done); });
  }
  const std::vector<std::string> doubts = doubts_of(summary, recording::check_session(folder));
  if (!arguments.output.empty()) files::write_atomically(arguments.output, table_of(summary.differences));
  if (arguments.output != "-") say_result(context, session, summary);
  if (!doubts.empty()) context.say_unreliable("the replay", doubts);
}

}  // namespace

void add_replay_command(CLI::App& app, Context& context) {
  CLI::App* command =
      add_subcommand(app, context, "replay",
                     "Run a recorded session again through today's pipeline and report every difference",
                     "arthronaut replay knee.arthro --session 0003-20260102-030405 -o differences.csv");
  const auto arguments = std::make_shared<ReplayArguments>();
  command->add_option("CASE", arguments->case_folder, "Case folder")->required();
  command->add_option("--session", arguments->session, "The session's folder name; default: the newest");
  command
      ->add_option("-o,--output", arguments->output,
                   "Table of all differences to write (CSV); - is standard output")
      ->check(a_name());
  command->callback([&context, arguments] { replay(context, *arguments); });
}

}  // namespace arthronaut::command_line
