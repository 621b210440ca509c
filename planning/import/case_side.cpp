#include "planning/import/case_side.h"

#include <variant>

#include "planning/cases/case_sides.h"
#include "planning/files/local_time.h"
#include "planning/files/utc_clock.h"
#include "planning/geometry/error.h"

namespace arthronaut::importing {

namespace {

namespace fs = std::filesystem;
using bones::Side;
using cases::SideDoubt;

cases::BoneDoubt alone_told(Side side, cases::SideWitness by = cases::SideWitness::ShapesAlone) {
  return SideDoubt{by, side, side};
}

std::string knee_of(Side side) { return std::string(bones::to_text(side)) + " knee"; }

// Of a side that was checked. That shapes alone had told it is a doubt no more.
bool settle(cases::BoneDoubts& doubts, Side side) {
  bool is_settled = false;
  for (auto& [bone, of_bone] : doubts) {
    is_settled |= std::erase(of_bone, alone_told(side)) > 0;
    for (cases::BoneDoubt& doubt : of_bone) {
      auto* asked = std::get_if<SideDoubt>(&doubt);
      if (asked == nullptr || !asked->is_open()) continue;
      asked->looked_on = files::local_day(files::utc_now());
      is_settled = true;
    }
  }
  return is_settled;
}

cases::BoneDoubts doubts_as(const cases::Case& knee, cases::BoneDoubts doubts, Side side) {
  std::size_t told = 0;
  for (auto& [bone, of_bone] : doubts) {
    // What tells this side while the case has the other one; also after somebody has looked at it.
    told += std::erase_if(of_bone, [&](const cases::BoneDoubt& doubt) {
      const auto* asked = std::get_if<SideDoubt>(&doubt);
      return asked != nullptr && asked->told == side && asked->said != side;
    });
    // They spoke for the side that is left.
    std::erase(of_bone, alone_told(knee.side));
    std::erase(of_bone, alone_told(knee.side, cases::SideWitness::PersonAlone));
  }
  (void)settle(doubts, side);
  if (told == 0 && !knee.bones.empty())
    doubts[knee.bones.begin()->first].emplace_back(
        "until " + files::local_day(files::utc_now()) + " it was a " + knee_of(knee.side) +
        ", and nothing that its bones were made from spoke against that; somebody says that it is a " +
        knee_of(side));
  return doubts;
}

void refuse_achieved(const fs::path& folder, Side side) {
  if (!fs::exists(folder / "achieved.json")) return;
  throw InvalidInput(folder, "",
                     "holds what a CT after the operation showed, against the plan of a " +
                         knee_of(side == Side::Left ? Side::Right : Side::Left) +
                         ": its side stays. Import the bones into another case, as a " + knee_of(side));
}

}  // namespace

SaidSide say_side_of_case(const fs::path& case_folder, Side side) {
  const cases::Case knee = cases::load_case(case_folder);
  cases::BoneDoubts doubts = cases::load_bone_doubts(case_folder);
  SaidSide said;
  if (knee.side == side) {
    const bool is_settled = settle(doubts, side);
    if (is_settled) cases::save_bone_doubts(case_folder, doubts);
    said.lines.push_back("it is a " + knee_of(side) +
                         (is_settled
                              ? ", as you say: that somebody looked stands beside what spoke against it"
                              : " already, and nothing asks for its side to be checked"));
    return said;
  }
  refuse_achieved(case_folder, side);
  auto contents = cases::load_side(case_folder, knee, side);
  const bool was_of_it = contents.has_value();
  if (!contents) contents = cases::SideContents{};
  // What was said of a bone when it was of this side stays as it was.
  (void)settle(contents->doubts, side);
  contents->doubts.merge(doubts_as(knee, std::move(doubts), side));
  cases::change_side(case_folder, side, *contents);
  said.is_changed = true;
  said.lines.push_back("it is a " + knee_of(side) + " now; it was a " +
                       std::string(bones::to_text(knee.side)) + " one");
  if (!knee.plan.tunnels.empty())
    said.lines.push_back("the plan of the " + knee_of(knee.side) +
                         " is put aside, and is back when that is said again");
  if (!contents->plan.tunnels.empty())
    said.lines.push_back("the plan that it had as a " + knee_of(side) + " is back");
  else
    said.lines.push_back("nothing is planned of the " + knee_of(side));
  if (!was_of_it || contents->landmarks.empty())
    said.lines.push_back("its landmarks are proposed anew, as of a " + knee_of(side));
  return said;
}

}  // namespace arthronaut::importing
