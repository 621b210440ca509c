#include "app/plan/default_words.h"

#include <algorithm>
#include <utility>

#include "planning/files/unit_signs.h"

namespace arthronaut::plan {

std::string default_in_words(const std::vector<MadeTunnel>& made, bool took_the_place) {
  std::string words;
  for (const MadeTunnel& one : made) {
    const std::string name = tunnels::name_of(one.key);
    if (!one.made.is_usable()) {
      words += "No default for the " + name + ": " + ended(one.made.message) + "\n";
      continue;
    }
    words += "Default " + name + ": " + one.made.place + ".";
    for (const std::string& wrong : tunnels::wrong_in_words(one.checks))
      words += " Wrong there: " + wrong + ".";
    // Off the norm's place a single tunnel keeps the aim that it had there.
    const bool is_moved = one.key.bundle == norms::Bundle::Whole && one.made.off_norm_mm > 0;
    for (const tunnels::PlanCheck& check : one.made.failed)
      if (check.verdict == tunnels::PlanCheck::Verdict::Look)
        words += (is_moved ? " To be looked at: " : " No aim from there passes it: ") + check.name + ": " +
                 check.text + ".";
    if (one.made.other_entry) words += " Shift+N enters there instead.";
    words += "\n";
  }
  if (std::ranges::any_of(
          made, [](const MadeTunnel& one) { return one.made.is_usable() && !one.made.doubts.empty(); }))
    words += "It follows from landmarks that nobody has confirmed: look at them (L) before you rely on it.\n";
  if (took_the_place) words += "Ctrl+Z brings back the plan that was there.\n";
  if (!words.empty()) words.pop_back();
  return files::with_signs(std::move(words));
}

std::string ended(std::string sentence) {
  constexpr std::string_view kEnds = ".?!";
  if (sentence.empty() || kEnds.find(sentence.back()) == std::string_view::npos) sentence += '.';
  return sentence;
}

}  // namespace arthronaut::plan
