#include <csignal>

#include "app/command_line/command.h"
#include "app/window/workstation.h"

int main(int argc, char** argv) {
  using namespace arthronaut;
  // A file over the size limit is then an error of write(), told like a full disk, instead of the end of the
  // program.
  std::signal(SIGXFSZ, SIG_IGN);
  // Likewise a pipe that nobody reads any more: what was begun comes to its end, and a case's lock is let go.
  std::signal(SIGPIPE, SIG_IGN);
  return command_line::run_command_line(argc, argv, [](const command_line::WorkstationRequest& request) {
    return window::run_workstation({.case_folder = request.case_folder,
                                    .built_in = request.built_in,
                                    .frames = request.frames,
                                    .list_widgets = request.list_widgets});
  });
}
