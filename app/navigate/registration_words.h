// What the registration panel says, as plain data: states, numbers and touches in words, each with its sign.
// Pure.
#pragma once

#include <string>
#include <vector>

#include "app/widgets/controls.h"
#include "navigation/theatre/live_operation.h"

namespace arthronaut::navigate {

struct SeverityText {
  widgets::Severity severity = widgets::Severity::Quiet;
  std::string name, text;
};

// "Bone not found yet", "Bone position not sure yet", "Confirmed", "Verified", or the alarm; with what to do.
[[nodiscard]] SeverityText state_of(const operation::RegistrationState& state);
// 0 to 1; 0 while there is an alarm.
[[nodiscard]] double progress_of(const operation::RegistrationState& state);
// "draw 34 mm more; ..."; empty when nothing is missing.
[[nodiscard]] std::string missing_of(const operation::RegistrationState& state);
// "Assumed: the cartilage lies 2.0 mm off the mesh, ..."; of the same pose as the numbers. Empty when
// nothing was.
[[nodiscard]] std::string assumed_of(const operation::RegistrationState& state);
// Whether touches that it was not fitted to lie on the bone, by the registration that guides.
[[nodiscard]] bool is_verified(const operation::RegistrationState& state);
// Predicted error at the tunnel, and how near the next best pose comes: of the registration in force while it
// stands, and while there is none of the candidate that runs along, which is never called good. Empty else:
// what is void, in doubt or not reliable has no figures.
[[nodiscard]] std::vector<SeverityText> numbers_of(const operation::RegistrationState& state);

// The last touch, for a large number: name "Touch 2", text "0.4 mm" with its sign; and a sentence beside it.
struct TouchText {
  SeverityText number;
  std::string sentence;
};
// nullopt before the first touch.
[[nodiscard]] std::optional<TouchText> touch_of(const operation::RegistrationState& state);

// One row a stroke that counts, newest last. text: "32 mm, 0.2 mm off" or "excluded".
struct StrokeRow {
  int curve = 0;
  bool is_excluded = false;
  SeverityText text;
};
[[nodiscard]] std::vector<StrokeRow> stroke_rows(const operation::RegistrationState& state);
// The stroke above or below another in that list; the newest when there is no such stroke. -1 when there is
// none.
[[nodiscard]] int neighbour_stroke(const std::vector<StrokeRow>& rows, int curve, int step);

// One row an entry of the history: name "2  while drawing", text "± 0.6 mm, fit 0.3 mm", or why it is void.
// now: what the pictures are of; nullopt: not known, then void is what is judged to be.
[[nodiscard]] std::vector<SeverityText> history_rows(const operation::RegistrationState& state,
                                                     const std::optional<registration::Provenance>& now);

// A registration stands that was found before the time-out was confirmed: it counts when it is.
[[nodiscard]] bool waits_for_time_out(const operation::OperationState& state);

// All of the above at once, to be kept until the status or the source changes.
struct RegistrationWords {
  SeverityText state;
  double progress = 0;
  std::string missing, assumed;
  std::vector<SeverityText> numbers;
  std::optional<TouchText> touch;
  std::vector<StrokeRow> strokes;
  std::vector<SeverityText> history;
};
// Nothing in them is good, and no number of the registration among them, while another source is being
// opened, or could not be: nobody knows yet what its pictures are of; nor before the time-out of a live
// source: what was drawn by then may be of another patient.
[[nodiscard]] RegistrationWords words_of(const theatre::LiveState& live);
// The same with nothing called good: beside a picture that is not of now.
[[nodiscard]] RegistrationWords without_praise(RegistrationWords words);

// How far a touched point may lie off the bone to be good; beyond caution it is bad.
[[nodiscard]] widgets::Severity severity_of_residual(double residual_mm);

}  // namespace arthronaut::navigate
