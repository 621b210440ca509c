#include "app/widgets/key_clashes.h"

#include <algorithm>
#include <map>
#include <utility>

namespace arthronaut::widgets {

std::vector<std::string> key_clashes(const Actions& actions, const std::vector<std::string_view>& prefixes) {
  std::map<std::pair<int, int>, std::vector<std::string>> by_key;
  for (const Action& action : actions.all()) {
    const bool in_reach = std::any_of(prefixes.begin(), prefixes.end(),
                                      [&](std::string_view prefix) { return action.id.starts_with(prefix); });
    if (action.key != 0 && in_reach && action.can_run())
      by_key[{action.key, action.mods}].push_back(action.id);
  }
  std::vector<std::string> clashes;
  for (const auto& [key, ids] : by_key) {
    if (ids.size() < 2) continue;
    std::string words = key_name(key.first, key.second) + ": ";
    for (const std::string& id : ids) words += (&id == &ids.front() ? "" : ", ") + id;
    clashes.push_back(std::move(words));
  }
  return clashes;
}

}  // namespace arthronaut::widgets
