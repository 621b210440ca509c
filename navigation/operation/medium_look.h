// The second look at a picture, in the other medium (pipeline/medium_check.h), taken off the frames: it takes
// as long as two to four of them.
//
// The operation asks for one and goes on; what was seen comes back as data that names the frame whose picture
// it is of, and the journal says after which frame it was taken in. What is seen depends on that picture and
// its camera alone, so a record that has the picture can be run again to the same states.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "navigation/camera/frame.h"
#include "navigation/pipeline/medium_check.h"

namespace arthronaut::operation {

struct MediumLookRequest {
  std::uint64_t source_number = 0;    // of the sources that the operation had
  pipeline::PictureObservation view;  // of the picture that is to be seen again, in the stated medium
  std::vector<markers::DeclaredMarker> declared;
  double other_index = 0, calibration_index = 0;
};

struct MediumLook {
  std::uint64_t source_number = 0;
  pipeline::PictureObservation view;
  std::vector<markers::MarkerObservation> in_other_medium;  // in the order of view.markers
  std::string failure;                                      // why it could not be seen again; empty: it was
};
using MediumLookPtr = std::shared_ptr<const MediumLook>;

// Thread-free. Keeps its search between the looks of a source; what it finds depends on the picture alone.
class MediumLookWork {
 public:
  // `picture` is that of the request's view. Never throws: what goes wrong is the look's failure, and the
  // next one begins anew.
  [[nodiscard]] MediumLookPtr look(MediumLookRequest request, const camera::Frame& picture);

 private:
  std::uint64_t source_number_ = 0;
  std::unique_ptr<pipeline::SecondLook> second_look_;
};

}  // namespace arthronaut::operation
