#include "app/window/workstation.h"

#include "app/window/workstation_window.h"

namespace arthronaut::window {

int run_workstation(const WorkstationOptions& options) {
  WorkstationWindow window(options);
  window.run();
  return 0;
}

}  // namespace arthronaut::window
