// An outside tracker that speaks OpenIGTLink (PLUS, a tracker's own server, another 3D Slicer): connects to
// it, reads its poses, and connects anew whenever the connection breaks off, falls silent for five seconds,
// sends what is no OpenIGTLink or is behind its own clock. A server that sends tracking data only when it is
// asked to is asked (STT_TDATA).
//
// Poses come with the tracker's clock; ClockMatch says how old they are, and the connection's round trip how
// much that may be short of. Names, frames and what of it may be used: navigation/tracker/pose_book.h.
//
// Threads: a thread of its own reads; every member may be called from any thread and none waits, but the
// destructor, which joins: a fifth of a second, or as long as the system takes to look up a host's name.
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "navigation/pipeline/navigation_pipeline.h"
#include "navigation/tracker/pose_book.h"
#include "navigation/tracker/pose_source.h"

namespace arthronaut::openigtlink {

struct TrackerAddress {
  std::string host;
  int port = 18944;  // where nothing else is said, as everywhere
};
// "igtl://HOST:PORT", "igtl://HOST", "igtl://[::1]:18944". Throws InvalidInput.
[[nodiscard]] TrackerAddress tracker_address(std::string_view text);

// The tools are seen by the tracker at this address, whichever they name; empty: as they are.
void see_by(tools::ToolSet& tools, const std::string& address);

// The tracker that the tools of the set-up name. Precondition: they name one, with its address.
[[nodiscard]] std::unique_ptr<tracker::PoseSource> listen_to_tracker(
    const pipeline::PipelineOptions& options);

class IgtlTracker : public tracker::PoseSource {
 public:
  // Throws InvalidInput for what is no address; a server that is not there is waited for.
  IgtlTracker(const std::string& address, const tracker::TrackedBodies& bodies);
  ~IgtlTracker() override;
  IgtlTracker(const IgtlTracker&) = delete;
  IgtlTracker& operator=(const IgtlTracker&) = delete;

  void poses_at(std::int64_t now_ns, tracker::TrackerPoses& poses) override;
  [[nodiscard]] std::string trouble() const override;
  [[nodiscard]] const std::string& name() const override;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace arthronaut::openigtlink
