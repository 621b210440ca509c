// What came of a navigation on a recorded or live source, in lines for the user.
#pragma once

#include "app/command_line/command.h"
#include "navigation/theatre/navigate_source.h"

namespace arthronaut::command_line {

// Source, markers and lens, strokes, registration, the bone in the picture, guidance.
void say_navigation(const Context& context, const theatre::NavigationSummary& summary);

}  // namespace arthronaut::command_line
