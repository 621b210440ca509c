#include "navigation/operation/medium_look.h"

#include <exception>
#include <utility>

namespace arthronaut::operation {

MediumLookPtr MediumLookWork::look(MediumLookRequest request, const camera::Frame& picture) {
  auto look = std::make_shared<MediumLook>();
  look->source_number = request.source_number;
  try {
    if (second_look_ == nullptr || source_number_ != request.source_number) {
      second_look_ = std::make_unique<pipeline::SecondLook>(request.declared, request.other_index,
                                                            request.calibration_index);
      source_number_ = request.source_number;
    }
    const auto seen = second_look_->look(picture, request.view.camera);
    look->in_other_medium.assign(seen.begin(), seen.end());
  } catch (const std::exception& error) {
    look->failure = error.what();
    second_look_.reset();
  }
  look->view = std::move(request.view);
  return look;
}

}  // namespace arthronaut::operation
