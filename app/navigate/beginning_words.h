// What stands on the cards with which an operation begins: the time-out, and an operation that was left in
// the middle. Pure: state in, words out.
#pragma once

#include <chrono>
#include <string>
#include <vector>

#include "app/navigate/resume_offer.h"
#include "app/widgets/controls.h"
#include "navigation/operation/operation_state.h"
#include "planning/plan_review/tunnel_verdict.h"

namespace arthronaut::navigate {

struct CardLine {
  // What it tells of, for whoever wants some of the lines alone.
  enum class Topic { Other, Patient, Knee, Plan, CameraAndTools, Medium };
  widgets::Severity severity = widgets::Severity::Quiet;
  std::string name, text;
  Topic topic = Topic::Other;
};
// A question, which the next step asks in words, and what has to be read before it is answered.
struct Card {
  std::string name;   // for tests
  std::string title;  // may be empty
  std::vector<CardLine> lines;
  std::string keys;  // other answers than the pedal's; may be empty
};

// Water or saline, and not air.
[[nodiscard]] bool is_fluid(double refractive_index);

// Patient, knee, plan, camera, tools and medium, in the order in which they are read out. `patient`: in
// words; empty: not known. verdict: of the plan. Precondition: a source was started.
[[nodiscard]] std::vector<CardLine> time_out_lines(const operation::OperationState& state,
                                                   const std::string& patient,
                                                   const plan_review::TunnelVerdict& verdict);
[[nodiscard]] Card time_out_card(const operation::OperationState& state, const std::string& patient,
                                 const plan_review::TunnelVerdict& verdict);

// Of an edited plan that waits to be taken over, what it is and what speaks against it: "now 8.0 mm
// wide, 25.5 mm long; WRONG: Wall: 0.3 mm". verdict: of that one.
[[nodiscard]] std::string words_of_edited(const std::optional<operation::PlannedTunnel>& edited,
                                          const plan_review::TunnelVerdict& verdict);

// `plan`: the case's, as an operation that begins afresh would have it. verdict: of the one that was left.
[[nodiscard]] Card resume_card(const LeftBehind& left, const std::optional<operation::PlannedTunnel>& plan,
                               const plan_review::TunnelVerdict& verdict,
                               std::chrono::system_clock::time_point now);

// What is typed as the depth stop's reading: millimetres, with a point or a comma. Empty when it is no number
// from 0 to 150, which is longer than any drill in a knee.
[[nodiscard]] std::optional<double> depth_from_text(const std::string& text);

}  // namespace arthronaut::navigate
