#include "navigation/registration/search/global_search.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "navigation/registration/search/shaft_collision.h"

namespace arthronaut::registration {

namespace {

using strokes::OrientedPoint;

struct RoughPose {
  Eigen::Matrix3f rotation;  // bone_from_marker
  Eigen::Vector3f translation_mm;
  float score = 0;
};

struct CurvePair {
  Eigen::Vector3f first, second, first_tangent, second_tangent;
};

// Where the world marker may be: the plate of a screw head above the bone, its face outwards. Wider than what
// is usual, since a hypothesis is off by some degrees and the field's nearest node by up to 0.4 mm.
constexpr float kMinMarkerHeight_mm = -0.2f, kMaxMarkerHeight_mm = 4.5f;
constexpr float kMinMarkerCosine = 0.70f;

// A marker that the camera sees is not inside the bone, whatever it is fixed to.
constexpr float kMinSeenHeight_mm = -1.0f;

constexpr float kScoreReach_mm = 1.5f;

class Search {
 public:
  Search(const SurfaceIndex::Data& bone, const WeightedPoints& points, const GlobalSearchOptions& options)
      : bone_(bone),
        options_(options),
        shaft_collision_(bone, points),
        center_(points.centroid_mm.cast<float>()) {
    const WeightedPoints drawn = draw_points(points, kTestPointCount, options.seed);
    for (const Eigen::Vector3d& p : drawn.positions_mm) test_points_.push_back(p.cast<float>());
  }

  void add_pair(const CurvePair& pair) {
    add_ordered_pair(pair);
    if (options_.both_ways)
      add_ordered_pair({pair.second, pair.first, pair.second_tangent, pair.first_tangent});
  }

  // Best first, near twins left out.
  std::vector<Hypothesis> take() {
    std::sort(found_.begin(), found_.end(),
              [](const RoughPose& l, const RoughPose& r) { return l.score > r.score; });
    std::vector<RoughPose> kept;
    for (const RoughPose& pose : found_) {
      if (kept.size() == options_.keep_count) break;
      const bool is_new =
          std::none_of(kept.begin(), kept.end(), [&](const RoughPose& k) { return is_twin(pose, k); });
      if (is_new) kept.push_back(pose);
    }
    std::vector<Hypothesis> hypotheses;
    for (const RoughPose& pose : kept) {
      Hypothesis hypothesis;
      hypothesis.bone_from_marker.rotation = Eigen::Quaterniond(pose.rotation.cast<double>()).normalized();
      hypothesis.bone_from_marker.translation_mm = pose.translation_mm.cast<double>();
      hypothesis.score = pose.score / static_cast<double>(test_points_.size());
      hypotheses.push_back(hypothesis);
    }
    return hypotheses;
  }

 private:
  static constexpr std::size_t kTestPointCount = 60, kTogether = 32;

  void add_ordered_pair(const CurvePair& pair) {
    matches_.clear();
    bone_.pairs.find_matches(shape_of(pair.first, pair.first_tangent, pair.second, pair.second_tangent), {},
                             matches_);
    const Eigen::Vector3f e = (pair.second - pair.first).normalized();
    const Eigen::Vector3f across = (pair.first_tangent - pair.first_tangent.dot(e) * e).normalized();
    Eigen::Matrix3f curve_axes;  // rows
    curve_axes << e.transpose(), across.transpose(), e.cross(across).transpose();
    const Eigen::Vector3f curve_middle = 0.5f * (pair.first + pair.second);
    const std::vector<SurfaceSample>& samples = bone_.pairs.samples();
    for (const PairTable::Match& match : matches_) {
      if (options_.reachable && !((*options_.reachable)[match.first] && (*options_.reachable)[match.second]))
        continue;
      const SurfaceSample &first = samples[match.first], &second = samples[match.second];
      const Eigen::Vector3f surface_e = (second.point_mm - first.point_mm).normalized();
      const Eigen::Vector3f normal = (first.normal - first.normal.dot(surface_e) * surface_e).normalized();
      const Eigen::Vector3f turned =
          std::cos(match.turn_rad) * normal + std::sin(match.turn_rad) * surface_e.cross(normal);
      Eigen::Matrix3f surface_axes;  // columns
      surface_axes << surface_e, turned, surface_e.cross(turned);
      RoughPose pose;
      pose.rotation = surface_axes * curve_axes;
      pose.translation_mm = 0.5f * (first.point_mm + second.point_mm) - pose.rotation * curve_middle;
      bone_.coarse_field.expect(pose.translation_mm);
      supposed_.push_back(pose);
      if (supposed_.size() == kTogether) judge_supposed();
    }
    judge_supposed();
  }

  // All of them through one check after the other, so that the look-ups of many are under way at a time.
  void judge_supposed() {
    const auto drop = [this](const auto& is_out) {
      supposed_.erase(std::remove_if(supposed_.begin(), supposed_.end(), is_out), supposed_.end());
    };
    drop([this](const RoughPose& pose) {
      const float height_mm = bone_.coarse_field.nearest_mm(pose.translation_mm);
      if (height_mm < kMinSeenHeight_mm) return true;
      if (!options_.use_marker_prior) return false;
      if (height_mm < kMinMarkerHeight_mm || height_mm > kMaxMarkerHeight_mm) return true;
      bone_.field.expect(pose.translation_mm.cast<double>());
      return false;
    });
    if (options_.use_marker_prior) drop([this](const RoughPose& pose) { return !marker_may_face(pose); });
    for (RoughPose& pose : supposed_) {
      pose.score = score_of(pose);
      if (pose.score > 0 && shaft_collision_.is_possible(pose.rotation, pose.translation_mm)) keep(pose);
    }
    supposed_.clear();
  }

  [[nodiscard]] bool marker_may_face(const RoughPose& pose) const {
    const Eigen::Vector3d up = bone_.field.sample(pose.translation_mm.cast<double>()).gradient;
    return up.dot(pose.rotation.col(2).cast<double>()) > kMinMarkerCosine * up.norm();
  }

  // 0 as soon as too few of the first points lie on the bone.
  [[nodiscard]] float score_of(const RoughPose& pose) const {
    struct Checkpoint {
      std::size_t count;
      float least_share;
    };
    static constexpr std::array<Checkpoint, 3> kWayOut{{{10, 0.20f}, {20, 0.26f}, {40, 0.32f}}};
    std::size_t checkpoint = 0;
    float score = 0;
    for (std::size_t i = 0; i < test_points_.size(); ++i) {
      if (checkpoint < kWayOut.size() && i == kWayOut[checkpoint].count) {
        if (score < kWayOut[checkpoint].least_share * static_cast<float>(i)) return 0;
        ++checkpoint;
      }
      const float distance =
          bone_.coarse_field.nearest_mm(pose.rotation * test_points_[i] + pose.translation_mm);
      score += std::max(0.0f, 1 - distance * distance / (kScoreReach_mm * kScoreReach_mm));
    }
    return score;
  }

  [[nodiscard]] bool is_twin(const RoughPose& a, const RoughPose& b) const {
    constexpr float kMaxDistance_mm = 3.0f, kMaxAngle_rad = 0.15f;
    const Eigen::Vector3f apart =
        a.rotation * center_ + a.translation_mm - b.rotation * center_ - b.translation_mm;
    if (apart.squaredNorm() > kMaxDistance_mm * kMaxDistance_mm) return false;
    const float trace = (a.rotation.transpose() * b.rotation).trace();
    return trace > 1 + 2 * std::cos(kMaxAngle_rad);
  }

  // Room for the best few thousand: the worse half goes when it is full.
  void keep(const RoughPose& pose) {
    constexpr std::size_t kRoom = 4000;
    found_.push_back(pose);
    if (found_.size() < kRoom) return;
    std::nth_element(found_.begin(), found_.begin() + kRoom / 2, found_.end(),
                     [](const RoughPose& l, const RoughPose& r) { return l.score > r.score; });
    found_.resize(kRoom / 2);
  }

  const SurfaceIndex::Data& bone_;
  const GlobalSearchOptions& options_;
  ShaftCollision shaft_collision_;
  Eigen::Vector3f center_;
  std::vector<Eigen::Vector3f> test_points_;
  std::vector<PairTable::Match> matches_;
  std::vector<RoughPose> supposed_;  // a few at a time
  std::vector<RoughPose> found_;
};

// Pairs far apart with tangents well across the baseline say most about the pose.
std::vector<CurvePair> draw_curve_pairs(const std::vector<OrientedPoint>& oriented, const PairTable& table,
                                        int count, std::uint64_t seed) {
  constexpr int kTriesPerPair = 200;
  constexpr float kMinSine = 0.5f, kMargin_mm = 1.0f;
  std::vector<CurvePair> pairs;
  if (oriented.size() < 2) return pairs;
  std::mt19937_64 random(seed);
  const auto uniform = [&random] { return static_cast<float>(random() >> 40) * 0x1p-24f; };
  const float min_mm = static_cast<float>(table.min_distance_mm()) + kMargin_mm;
  const float max_mm = static_cast<float>(table.max_distance_mm()) - kMargin_mm;
  for (int attempt = 0; attempt < kTriesPerPair * count && static_cast<int>(pairs.size()) < count;
       ++attempt) {
    const OrientedPoint &first = oriented[random() % oriented.size()],
                        &second = oriented[random() % oriented.size()];
    const CurvePair pair{first.position_mm.cast<float>(), second.position_mm.cast<float>(),
                         first.tangent.cast<float>(), second.tangent.cast<float>()};
    const PairShape shape = shape_of(pair.first, pair.first_tangent, pair.second, pair.second_tangent);
    if (shape.distance_mm < min_mm || shape.distance_mm > max_mm) continue;
    const float first_sine = std::sqrt(std::max(0.0f, 1 - shape.cos_first * shape.cos_first));
    const float second_sine = std::sqrt(std::max(0.0f, 1 - shape.cos_second * shape.cos_second));
    if (first_sine < kMinSine || second_sine < kMinSine) continue;
    if (uniform() < shape.distance_mm / max_mm * first_sine * second_sine) pairs.push_back(pair);
  }
  return pairs;
}

}  // namespace

std::vector<Hypothesis> search_globally(const SurfaceIndex::Data& bone,
                                        const std::vector<OrientedPoint>& oriented,
                                        const WeightedPoints& points, const GlobalSearchOptions& options) {
  Search search(bone, points, options);
  for (const CurvePair& pair :
       draw_curve_pairs(oriented, bone.pairs, options.curve_pair_count, options.seed)) {
    search.add_pair(pair);
  }
  return search.take();
}

}  // namespace arthronaut::registration
