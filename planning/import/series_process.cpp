#include "planning/import/series_process.h"

#include <algorithm>

#include "planning/geometry/error.h"
#include "planning/import/import_messages.h"

namespace arthronaut::importing {

namespace {

ChildProcessOptions options_of(const SeriesRequest& request) {
  return {.source = request.source,
          .program = request.program,
          .memory_limit_gib = request.memory_limit_gib,
          .longest_message_bytes = kLongestList_bytes,
          .longest_silence_s = request.longest_silence_s};
}

ChildRequest child_request(const SeriesRequest& request) {
  return {.work = request.with_pictures ? ChildWork::ListSeriesWithPictures : ChildWork::ListSeries,
          .source = request.source,
          .options = {},
          .memory_limit_bytes = memory_limit_bytes(request.memory_limit_gib)};
}

}  // namespace

SeriesProcess::SeriesProcess(SeriesRequest request)
    : with_pictures_(request.with_pictures),
      child_(options_of(request), message_of(child_request(request))) {}

SeriesProcess::State SeriesProcess::wait_for(double seconds) {
  return child_.wait_for(seconds, [this](const Message& message) { return take(message); });
}

SeriesProcess::State SeriesProcess::finish(const std::function<void(double looked_fraction)>& on_looked) {
  constexpr double kTellsEvery_s = 0.1;
  while (wait_for(kTellsEvery_s) == State::Running)
    if (on_looked) on_looked(looked_);
  return state();
}

bool SeriesProcess::take(const Message& message) {
  const bool awaits_list = !list_.has_value();
  if (message.kind == MessageKind::Progress && awaits_list) {
    looked_ = std::clamp(progress_from(message.contents).fraction, 0.0, 1.0);
  } else if (message.kind == MessageKind::SeriesList && awaits_list) {
    list_ = series_list_from(message.contents);
  } else if (message.kind == MessageKind::SeriesPicture && !awaits_list) {
    pictures_.push_back(series_picture_from(message.contents));
  } else {
    throw InvalidInput("the importing process sent a message out of turn");
  }
  return is_whole();
}

// As many pictures as series ends it: no more are taken.
bool SeriesProcess::is_whole() const {
  return list_ && (!with_pictures_ || pictures_.size() >= list_->series.size());
}

}  // namespace arthronaut::importing
