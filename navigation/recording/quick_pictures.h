// Small copies of a session's pictures, for whoever moves about in it. Where key frames are far apart, the
// right picture takes up to the best part of a second to decode (recorded_pictures.h); of its copy, half as
// wide and with a key frame every half second, a fiftieth of one.
//
// Copies lie in the session's folder `quick`, a file for each ten seconds or so, and are made by whoever
// looks at the session. They are nobody's record: no hash is kept of them, nothing computes with them, and
// they may be deleted at any time. Those of a video that was changed since are not taken.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <vector>

#include "navigation/recording/session_overview.h"

namespace arthronaut::recording {

// Threads: one at a time; whoever reads and whoever makes have one each.
class QuickPictures {
 public:
  struct Name {
    std::int64_t frame = 0, timestamp_ns = 0;
  };
  // of: the session's frames, in order; those without a picture are left out. Throws nothing. Precondition:
  // not null.
  QuickPictures(std::shared_ptr<const SessionOverview> session, const std::vector<Name>& of);
  ~QuickPictures();

  // Null: it was not made yet, or there is none.
  [[nodiscard]] camera::FramePtr picture(std::int64_t frame);
  // Makes the copies nearest to that frame that are not there; a file at a time, which is there as a whole or
  // not at all. False: nothing more is to be done, or `goes_on` ended it, or the disk has less than 4 GB
  // left. Pictures that cannot be read have no copies. Throws IoError where nothing can be written.
  bool make_next(std::int64_t near_frame, const std::function<bool()>& goes_on);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace arthronaut::recording
