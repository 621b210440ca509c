// What the operation's verdicts are called on the screen. Pure: enums and numbers in, words out.
#pragma once

#include <string>

#include "app/navigate/operation_rail.h"
#include "navigation/theatre/live_operation.h"

namespace arthronaut::navigate {

// What to do next: "draw on the bone with the probe".
[[nodiscard]] std::string words_of(operation::NextAction action);
// The same of a touch that verifies, with how many are still missing.
[[nodiscard]] std::string words_of_verifying(const operation::OperationState& state);
// "register anew: let the probe draw", or that touches have denied what stands.
[[nodiscard]] std::string words_of_registering_anew(const operation::OperationState& state);
// "touch the control point again", with why it is asked for.
[[nodiscard]] std::string words_of_checking(const operation::OperationState& state);
// What is to be done about an alarm that no touch of the control point can take away.
[[nodiscard]] std::string place_anew_words(operation::WayOut way_out);
// What to do instead of something that needs pictures while the source gives none that show anything; empty
// where that is no hindrance. changed_to_px: they come in that size, and are not given on.
[[nodiscard]] std::string words_without_pictures(
    theatre::SourceTrouble trouble, operation::NextAction action,
    const std::optional<Eigen::Vector2i>& changed_to_px = std::nullopt);
// What stands before the step's own words where it can be done all the same, as it takes somebody's word: "no
// picture comes; ". Empty while pictures come, and for all other steps.
[[nodiscard]] std::string words_beside_no_picture(theatre::SourceTrouble trouble,
                                                  operation::NextAction action);
// What is wrong with a source whose pictures are not of now, where a card stands in the place of the reasons;
// empty: nothing, or it has ended.
[[nodiscard]] std::string why_not_live(const theatre::LiveState& live);
// Of a step that the surgeon went back to while a source runs: what a press does, or that what it takes is in
// no picture now. is_shown: what it would show stands on the screen already, and is to be followed.
[[nodiscard]] std::string words_of(Repeat repeat, operation::Step step, bool is_shown,
                                   theatre::SourceTrouble trouble,
                                   const std::optional<Eigen::Vector2i>& changed_to_px = std::nullopt);
// What was asked for a moment ago and not done, with why: "no touch: the probe moves". Short enough to stand
// in full size beside the step. Empty once it was done, or when that is longer ago than it takes to read.
[[nodiscard]] std::string refusal_notice(const theatre::LiveState& live, double now_s);

// What is wrong, in a few words, and what to do about it.
struct Trouble {
  std::string headline, advice;
  [[nodiscard]] bool empty() const { return headline.empty(); }
};
// Why what is in force may not guide; empty while it stands, and while there is nothing in force.
[[nodiscard]] Trouble trouble_of(const operation::RegistrationState& registration);
// Why a nominal guide of that name may not guide; empty while it may.
[[nodiscard]] Trouble trouble_of(const operation::GuideCheckState& guide, const std::string& name);
// Of an operation whose pictures have ended.
[[nodiscard]] Trouble trouble_of_end(const operation::OperationState& state);
// While the mark is found on its track: empty.
[[nodiscard]] Trouble trouble_of(const lens::LensObservation& lens);

}  // namespace arthronaut::navigate
