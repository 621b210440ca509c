#include "navigation/operation/medium_look.h"

#include <utility>

namespace arthronaut::operation {

MediumLookPtr MediumLookWork::look(MediumLookRequest request, const camera::Frame& picture) {
  if (second_look_ == nullptr || source_number_ != request.source_number) {
    second_look_ = std::make_unique<pipeline::SecondLook>(request.declared, request.other_index,
                                                          request.calibration_index);
    source_number_ = request.source_number;
  }
  auto look = std::make_shared<MediumLook>();
  const auto seen = second_look_->look(picture, request.view.camera);
  look->source_number = request.source_number;
  look->in_other_medium.assign(seen.begin(), seen.end());
  look->view = std::move(request.view);
  return look;
}

}  // namespace arthronaut::operation
