// Whether the markers look as they must in the medium that is said to be before the lens. In the wrong medium
// the camera's angles are wrong by a third, poses come out wrong by centimetres, and most are refused as
// covered or doubtful: a reason that sends everybody looking for tissue on the marker.
//
// What tells: a tilted square near the lens has a perspective that belongs to one focal length alone. Its
// four corners fit a pose in the right medium to some hundredths of a pixel and in the other one (air for a
// fluid, saline for air, for a number that is neither the better of both) only to 0.4 px and more. Each such
// marker is a vote; votes are added up until they are many more on one side (a sequential test with bounds),
// so that chance does not decide and a medium that changes during the operation is noticed. Water and saline
// look alike; a marker that faces the lens from far away looks alike in every medium and has no vote.
//
// The wrong medium bends what is measured: edges are looked for where the pose has them, so the corners of a
// pose that stands lean towards the stated medium, and what does not stand has no corners at all. Therefore
// the check asks for a second look: the same picture, markers searched from nothing in the other medium.
//
//   check.look(view);                                              // every frame, 0 to 2 votes of 0.1 ms
//   if (check.wants_second_look()) check.look_again(view, second.look(frame, view.camera));
//   if (check.verdict().fit == MediumFit::Contradicts) ...         // no number; reason_text() says why
//
// MediumCheck is pure: the same views and second looks in the same order give the same verdict. One thread at
// a time. Not for cameras whose focal length is unknown: a zoom looks like another medium.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "navigation/pipeline/view_tracker.h"

namespace arthronaut::pipeline {

enum class MediumFit { Unknown, Fits, Contradicts };

struct MediumVerdict {
  MediumFit fit = MediumFit::Unknown;
  double stated_index = 0;  // the medium in force
  double other_index = 0;   // that it is compared with; of Contradicts: the medium that fits better
  long votes_for = 0, votes_against = 0;
  // How far the corners lie from a square's in either medium, RMS over the votes against; 0 without one.
  double stated_rms_px = 0, other_rms_px = 0;
  // Of Contradicts: the last moment at which markers spoke for the stated medium, after it had fitted and
  // before what speaks against it came together. What was measured later is of the wrong medium or may be.
  // -1: it never fitted, and all that was measured may be.
  std::int64_t last_sure_ns = -1;
  // Nothing is to be guided by yet: no marker has spoken for the stated medium, or one spoke against it and
  // was not outweighed. It ends, too, where nothing can be said: by second looks in which nothing speaks
  // against it, or when the markers have stood well for a while.
  bool is_held = false;
};

// Why no number is shown: names both media. Empty unless Contradicts.
[[nodiscard]] std::string reason_text(const MediumVerdict& verdict);

struct MediumCheckOptions {
  // A vote: corners fit one medium to at most clean_px, and the other one by more than wrong_px and more than
  // least_ratio times that. In the right medium 95 of 100 standing poses are better than 0.2 px.
  double clean_px = 0.2, wrong_px = 0.4, least_ratio = 3;
  // A vote against the stated medium counts for more, since poses that stand lean towards it.
  int weight_for = 1, weight_against = 3;
  // The sum of the votes from which on it fits, down to which it contradicts; it is kept within +-limit, so
  // that a long time in the right medium does not outweigh a change.
  int fits_at = 6, contradicts_at = -12, limit = 24;
  // Pictures right after each other err alike: one vote of a marker in this time.
  double vote_every_s = 0.05;
  // Second looks: when no marker has spoken for the stated medium for so long, and not oftener than ...
  double unconfirmed_s = 0.1, look_every_s = 0.5;
  double follow_up_s = 0.1;  // ... while votes speak against it, from the first one after those for it on
  // Held no longer, without a vote: after so many second looks, or after markers have stood well for so long;
  // before the first vote after one look or unconfirmed_s.
  int quiet_looks = 3;
  double well_s = 0.5;
};

class MediumCheck {
 public:
  // The markers in the order of the views' markers. The indices of the medium in force and of the medium of
  // the camera's calibration. Throws InvalidInput for an index outside [0.9, 2].
  MediumCheck(std::span<const markers::DeclaredMarker> declared, double refractive_index,
              double calibration_index, const MediumCheckOptions& options = {});

  // Views of one source in order of time; those without intrinsics and those of a frozen picture are left
  // out. Allocates nothing. Precondition: as many markers as were declared.
  void look(const PictureObservation& view);
  // Markers are there and none speaks for the stated medium: see the picture of the last look() again.
  [[nodiscard]] bool wants_second_look() const { return wants_second_look_; }
  // What SecondLook saw in the picture of this view.
  void look_again(const PictureObservation& view,
                  std::span<const markers::MarkerObservation> in_other_medium);

  [[nodiscard]] const MediumVerdict& verdict() const { return verdict_; }
  [[nodiscard]] double other_index() const { return verdict_.other_index; }
  void reset();  // another source, another scope

 private:
  void vote(const camera::CameraModel& stated, const markers::MarkerObservation& seen, double size_mm,
            bool may_be_for);
  void decide();
  void hold();
  void follow_hold(bool stand_well);

  MediumCheckOptions options_;
  double calibration_index_;
  std::vector<markers::DeclaredMarker> declared_;
  std::vector<std::int64_t> next_vote_ns_;  // of each marker
  std::int64_t now_ns_ = 0, confirmed_ns_ = 0, looked_ns_ = 0;
  bool has_begun_ = false, has_looked_ = false, wants_second_look_ = false;
  int score_ = 0;
  // Votes speak against it that were not outweighed since: from this score on. See last_sure_ns.
  bool is_in_doubt_ = false, has_fitted_ = false;
  int score_before_doubt_ = 0;
  std::int64_t voted_for_ns_ = -1;
  int quiet_looks_ = 0;                          // since it is held
  std::int64_t well_since_ns_ = -1;              // the markers in view stand well; -1: they do not
  double stated_square_ = 0, other_square_ = 0;  // sums over the votes against
  MediumVerdict verdict_;
};

// Sees a picture in the other medium, with nothing known from before. 10 to 60 ms on a 1080p frame: for a
// worker beside the frames, or now and then between them.
class SecondLook {
 public:
  SecondLook(std::span<const markers::DeclaredMarker> declared, double other_index, double calibration_index);
  // The camera is that of the picture's view, in the stated medium. Valid until the next call. Throws
  // InvalidInput when the picture's size is not the camera's.
  [[nodiscard]] std::span<const markers::MarkerObservation> look(const camera::Frame& frame,
                                                                 const camera::CameraModel& camera);

 private:
  double index_ratio_;
  std::unique_ptr<markers::MarkerTracker> tracker_;
  std::vector<std::uint8_t> gray_;
};

}  // namespace arthronaut::pipeline
