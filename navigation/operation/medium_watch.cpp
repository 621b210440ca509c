#include "navigation/operation/medium_watch.h"

namespace arthronaut::operation {

void MediumWatch::on_source(const pipeline::PipelineOptions& options) {
  check_.emplace(markers::declared_markers(options.tools), options.refractive_index,
                 options.calibration.refractive_index);
  is_confirmed_by_record_ = false;
  ++source_number_;
  on_source_end();
}

void MediumWatch::on_source_end() {
  request_.reset();
  awaited_.reset();
}

void MediumWatch::look(const pipeline::FrameResult& frame, const pipeline::PipelineOptions& options) {
  check_->look(frame);
  if (!check_->wants_second_look() || awaited_) return;
  awaited_ = frame.frame_index;
  request_ = MediumLookRequest{source_number_, frame, markers::declared_markers(options.tools),
                               check_->other_index(), options.calibration.refractive_index};
}

void MediumWatch::take(const MediumLook& look) {
  awaited_.reset();
  check_->look_again(look.view, look.in_other_medium);
}

bool MediumWatch::holds() const {
  const pipeline::MediumVerdict now = verdict();
  return now.is_held && (now.votes_against > 0 || !is_confirmed_by_record_);
}

pipeline::MediumVerdict MediumWatch::verdict() const {
  return check_ ? check_->verdict() : pipeline::MediumVerdict();
}

}  // namespace arthronaut::operation
