// The versions of a case's plan, as the command `plan` keeps, lists and takes them.
#pragma once

#include <string>
#include <vector>

#include "app/command_line/command.h"
#include "planning/cases/case.h"
#include "planning/cases/plan_versions.h"

namespace arthronaut::command_line {

struct VersionArguments {
  bool keeps = false, lists = false;
  int taken = 0, named = 0;   // a version's number; 0: none
  cases::VersionWords words;  // of the one that is kept, or named
  [[nodiscard]] bool writes() const { return keeps || named > 0; }
};
struct VersionOptions {
  CLI::Option *take, *keep, *versions, *name_version;
};
VersionOptions add_version_options(CLI::App& plan, VersionArguments& arguments);
// Throws CLI::RequiredError for a name or a note that is of no version.
void refuse_words_of_nothing(const VersionArguments& arguments);

// What a new plan takes the place of may be an evening's work, and nobody undoes a command: it is kept as a
// version, unless one is the same; then that is what a note says. Returns the number of the version that
// holds the plan before; 0: nothing of it is lost.
int keep_replaced(const std::string& case_folder, const cases::Plan& before, const cases::Case& now,
                  std::vector<std::string>& notes);

// These bones' tunnels become those of the kept version, on the meshes that it names: plan_fit says where
// these are no longer the case's. Throws InvalidInput where no version has that number, or it is of the other
// side than the case.
void take_version(const std::string& case_folder, int number, const std::vector<bones::BoneKind>& bones,
                  cases::Case& knee);

// How each differs from the plan as it is.
void list_versions(const std::string& case_folder, const Context& context, const cases::Plan& plan);

}  // namespace arthronaut::command_line
