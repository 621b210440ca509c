#include "app/navigate/plan_words.h"

#include <algorithm>
#include <array>

namespace arthronaut::navigate {

namespace {

// Of the check of that name, where its text holds `said`.
struct PlainWords {
  std::string_view check, said, plain;
};

// The first that fits counts.
constexpr std::array kPlainWords{
    PlainWords{"Axis", "", "misses the bone"},
    PlainWords{"Length", "short", "short tunnel"},
    PlainWords{"Length", "long", "long tunnel"},
    PlainWords{"Wall", "may break out", "may break out of the bone"},
    PlainWords{"Wall", "breaks out", "breaks out of the bone"},
    PlainWords{"Wall", "", "thin wall"},
    PlainWords{"Diameter", "small", "narrow tunnel"},
    PlainWords{"Diameter", "wide", "wide tunnel"},
    PlainWords{"Deep to shallow", "deeper", "entry deeper than usual"},
    PlainWords{"Deep to shallow", "shallower", "entry shallower than usual"},
    PlainWords{"High to low", "higher", "entry higher than usual"},
    PlainWords{"High to low", "lower", "entry lower than usual"},
    PlainWords{"Anterior to posterior", "more anterior", "entry more anterior than usual"},
    PlainWords{"Anterior to posterior", "more posterior", "entry more posterior than usual"},
    PlainWords{"Medial to lateral", "more medial", "entry more medial than usual"},
    PlainWords{"Medial to lateral", "more lateral", "entry more lateral than usual"},
    PlainWords{"Coronal angle", "flatter", "flatter than advised"},
    PlainWords{"Coronal angle", "", "steeper than advised"},
    PlainWords{"Lateral epicondyle", "", "exit at the lateral collateral ligament"},
    PlainWords{"Tuberosity", "", "exit at the patellar tendon"},
    PlainWords{"Posterior cortex", "", "exit near the back of the bone"},
    PlainWords{"Opening", "", "drill grazes the bone"},
    PlainWords{"Landmarks", "", "landmarks do not fit the bone"},
    PlainWords{"Grid", "missing", "landmarks missing"},
    PlainWords{"Grid", "", "landmarks not confirmed"},
    PlainWords{"Graft length", "shorter", "short graft"},
    PlainWords{"Graft length", "longer", "long graft"},
    PlainWords{"Graft diameter", "", "femur and tibia differ in width"},
    PlainWords{"Length over flexion", "", "graft's length changes with flexion"},
    PlainWords{"Against the insertions", "slacker", "graft slackens with flexion"},
    PlainWords{"Against the insertions", "tighter", "graft tightens with flexion"},
    PlainWords{"Roof", "", "roof presses on the graft"},
    PlainWords{"Between the tunnels", "into each other", "tunnels run into each other"},
    PlainWords{"Between the tunnels", "", "little bone between the tunnels"},
};

}  // namespace

std::string in_plain_words(const std::string& reason) {
  const std::size_t end = reason.find(": ");
  if (end == std::string::npos) return reason;
  const std::string_view check = std::string_view(reason).substr(0, end),
                         text = std::string_view(reason).substr(end + 2);
  const auto known = std::ranges::find_if(kPlainWords, [&](const PlainWords& words) {
    return words.check == check && text.find(words.said) != std::string_view::npos;
  });
  if (known != kPlainWords.end()) return std::string(known->plain);
  // Places are named as everybody names them.
  if (check == "Entry" || check == "Exit")
    return (check == "Entry" ? "entry: " : "exit: ") + std::string(text);
  return reason;
}

plan_review::TunnelVerdict in_plain_words(plan_review::TunnelVerdict verdict) {
  for (auto* const reasons : {&verdict.wrong, &verdict.look})
    for (std::string& reason : *reasons) reason = in_plain_words(reason);
  return verdict;
}

}  // namespace arthronaut::navigate
