// Runs a recorded session again: the same operation, with the pictures, commands and outcomes of the record,
// and says what differs. On the build that recorded it every state must come out the same to the last bit,
// registrations and alarms included; on another one, differences beyond the tolerances below are told. In
// either case so are decisions (alarms, what verified or voided a registration, tunnels that were drilled)
// that come out otherwise.
//
// A session that goes on with the strokes and registrations of earlier ones takes those in first, from their
// records. Frames whose picture was not kept are taken from the record too: what was decided on them is run
// again, their tracking is not.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "navigation/operation/operation.h"
#include "navigation/recording/session.h"

namespace arthronaut::recording {

struct ReplayOptions {
  // The bone to register to. Null: nothing is registered again.
  operation::SurfaceIndexPtr bone;
  // Why the case's bone is not the session's, in words: a difference of the session. Empty: it is, or nobody
  // knows.
  std::string other_bone = {};
  std::shared_ptr<const geometry::Surface> surface;                       // of the same mesh, for the touches
  std::optional<registration::CartilageRegion> cartilage = std::nullopt;  // of the bone
  // What passes for the same, on a copied video: far above rounding, far below anything that matters.
  double tolerance_mm = 1e-3, tolerance_deg = 1e-3;
  // On frames that the recorder encoded itself, whose pixels are not quite those that were tracked: three
  // times the worst difference seen on simulated and path-traced clips (0.03 mm, 0.12 deg).
  double reencoded_tolerance_mm = 0.1, reencoded_tolerance_deg = 0.4;
  // A registration found again may differ by this much, or by its own predicted error where that is larger.
  double registration_tolerance_mm = 0.1;
  // What the record says of a frame and what the program says of it now: of every frame whose picture was
  // kept, in order. May be empty.
  std::function<void(const RecordedFrame& then, const pipeline::FrameResult& now)> on_frame = {};
  // Asked before every frame, also of the sessions before; true ends the replay there. May be empty.
  std::function<bool()> stops = {};
};

// The bone of the session and what belongs to it, from the case: seconds. Of a case without that bone, or
// with another mesh of it than the session was recorded with, nothing is registered again. Throws what
// reading the case throws. `stops` is asked before each step that takes long, and becomes that of the
// options: where it ended one of them the bone is not ready, and a replay with these options ends before its
// first frame.
[[nodiscard]] ReplayOptions replay_options_of(const std::filesystem::path& case_folder,
                                              const RecordedSession& session,
                                              const std::function<bool()>& stops = {});

struct Difference {
  std::int64_t frame = -1;  // -1: of the session as a whole
  std::string what;         // "pose of marker 2", "tip", "guidance angle", "registration", ...
  double amount = 0;
  std::string unit;    // "mm", "deg"; empty: present in one and absent in the other, or another state
  std::string detail;  // in words, where there is no amount
};

struct ReplaySummary {
  long recorded_frames = 0, replayed_frames = 0;  // those whose picture was tracked again
  long frames_without_picture = 0;                // run again from the record
  std::vector<Difference> differences;            // above tolerance, in the order of frames
  long states_compared = 0, states_equal = 0;     // by their digests
  bool is_lossy = false;       // pictures were kept as H.264: they are not quite those that were tracked
  bool is_same_build = false;  // states must be equal to the last bit
  bool was_stopped = false;    // by ReplayOptions::stops: the rest was not compared
  // The largest of all, also below tolerance.
  double worst_pose_mm = 0, worst_pose_deg = 0, worst_tip_mm = 0, worst_offset_mm = 0, worst_angle_deg = 0;
  std::optional<double> registration_mm;  // at the target; empty when it was not compared
  // So many frames came before the first picture that was kept; where there are any, tracking began cold
  // behind them, and so many of the differences are of the poses that it found so.
  long frames_before_pictures = 0, cold_differences = 0;
  [[nodiscard]] bool is_same() const {
    return differences.empty() && replayed_frames + frames_without_picture > 0;
  }
};

// Why the poses of a cold start differ: "8 of them in poses that were tracked without the 65 pictures before,
// which were not kept; what was decided is compared by the record". Empty: none does.
[[nodiscard]] std::string cold_start_in_words(const ReplaySummary& summary);

// A video that is damaged is told, and what was decided from there on is run again from the record. Throws
// what the video throws where nothing of it can be read.
[[nodiscard]] ReplaySummary replay_session(const RecordedSession& session, const ReplayOptions& options,
                                           const std::function<void(long frames_done)>& progress = {});

}  // namespace arthronaut::recording
