#include "navigation/sources/camera_facts.h"

#include "navigation/sources/device_identity.h"
#include "navigation/sources/v4l2_device.h"
#include "planning/geometry/error.h"

namespace arthronaut::sources {

CameraFacts camera_facts(const CameraAddress& address) {
  CameraFacts facts{.index = address.index};
  try {
    const V4l2Device device(address.index);
    facts.name = driver_text(device.says().card, sizeof device.says().card);
    facts.identity = device_identity("/dev/video" + std::to_string(address.index));
    facts.inputs = inputs_of(device);
    facts.modes = modes_of(device, address.wish);
    facts.chosen = choose_mode(facts.modes, address.wish);
  } catch (const DeviceError& error) {
    facts.trouble = error.what();
  }
  return facts;
}

}  // namespace arthronaut::sources
