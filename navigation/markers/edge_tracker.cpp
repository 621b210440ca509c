#include "navigation/markers/edge_tracker.h"

#include <algorithm>
#include <utility>

#include "navigation/markers/code_reader.h"
#include "navigation/markers/code_search.h"
#include "navigation/markers/corner_search.h"
#include "navigation/markers/declaration.h"
#include "navigation/markers/linear_image.h"
#include "navigation/markers/marker_company.h"
#include "navigation/markers/marker_track.h"
#include "navigation/markers/smear_search.h"
#include "navigation/markers/square_search.h"
#include "navigation/markers/verdict.h"
#include "planning/geometry/error.h"

namespace arthronaut::markers {
namespace {

using geometry::RigidTransform;

constexpr std::size_t kLikelyCandidates = 256;  // memory set aside
// The work of fits in one frame, counted in small direct ones; three of these make a whole one.
constexpr int kFitsAFrame = 80, kFitsForCorners = 60;
// Squares with its code in which a marker is looked for, in one frame.
constexpr int kMostSquares = 3;
constexpr std::size_t kSearchesForCovered = 3;
// What a search of the whole frame is made of, in this order; and which of several frames has it where there
// is no hurry. Squares are sought as usual or as covered ones.
enum class Search { Lost, Usual, OtherContrast, Highlights, Covered, Corners };
constexpr std::pair<Search, int> kSearchParts[] = {{Search::Lost, 2},          {Search::Usual, 0},
                                                   {Search::OtherContrast, 1}, {Search::Highlights, 2},
                                                   {Search::Covered, 0},       {Search::Corners, 3}};
constexpr int kMostSupposed = 2;  // squares of which a corner is seen that are measured in one frame
constexpr std::int64_t kUsualIntervalNs = 33'333'333;
// A marker that was sought in every frame for so long, and is not there, is sought in every few frames.
constexpr std::int64_t kSoughtOftenNs = 1'000'000'000;
// How long a marker that was lost is looked for about where it was.
constexpr std::int64_t kMissedNs = 2'000'000'000;
// How far about it, in sides: at once, more with every second, and at most.
constexpr double kReachAtOnce = 0.45, kReachPerSecond = 6, kMaxReach = 1.6;
// From where a marker is predicted to where its code is found, in cells: more, and the edges are not found
// from the one, and not much less than the other may be off by itself.
constexpr double kOvertakenCells = 0.7, kOvertakenReach = 0.8;
constexpr double kCompanyReach = 0.3, kCompanyReachPerSecond = 2;

class EdgeTracker final : public MarkerTracker {
 public:
  EdgeTracker(std::span<const DeclaredMarker> declared, std::span<const MarkerCode> codes,
              const EdgeTrackerOptions& options)
      : options_(options), light_(options.gamma), dictionary_(codes.begin(), codes.end()) {
    for (const DeclaredMarker& marker : declared) {
      const auto code =
          std::find_if(codes.begin(), codes.end(), [&](const MarkerCode& c) { return c.id == marker.id; });
      if (code == codes.end())
        throw InvalidInput("marker " + std::to_string(marker.id) + ": is not in the dictionary");
      codes_.push_back(*code);
      tracks_.emplace_back(marker, *code, options.track);
    }
    candidates_.reserve(kLikelyCandidates);
    reset();
  }

  std::span<const MarkerObservation> track(const camera::GrayView& frame, const camera::CameraModel& camera,
                                           std::int64_t timestamp_ns) override {
    check_frame_size(frame, camera);
    const LinearImage image(frame, light_);
    // Frames that were dropped make an interval longer, not the exposure.
    const std::int64_t since = timestamp_ns - last_ns_;
    if (last_ns_ >= 0 && since > 0) interval_ns_ = std::min(since, interval_ns_ + interval_ns_ / 32);
    last_ns_ = timestamp_ns;
    int fits_left = kFitsAFrame;
    are_elsewhere_.assign(tracks_.size(), 0);
    const TrackedFrame tracked{image,        camera,
                               timestamp_ns, interval_ns_,
                               smear_,       options_.fit_directly ? &direct_ : nullptr,
                               fits_left,    {codes_, dictionary_, are_elsewhere_}};
    candidates_.clear();
    is_looked_at_ = false;
    attempts_.assign(tracks_.size(), 0);
    // Whose turn is first changes, so that none takes all of a frame's fits for ever.
    ++frames_;
    for (std::size_t k = 0; k < tracks_.size(); ++k) {
      const std::size_t i = (frames_ + k) % tracks_.size();
      observations_[i] = MarkerObservation();
      observations_[i].id = tracks_[i].marker().id;
      starts_[i] = RigidTransform();
      const auto predicted = tracks_[i].predicted(timestamp_ns);
      if (!predicted) continue;
      tracks_[i].smeared_motions(tracked, motions_);
      if (!motions_.empty()) {
        look_at(tracked);
        are_elsewhere_[i] = tracks_[i].measure_smeared(tracked, search_.small_picture(), smear_search_,
                                                       motions_, observations_[i]);
        if (are_elsewhere_[i]) continue;
      }
      const auto start = overtaken(i, *predicted, tracked);
      if (!start) continue;
      starts_[i] = *start;
      are_elsewhere_[i] = tracks_[i].measure(tracked, *start, false, observations_[i]);
    }
    leave_one_a_place();
    if (is_any_sought_often(timestamp_ns)) {
      for (const auto& [what, when] : kSearchParts) search(what, tracked);
      frames_since_search_ = 1 % options_.search_every_frames;
    } else {
      for (const auto& [what, when] : kSearchParts)
        if (when % options_.search_every_frames == frames_since_search_) search(what, tracked);
      frames_since_search_ = (frames_since_search_ + 1) % options_.search_every_frames;
    }
    leave_one_a_place();
    for (std::size_t i = 0; i < tracks_.size(); ++i) {
      if (tracks_[i].is_duplicate && observations_[i].is_tracked())
        observations_[i].state = MarkerState::Duplicate;
      tracks_[i].follow(observations_[i], timestamp_ns);
      if (observations_[i].is_tracked()) sought_since_ns_[i] = timestamp_ns;
    }
    company_.remember(observations_, timestamp_ns);
    return observations_;
  }

  [[nodiscard]] std::span<const MarkerCandidate> candidates() const override { return candidates_; }

  void reset() override {
    candidates_.clear();
    observations_.assign(tracks_.size(), MarkerObservation());
    starts_.assign(tracks_.size(), RigidTransform());
    for (std::size_t i = 0; i < tracks_.size(); ++i) {
      tracks_[i].forget();
      observations_[i].id = tracks_[i].marker().id;
    }
    smear_ = CameraSmear();
    smear_.gamma = options_.gamma;
    smear_.bloom.sigma_px = options_.bloom_sigma_px;
    frames_since_search_ = 0;
    motions_.reserve(MarkerTrack::kMostMotions);
    search_.start_over();
    corner_search_.start_over();
    is_sought_.assign(tracks_.size(), 0);
    seen_.reserve(tracks_.size());
    company_.start_over(tracks_.size());
    sought_since_ns_.assign(tracks_.size(), -1);
    interval_ns_ = kUsualIntervalNs;
    last_ns_ = -1;
    frames_ = searches_ = 0;
  }

 private:
  void search(Search what, const TrackedFrame& frame) {
    if (what != Search::Usual && !is_missing()) return;
    look_at(frame);
    const std::size_t turn = searches_ % kSearchesForCovered;
    switch (what) {
      case Search::Lost:
        for (std::size_t k = 0; k < tracks_.size(); ++k) {
          const std::size_t i = (frames_ + k) % tracks_.size();
          if (!observations_[i].is_tracked()) recover(i, frame);
        }
        break;
      case Search::Usual:
        for (MarkerTrack& track : tracks_) track.is_duplicate = false;
        // The dearer search takes the place of the other now and then; what was just lost is looked for
        // before.
        is_for_covered_ = ++searches_ % kSearchesForCovered == 0 && is_missing();
        if (!is_for_covered_) take_squares(search_.find(frame.camera), frame, Pass::Usual);
        break;
      case Search::OtherContrast:
        if (!is_for_covered_)
          take_squares(search_.find(frame.camera, turn == 1 ? Contrast::Deep : Contrast::Faint), frame,
                       Pass::OtherContrast);
        break;
      case Search::Highlights:
        take_squares(search_.find_across_highlights(frame.camera), frame, Pass::Covered);
        break;
      case Search::Covered:
        if (is_for_covered_) take_squares(search_.find_covered(frame.camera), frame, Pass::Covered);
        break;
      case Search::Corners:
        if (turn == 2) take_corners(frame);
        break;
    }
  }

  void look_at(const TrackedFrame& frame) {
    if (!is_looked_at_) search_.look_at(frame.image.view(), frame.camera);
    is_looked_at_ = true;
  }

  // Where to measure a marker that is followed. What moves by more than a cell from frame to frame is soon
  // elsewhere than where it was going to: its code is looked for about there, and where it was. nullopt: it
  // was not seen in the last frame either, and its code is not found.
  [[nodiscard]] std::optional<RigidTransform> overtaken(std::size_t index, const RigidTransform& predicted,
                                                        const TrackedFrame& frame) {
    const MarkerTrack& track = tracks_[index];
    if (!track.is_outrun(frame, predicted)) return predicted;
    look_at(frame);
    const double cell_px = track.cell_px(frame, predicted);
    const auto look = [&](const RigidTransform& supposed) {
      return code_search_.find(search_.small_picture(), frame.camera, supposed, track.marker().size_mm,
                               codes_[index], kOvertakenReach * codes_[index].cells * cell_px);
    };
    CodePlace place = look(predicted);
    if (place.score < CodeSearch::kMinScore) place = look(track.last_seen()->camera_from_marker);
    if (place.score < CodeSearch::kMinScore) {
      const bool was_seen = frame.timestamp_ns - track.last_seen()->timestamp_ns < 3 * interval_ns_ / 2;
      return was_seen ? std::optional(predicted) : std::nullopt;
    }
    const auto from = frame.camera.project(predicted.translation_mm),
               to = frame.camera.project(place.camera_from_marker.translation_mm);
    const bool is_elsewhere = from && to && (*to - *from).norm() > kOvertakenCells * cell_px;
    return is_elsewhere ? place.camera_from_marker : predicted;
  }

  // A marker is missing that was there a short while ago, or may be found for the first time.
  [[nodiscard]] bool is_any_sought_often(std::int64_t timestamp_ns) {
    bool is_any = false;
    for (std::size_t i = 0; i < tracks_.size(); ++i) {
      std::int64_t& since_ns = sought_since_ns_[i];
      if (since_ns < 0 || since_ns > timestamp_ns) since_ns = timestamp_ns;
      is_any |= !observations_[i].is_tracked() && timestamp_ns - since_ns < kSoughtOftenNs;
    }
    return is_any;
  }

  [[nodiscard]] bool is_missing() const {
    return std::any_of(observations_.begin(), observations_.end(),
                       [](const MarkerObservation& seen) { return !seen.is_tracked(); });
  }

  enum class Pass { Usual, OtherContrast, Covered };
  void take_squares(std::span<const FoundSquare> squares, const TrackedFrame& frame, Pass pass) {
    for (const FoundSquare& square : squares) {
      auto code = read_code(frame.image, frame.camera, square.tangent, codes_);
      if (!code && (pass == Pass::Covered || search_.has_highlight(square)))
        code = read_covered_code(frame.image, frame.camera, square.tangent, frame.codes);
      // What is read in part where another marker stands is a part of that one.
      if (code && code->has_unread_cells && is_of_another(square)) continue;
      const int id = code ? codes_[code->index].id : MarkerCandidate::kNoCode;
      if (pass == Pass::OtherContrast && code && was_tried(square, id)) continue;
      candidates_.push_back({square.corners_px, id});
      if (!code) continue;
      MarkerTrack& track = tracks_[code->index];
      MarkerObservation& known = observations_[code->index];
      if (known.is_tracked()) {
        track.is_duplicate |= !square.is_at(known.corners_px);
        continue;
      }
      if (attempts_[code->index]++ < kMostSquares) track.acquire(frame, square.tangent, code->turn, known);
      are_elsewhere_[code->index] = known.is_tracked();
    }
  }

  // Of which hardly more than a corner is seen: nothing stands yet, the next frame goes on from there.
  void take_corners(const TrackedFrame& frame) {
    seen_.clear();
    bool is_any_calm = false;
    for (std::size_t i = 0; i < tracks_.size(); ++i) {
      is_sought_[i] = !observations_[i].is_tracked() && !tracks_[i].is_gone_on_from();
      if (observations_[i].is_tracked()) seen_.push_back(observations_[i].corners_px);
      is_any_calm |= tracks_[i].is_calm(frame, observations_[i]);
    }
    // Where nothing is seen that hardly moves most of what is missing is smeared, and found by no corner: not
    // in a frame that fits have made long.
    if (!is_any_calm && frame.fits_left < kFitsForCorners) return;
    const auto all = corner_search_.find(search_.small_picture(), frame.camera, codes_, is_sought_, seen_);
    int left = kMostSupposed;
    for (std::size_t k = 0; k < tracks_.size(); ++k) {
      MarkerTrack& track = tracks_[(searches_ + k) % tracks_.size()];
      for (const SupposedSquare& supposed : all) {
        if (&track != &tracks_[supposed.index] || is_of_another(supposed.square) || left-- <= 0) continue;
        const auto starts = poses_of_square(supposed.square.tangent, supposed.turn, track.marker().size_mm);
        for (const RigidTransform& start : starts) track.suppose(frame, start, is_any_calm);
      }
    }
  }

  // By another contrast, in this frame. What a fit has learnt there would be overwritten by the next one.
  [[nodiscard]] bool was_tried(const FoundSquare& square, int id) const {
    return std::any_of(candidates_.begin(), candidates_.end(), [&](const MarkerCandidate& candidate) {
      return candidate.id == id && square.is_at(candidate.corners_px);
    });
  }

  // Looks for a marker that was lost: where it went on to by itself, and where another one that is seen took
  // it.
  void recover(std::size_t index, const TrackedFrame& frame) {
    MarkerTrack& track = tracks_[index];
    const auto& last = track.last_seen();
    if (!last || frame.timestamp_ns - last->timestamp_ns > kMissedNs) return;
    const double lost_s = 1e-9 * static_cast<double>(frame.timestamp_ns - last->timestamp_ns);
    const double side_px = frame.camera.central_focal_px() * track.marker().size_mm /
                           std::max(1.0, last->camera_from_marker.translation_mm.z());
    const auto reach_px = [&](double at_once, double per_second, double seconds) {
      return side_px * std::min(kMaxReach, at_once + per_second * seconds);
    };
    const auto look = [&](const RigidTransform& supposed, double reach) {
      return code_search_.find(search_.small_picture(), frame.camera, supposed, track.marker().size_mm,
                               codes_[index], reach);
    };
    const double reach = reach_px(kReachAtOnce, kReachPerSecond, lost_s);
    const auto predicted = track.predicted(frame.timestamp_ns);
    CodePlace place = look(predicted.value_or(last->camera_from_marker), reach);
    // What turned back is not where it was going to.
    if (predicted && place.score < CodeSearch::kMinScore) place = look(last->camera_from_marker, reach);
    if (const auto with = company_.place_of(index, observations_, frame.timestamp_ns)) {
      const CodePlace beside =
          look(with->camera_from_marker,
               reach_px(kCompanyReach, kCompanyReachPerSecond, 1e-9 * static_cast<double>(with->age_ns)));
      if (beside.score > place.score) place = beside;
    }
    if (place.score < CodeSearch::kMinScore || is_taken(place.camera_from_marker, index) ||
        are_alike(place.camera_from_marker, starts_[index]))
      return;
    const MarkerObservation before = observations_[index];
    are_elsewhere_[index] = track.measure_recovered(frame, place.camera_from_marker, observations_[index]);
    if (!are_elsewhere_[index]) observations_[index].state = before.state;
  }

  [[nodiscard]] bool is_taken(const RigidTransform& pose, std::size_t index) const {
    for (std::size_t i = 0; i < tracks_.size(); ++i) {
      if (i != index && observations_[i].is_tracked() && stands_at(i, pose.translation_mm)) return true;
    }
    return false;
  }

  // The marker's middle is seen less than half of its side from this point.
  [[nodiscard]] bool stands_at(std::size_t index, const Eigen::Vector3d& point_mm) const {
    const Eigen::Vector3d& middle_mm = observations_[index].camera_from_marker.translation_mm;
    const double distance_mm = std::max(middle_mm.norm(), point_mm.norm());
    return (middle_mm.normalized() - point_mm.normalized()).norm() * distance_mm <
           0.5 * tracks_[index].marker().size_mm;
  }

  [[nodiscard]] bool is_of_another(const FoundSquare& square) const {
    return std::any_of(observations_.begin(), observations_.end(), [&](const MarkerObservation& seen) {
      return seen.is_tracked() && square.is_at(seen.corners_px);
    });
  }

  // Where one marker is seen no other one is: of one that is hidden by half nothing could be measured. The
  // one whose corners are less its own was the other's outline, and is forgotten.
  void leave_one_a_place() {
    for (std::size_t i = 0; i < tracks_.size(); ++i) {
      for (std::size_t k = 0; k < i; ++k) {
        if (!observations_[i].is_tracked() || !observations_[k].is_tracked() ||
            !stands_at(i, observations_[k].camera_from_marker.translation_mm))
          continue;
        const std::size_t none = observations_[i].rms_px > observations_[k].rms_px ? i : k;
        observations_[none].state = MarkerState::Doubtful;
        are_elsewhere_[none] = 0;
        tracks_[none].forget();
      }
    }
  }

  EdgeTrackerOptions options_;
  LinearTable light_;
  std::vector<MarkerCode> dictionary_;
  std::vector<MarkerCode> codes_;  // of the declared markers, in their order
  std::vector<MarkerTrack> tracks_;
  std::vector<MarkerObservation> observations_;
  std::vector<RigidTransform> starts_;       // of this frame, where they were followed to
  std::vector<MarkerCandidate> candidates_;  // of this frame's search
  SquareSearch search_;
  CodeSearch code_search_;
  SmearSearch smear_search_;
  std::vector<ExposedPose> motions_;
  CornerSearch corner_search_;
  std::vector<char> is_sought_;      // by marker
  std::vector<char> are_elsewhere_;  // by marker: tracked in this frame by now
  std::vector<Corners> seen_;
  MarkerCompany company_;
  std::vector<int> attempts_;                  // of this frame's search, by marker
  std::vector<std::int64_t> sought_since_ns_;  // by marker: when it was last tracked; below 0: no frame yet
  std::size_t frames_ = 0, searches_ = 0;
  std::int64_t interval_ns_ = kUsualIntervalNs, last_ns_ = -1;
  CameraSmear smear_;
  DirectFit direct_;
  int frames_since_search_ = 0;  // since one began, while there is no hurry
  bool is_for_covered_ = false;  // this search
  bool is_looked_at_ = false;    // this frame, by search_
};

}  // namespace

std::unique_ptr<MarkerTracker> make_edge_tracker(std::span<const DeclaredMarker> declared,
                                                 std::span<const MarkerCode> codes,
                                                 const EdgeTrackerOptions& options) {
  check_declaration(declared, static_cast<int>(codes.size()));
  return std::make_unique<EdgeTracker>(declared, codes, options);
}

std::unique_ptr<MarkerTracker> make_tracker(std::span<const DeclaredMarker> declared) {
  return make_edge_tracker(declared, codes_4x4_50());
}

}  // namespace arthronaut::markers
