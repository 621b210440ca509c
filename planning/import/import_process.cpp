#include "planning/import/import_process.h"

#include <algorithm>
#include <utility>

#include "planning/geometry/error.h"
#include "planning/import/import_messages.h"
#include "planning/import/shared_voxels.h"

namespace arthronaut::importing {

namespace {

ImportRequest limited(ImportRequest request) {
  request.options.most_bytes = memory_limit_bytes(request.memory_limit_gib);
  return request;
}

// Thinking may take minutes without a word: the mending of a large mesh does.
ChildProcessOptions options_of(const ImportRequest& request) {
  return {.source = request.source,
          .program = request.program,
          .memory_limit_gib = request.memory_limit_gib,
          .longest_message_bytes = request.options.most_bytes,
          .shared_bytes = request.options.most_bytes};
}

}  // namespace

ImportProcess::ImportProcess(ImportRequest request)
    : request_(limited(std::move(request))),
      child_(
          options_of(request_),
          message_of(ChildRequest{.work = request_.is_postop ? ChildWork::ReadPostop : ChildWork::MakeBones,
                                  .source = request_.source,
                                  .options = request_.options,
                                  .memory_limit_bytes = request_.options.most_bytes})) {}

ImportProcess::State ImportProcess::wait_for(double seconds) {
  if (state() != State::Running) return state();
  const State state = child_.wait_for(seconds, [this](const Message& message) { return take(message); });
  if (state == State::Done) take_image();
  return state;
}

bool ImportProcess::take(const Message& message) {
  if (message.kind == MessageKind::Progress) {
    progress_ = progress_from(message.contents);
    done_fraction_ = std::max(done_fraction_, share_of_all(progress_));
    return false;
  }
  if (message.kind != MessageKind::Result)
    throw InvalidInput("the importing process sent a message out of turn");
  result_ = import_from(message.contents);
  return true;
}

// After the child's end, which else could change it meanwhile.
void ImportProcess::take_image() {
  if (!result_.image) return;
  images::EncodedVolume taken = taken_voxels(child_.shared());
  taken.header = std::move(result_.image->volume.header);
  result_.image->volume = std::move(taken);
  if (result_.image->volume.voxels.empty()) result_.image.reset();
}

BoneImport ImportProcess::take_result() {
  if (state() != State::Done)
    throw InvalidInput("the import of " + request_.source.string() + " is not done");
  return std::move(result_);
}

}  // namespace arthronaut::importing
