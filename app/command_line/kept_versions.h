// The versions of a case's plan, as the command `plan` keeps, lists and takes them.
#pragma once

#include <string>
#include <vector>

#include "app/command_line/command.h"
#include "planning/cases/case.h"

namespace arthronaut::command_line {

// What a new plan takes the place of may be an evening's work, and nobody undoes a command: it is kept as a
// version, unless one is the same; then that is what a note says. Returns the number of the version that
// holds the plan before; 0: nothing of it is lost.
int keep_replaced(const std::string& case_folder, const cases::Plan& before, const cases::Plan& now,
                  std::vector<std::string>& notes);

// These bones' tunnels become those of the kept version, on the meshes that it names: plan_fit says where
// these are no longer the case's. Throws InvalidInput where no version has that number.
void take_version(const std::string& case_folder, int number, const std::vector<bones::BoneKind>& bones,
                  cases::Plan& plan);

// How each differs from the plan as it is.
void list_versions(const std::string& case_folder, const Context& context, const cases::Plan& plan);

}  // namespace arthronaut::command_line
