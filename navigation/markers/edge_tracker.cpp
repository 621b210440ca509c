#include "navigation/markers/edge_tracker.h"

#include <algorithm>

#include "navigation/markers/code_reader.h"
#include "navigation/markers/declaration.h"
#include "navigation/markers/linear_image.h"
#include "navigation/markers/marker_track.h"
#include "navigation/markers/square_search.h"
#include "planning/geometry/error.h"

namespace arthronaut::markers {
namespace {

using geometry::RigidTransform;

constexpr std::size_t kLikelyCandidates = 256;  // memory set aside

class EdgeTracker final : public MarkerTracker {
 public:
  EdgeTracker(std::span<const DeclaredMarker> declared, std::span<const MarkerCode> codes,
              const EdgeTrackerOptions& options)
      : options_(options), light_(options.gamma) {
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
    const TrackedFrame tracked{image, camera, timestamp_ns, smear_,
                               options_.fit_directly ? &direct_ : nullptr};
    candidates_.clear();
    bool missing = false;
    for (std::size_t i = 0; i < tracks_.size(); ++i) {
      observations_[i] = MarkerObservation();
      observations_[i].id = tracks_[i].marker().id;
      const auto start = tracks_[i].predicted(timestamp_ns);
      missing |= !start || !tracks_[i].measure(tracked, *start, false, observations_[i]);
    }
    if (missing || frames_to_search_-- <= 0) {
      frames_to_search_ = options_.search_every_frames - 1;
      search(tracked);
    }
    for (std::size_t i = 0; i < tracks_.size(); ++i) {
      if (tracks_[i].is_duplicate && observations_[i].is_tracked())
        observations_[i].state = MarkerState::Duplicate;
      tracks_[i].follow(observations_[i], timestamp_ns);
    }
    return observations_;
  }

  [[nodiscard]] std::span<const MarkerCandidate> candidates() const override { return candidates_; }

  void reset() override {
    candidates_.clear();
    observations_.assign(tracks_.size(), MarkerObservation());
    for (std::size_t i = 0; i < tracks_.size(); ++i) {
      tracks_[i].forget();
      observations_[i].id = tracks_[i].marker().id;
    }
    smear_ = CameraSmear();
    smear_.gamma = options_.gamma;
    smear_.bloom.sigma_px = options_.bloom_sigma_px;
    frames_to_search_ = 0;
  }

 private:
  void search(const TrackedFrame& frame) {
    for (MarkerTrack& track : tracks_) track.is_duplicate = false;
    for (const FoundSquare& square : search_.find(frame.image.view(), frame.camera)) {
      const auto code = read_code(frame.image, frame.camera, square.tangent, codes_);
      candidates_.push_back({square.corners_px, code ? codes_[code->index].id : MarkerCandidate::kNoCode});
      if (!code) continue;
      MarkerTrack& track = tracks_[code->index];
      MarkerObservation& known = observations_[code->index];
      if (known.is_tracked()) {
        track.is_duplicate |= !is_same_place(square, known);
        continue;
      }
      acquire(track, square, code->turn, frame, known);
    }
  }

  static void acquire(MarkerTrack& track, const FoundSquare& square, int turn, const TrackedFrame& frame,
                      MarkerObservation& observation) {
    Corners tangent;
    for (int i = 0; i < 4; ++i) tangent[i] = square.tangent[(turn + i) % 4];
    const auto homography = square_homography(tangent, track.marker().size_mm);
    if (!homography) return;
    for (const RigidTransform& start : poses_from_homography(*homography)) {
      if (!(start.translation_mm.z() > 0)) continue;
      if (track.measure(frame, start, true, observation)) return;
    }
  }

  static bool is_same_place(const FoundSquare& square, const MarkerObservation& known) {
    Eigen::Vector2d apart = Eigen::Vector2d::Zero();
    for (int i = 0; i < 4; ++i) apart += 0.25 * (square.corners_px[i] - known.corners_px[i]);
    return apart.norm() < 0.5 * square.longest_side_px;
  }

  EdgeTrackerOptions options_;
  LinearTable light_;
  std::vector<MarkerCode> codes_;  // of the declared markers, in their order
  std::vector<MarkerTrack> tracks_;
  std::vector<MarkerObservation> observations_;
  std::vector<MarkerCandidate> candidates_;  // of this frame's search
  SquareSearch search_;
  CameraSmear smear_;
  DirectFit direct_;
  int frames_to_search_ = 0;
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
