// What is connected, and what it can give: for a list, and for a choice. Asking disturbs nobody who reads the
// camera's pictures.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "navigation/sources/camera_modes.h"

namespace arthronaut::sources {

struct CameraInput {
  int index = 0;
  std::string name = {};
  bool is_in_use = false;
  std::string trouble = {};                 // "no signal"; empty: none that the driver knows of
  std::vector<std::string> standards = {};  // "PAL", "NTSC-M"; of digital inputs none
  std::string standard = {};                // in use
};

struct CameraFacts {
  int index = 0;              // of /dev/videoN
  std::string name = {};      // as it calls itself
  std::string identity = {};  // as in device_identity.h
  std::vector<CameraInput> inputs = {};
  std::vector<CameraMode> modes = {};
  std::optional<CameraMode> chosen = {};  // what it would be opened with
  std::string trouble = {};               // why nothing is known: not connected, not allowed; empty else
};

// Never throws what the device answers: that is `trouble`.
[[nodiscard]] CameraFacts camera_facts(const CameraAddress& address);

}  // namespace arthronaut::sources
