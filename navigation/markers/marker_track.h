// One declared marker as it is followed from frame to frame: where it was, how it moves, and the attempt to
// measure it at a supposed pose.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "navigation/camera/camera_model.h"
#include "navigation/markers/camera_smear.h"
#include "navigation/markers/code_evidence.h"
#include "navigation/markers/direct_alignment.h"
#include "navigation/markers/edge_pose.h"
#include "navigation/markers/edge_profiles.h"
#include "navigation/markers/marker_motion.h"
#include "navigation/markers/marker_tracker.h"
#include "navigation/markers/seen_code.h"
#include "navigation/markers/smear_search.h"

namespace arthronaut::markers {

// One frame, and what all markers of the camera share.
struct TrackedFrame {
  const LinearImage& image;
  const camera::CameraModel& camera;
  std::int64_t timestamp_ns = 0;
  std::int64_t interval_ns = 0;  // from frame to frame
  CameraSmear& smear;
  DirectFit* direct = nullptr;  // none: edge profiles alone
  // Fits that may still be made in this frame, counted in small direct ones: they take most of the time. What
  // is not measured in one frame is in the next.
  int& fits_left;
  KnownCodes codes;  // elsewhere: tracked in this frame by now
};

// When a measured pose stands. docs/thresholds.md says where the numbers come from.
struct MarkerTrackOptions {
  double min_cell_px = 3;         // smaller ones are not measured: TooSmall
  double min_direct_cell_px = 6;  // smaller ones are measured by their edges alone
  double smeared_px = 3;          // a motion over the exposure from which on the direct fit is the better one
  // The corners that single edges make under a direct fit lie no farther from it, or it fits something else;
  // without an edge pose to agree with, or one of another tilt through a smear of no more cells than this,
  // they have to be its own all the more.
  double max_direct_rms_px = 1.1, max_lone_rms_px = 0.5, max_edges_smear_cells = 0.65;
  // A motion over the exposure of more cells mixes each with its neighbours: single edges say nothing of it,
  // and another tilt may explain the picture as well. A pose stands only where one stood a short while ago,
  // turned no faster than a hand can but about the line of sight, where its turning is seen.
  double max_new_smear_cells = 1.25;
  // What a hand does over such an exposure is more than an even change of its motion: so much of the motion
  // may each corner be off by.
  double unfollowed_share = 0.006;
  double max_turn_rad_s = 10, turn_slack_rad = 0.05;
  double corner_sigma_px = 0.05;
  // Of the way that a marker's motion changes by over the exposure, as the frames before tell it: so much may
  // a pose by sharp edges be off: the mean of an even change.
  double change_share = 1.0 / 24;
  // At first sight the motion is a guess: so much more may be wrong with each corner.
  double found_corner_sigma_px = 0.15;
  // Corners of a marker that moves that lie farther from the pose than this are wrong by twice the rest,
  // where so much of the edges is seen that their sides meet in them.
  double usual_corner_rms_px = 0.2, nearly_whole_share = 0.7;
  // The other pose that a square allows is out of the question when it explains the corners this many times
  // worse, or the grey levels this many times.
  double clear_ratio = 10, other_noise = 1.15;
  // Logarithm of how much likelier than any other code of the dictionary a marker under highlights has to be.
  double sure_lead = 2;
  DirectOptions direct;
};

// From a start that may be off by a third of a cell, and over a longer way.
[[nodiscard]] DirectOptions unsure(DirectOptions options);

class MarkerTrack {
 public:
  MarkerTrack(const DeclaredMarker& marker, const MarkerCode& code, const MarkerTrackOptions& options = {});

  // Where the marker should be at this time; nullopt when it was never seen or too long ago.
  [[nodiscard]] std::optional<geometry::RigidTransform> predicted(std::int64_t timestamp_ns) const {
    return motion_.predicted(timestamp_ns);
  }

  // Measures the marker around this pose. Fills the observation; true when tracked. `is_found`: the pose
  // comes from a search and not from the frames before.
  bool measure(const TrackedFrame& frame, const geometry::RigidTransform& start, bool is_found,
               MarkerObservation& observation);

  // The same from where a search for a lost marker put it: stands only when the cells that are seen say so,
  // too.
  bool measure_recovered(const TrackedFrame& frame, const geometry::RigidTransform& start,
                         MarkerObservation& observation);

  // Motions over a long exposure that may have brought it here since it was seen last, each with where it
  // puts the marker; none where no motion is known, or none smears it over a cell.
  void smeared_motions(const TrackedFrame& frame, std::vector<ExposedPose>& motions) const;
  static constexpr std::size_t kMostMotions = 512;  // so many at most
  // Measures it by its whole code, where and as one of these motions is found to smear it.
  bool measure_smeared(const TrackedFrame& frame, const SquareSearch::SmallPicture& small,
                       SmearSearch& search, std::span<const ExposedPose> motions,
                       MarkerObservation& observation);
  // Measures it where a search found a square with its code, turned so often.
  bool acquire(const TrackedFrame& frame, const Corners& square, int turn, MarkerObservation& observation);

  // The edges about a pose that little speaks for. What they lead to, if they and the cells say that it is
  // the marker, is good enough to go on from in the next frame.
  // Through a smear a corner leads to another tilt as well: its edges have to look sharp, or something
  // is_calm.
  void suppose(const TrackedFrame& frame, const geometry::RigidTransform& start, bool is_calm);
  // Tracked, and since the frame before moved by too little to be smeared; before there was one: not known.
  [[nodiscard]] bool is_calm(const TrackedFrame& frame, const MarkerObservation& observation) const;
  [[nodiscard]] bool is_gone_on_from() const { return guess_.has_value(); }  // in this frame

  // The observation of this frame is final: remembers it.
  void follow(const MarkerObservation& observation, std::int64_t timestamp_ns);
  void forget();
  // Where it was when it was last followed; nullopt: never.
  [[nodiscard]] const std::optional<MarkerMotion::Sighting>& last_seen() const { return motion_.last(); }

  // Of the marker's cells in the picture.
  [[nodiscard]] double cell_px(const TrackedFrame& frame, const geometry::RigidTransform& pose) const;
  // Its motion is known, but is_fast() on the way to this pose, or it was seen but once: soon elsewhere.
  [[nodiscard]] bool is_outrun(const TrackedFrame& frame, const geometry::RigidTransform& pose) const;

  [[nodiscard]] const DeclaredMarker& marker() const { return marker_; }
  bool is_duplicate = false;  // as of the last search of the whole frame

 private:
  // The smear under which the picture looks most like the marker at this pose, when nothing is known of the
  // motion: the motion over the exposure as a body twist.
  [[nodiscard]] geometry::Vector6d likely_motion(const TrackedFrame& frame,
                                                 const geometry::RigidTransform& pose, int search_px);
  // How far its edges are looked for.
  [[nodiscard]] static int edge_search_px(bool is_found, double cell_px);
  // A whole fit, in small ones, and what trying motions takes of them: those that the edges speak for most
  // are fitted.
  static constexpr int kWholeFit = 3, kFittedMotions = 3, kFitsOfATrial = kFittedMotions + kWholeFit;
  // How much the picture looks like the marker at this pose when it moves like this.
  [[nodiscard]] double likeness_of(const TrackedFrame& frame, const geometry::RigidTransform& pose,
                                   const geometry::Vector6d& motion, int search_px);
  // Over the exposure, on the way to this pose: body twist; zero when not known.
  [[nodiscard]] geometry::Vector6d motion_to(const TrackedFrame& frame,
                                             const geometry::RigidTransform& pose) const;
  // How far a motion takes its sides.
  [[nodiscard]] double moved_px(const geometry::Vector6d& motion, double px_per_mm) const;
  // Its motion is known, and took it by more than a cell in a frame's time, on the way to this pose.
  [[nodiscard]] bool is_fast(const TrackedFrame& frame, const geometry::RigidTransform& pose) const;
  // measure(), from the edges on.
  bool measure_from_edges(const TrackedFrame& frame, const geometry::RigidTransform& start, bool is_found,
                          const EdgePose& fit, const Smear& picture, const SmearTrend& trend,
                          MarkerObservation& observation);
  // What is known by edges beside a direct fit from the same start.
  struct EdgesBeside {
    const EdgePose& fit;
    const Smear& picture;
    bool is_found = false, is_smeared = false;
    double max_rms_px = 0;  // that their corners may lie from the direct fit
  };
  // Whether a pose by the direct fit stands, or not; nullopt: the edges say.
  std::optional<bool> stand_by_direct(const TrackedFrame& frame, const geometry::RigidTransform& start,
                                      const DirectPose& direct, const EdgesBeside& edges,
                                      MarkerObservation& observation);
  // The motion that a fit found or its opposite, as the marker went on since it was seen; from both, what
  // share of the time is exposed.
  [[nodiscard]] SeenMotion forwards(const TrackedFrame& frame, const ExposedPose& found) const;
  void learn_share(const TrackedFrame& frame, const ExposedPose& found) const;
  // Edge profiles: refines the pose and the motion of `picture`.
  [[nodiscard]] EdgePose fit_edges(const TrackedFrame& frame, const geometry::RigidTransform& start,
                                   bool is_found, Smear& picture, SmearTrend& trend);
  // Where its edges lie about a pose, as far as is known had all rows been exposed at once.
  void look_at_edges(const TrackedFrame& frame, const LinearImage& image,
                     const geometry::RigidTransform& pose, Smear picture, const ProfileOptions& options,
                     SmearTrend& trend);
  // How it moves in this frame, by the frames before: body twist of one frame's time; zero when not known.
  [[nodiscard]] geometry::Vector6d interval_motion(const TrackedFrame& frame,
                                                   const geometry::RigidTransform& pose) const;
  // What is not known of the rows' timing is an error of the pose.
  void doubt_rows(const TrackedFrame& frame, const RowTrend& trend, MarkerObservation& observation) const;
  // Direct fit from a pose and a motion, of which the change is known as well, or by the frames before.
  [[nodiscard]] DirectPose fit_directly(const TrackedFrame& frame, const geometry::RigidTransform& start,
                                        const geometry::Vector6d& motion, const DirectOptions& options,
                                        const geometry::Vector6d* change = nullptr);
  // The same with those motions of a grid that the edges speak for, where none is known; the best, usable or
  // not.
  [[nodiscard]] DirectPose try_motions(const TrackedFrame& frame, const geometry::RigidTransform& start);
  // From here on the pose in the observation is judged: what the edges say, and the direct fit where there is
  // one.
  // Gives what they say of the rows' timing.
  RowTrend report_edges(const TrackedFrame& frame, const EdgePose& fit, const Smear& picture, bool is_found,
                        MarkerObservation& observation);
  void report_direct(const TrackedFrame& frame, const DirectPose& fit, std::optional<double> max_rms_px,
                     MarkerObservation& observation);
  // It is this marker and no other one of the dictionary that stands there, where highlights leave that open:
  // by this frame and those before since it is followed. What stays open is gone on from.
  bool is_identified(const TrackedFrame& frame, const Smear& picture, double misfit,
                     MarkerObservation& observation);
  // It went on to there since it was seen last.
  [[nodiscard]] bool goes_on_to(const TrackedFrame& frame, const geometry::RigidTransform& pose) const;
  // What the cells at the pose say of this marker, as far as they are seen; and that they are its own.
  [[nodiscard]] SeenCode seen_code(const TrackedFrame& frame, const geometry::RigidTransform& pose) const;
  [[nodiscard]] bool is_confirmed_by_code(const TrackedFrame& frame,
                                          const geometry::RigidTransform& pose) const {
    return seen_code(frame, pose).is_confirmed();
  }
  // The edges of a pose by few of them are this marker's, and not of what lies before it.
  [[nodiscard]] bool are_few_edges_its_own(const TrackedFrame& frame, const EdgePose& fit,
                                           bool is_found) const;
  [[nodiscard]] bool stood_lately(const TrackedFrame& frame) const;  // a pose did, a short while ago
  // A pose stood a short while ago, and a hand may have turned the marker from there to this one.
  [[nodiscard]] bool goes_on_from_published(const TrackedFrame& frame,
                                            const geometry::RigidTransform& pose) const;
  // A pose that is good enough to go on from, not to stand for; of several in one frame, the one whose edges
  // agree best: by their scatter over the share that is found.
  void go_on_from(const geometry::RigidTransform& pose, double misfit);

  MarkerTrackOptions options_;
  DeclaredMarker marker_;
  MarkerCode code_;
  int cells_;
  std::vector<EdgeSample> samples_;
  std::vector<EdgeMeasurement> measurements_, few_;  // few_: of motions that are tried, of half a marker
  std::vector<char> is_inlier_;
  MarkerMotion motion_;
  std::optional<MarkerMotion::Sighting> published_;  // the last pose that stood
  struct Guess {
    geometry::RigidTransform camera_from_marker;
    double misfit = 0;
    std::optional<SeenMotion> over_exposure = std::nullopt;
  };
  std::optional<SeenMotion> seen_motion_;  // of what was measured last
  std::optional<Guess> guess_;             // of this frame, until it is final
  CodeEvidence evidence_;                  // of which marker it is, since it is followed
  bool is_sure_ = false;                   // that it is this one
  bool is_motion_guessed_ = false;         // what is known of the motion comes from a pose that did not stand
  // What was measured last is smeared over more than a cell: neither edges nor cells can be told.
  bool is_beyond_edges_ = false;
  // What a search led to in this frame that did not stand, the last few: another start that leads there is
  // the same.
  struct Refused {
    EdgePose edges;
    geometry::Vector6d motion;
    MarkerObservation observation;
  };
  std::array<Refused, 4> refused_;
  std::size_t refused_count_ = 0;
  // A pose that explained this frame's picture and yet did not stand: another one that does is no better.
  std::optional<geometry::RigidTransform> explained_;
  // Something that might have been it could not be looked at to the end in this frame: nothing else stands in
  // its place.
  bool is_undecided_ = false;
};

}  // namespace arthronaut::markers
