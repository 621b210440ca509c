// The workstation: one window with plan, set-up, navigation and review mode.
#pragma once

#include <filesystem>

namespace arthronaut::window {

struct WorkstationOptions {
  // A case; or what the import is to look into, where it is none. Empty: the list of cases, or the built-in
  // one.
  std::filesystem::path case_folder;
  bool built_in = false;      // opens the built-in knee at once
  long frames = 0;            // close after so many frames; 0: until the user quits (tests)
  bool list_widgets = false;  // print "READY" and each widget's rectangle, for tests that drive the window
};

// Runs until the window closes; returns the exit code. Throws DeviceError when no window can be opened.
int run_workstation(const WorkstationOptions& options);

}  // namespace arthronaut::window
