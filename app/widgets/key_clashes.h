// Whether one key would do two things: an action that another one hides by its key can be pressed by nobody.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "app/widgets/actions.h"

namespace arthronaut::widgets {

// Of the actions whose ids start with one of the prefixes and that can run now, those that share a key with
// its modifiers: "P: plan.landmark_place, plan.place". Empty: none do.
[[nodiscard]] std::vector<std::string> key_clashes(const Actions& actions,
                                                   const std::vector<std::string_view>& prefixes);

}  // namespace arthronaut::widgets
