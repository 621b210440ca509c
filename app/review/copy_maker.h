// Makes the small copies of a session's pictures (quick_pictures.h) in a thread of its own that gives way to
// all others, until all are there or the disk is nearly full. What cannot be written is told in the log: the
// session is looked at as before.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "navigation/recording/quick_pictures.h"
#include "navigation/worker/worker.h"

namespace arthronaut::review {

class CopyMaker {
 public:
  CopyMaker(const std::shared_ptr<const recording::SessionOverview>& session,
            const std::vector<recording::QuickPictures::Name>& names);
  // From now on those nearest to that frame first.
  void make_about(std::int64_t frame) { worker_.post(frame); }

 private:
  struct Nothing {};
  worker::Worker<std::int64_t, Nothing> worker_;
};

}  // namespace arthronaut::review
