// Global registration of touched curves to the bone's surface, with no initial guess: pairs of curve points
// with tangents against pairs of surface points with normals, hypothesise and test, robust refinement, a last
// fit along the strokes on the exact mesh; and a verdict about itself.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "navigation/strokes/curves.h"
#include "planning/geometry/rigid_transform.h"
#include "planning/geometry/triangle_mesh.h"

namespace arthronaut::registration {

// The bone made ready: distance field, oriented surface samples, pair table, exact tree. Immutable; shared by
// threads.
class SurfaceIndex {
 public:
  // mesh: closed, outward, mm. Throws InvalidInput when it is empty.
  explicit SurfaceIndex(const geometry::TriangleMesh& mesh);
  // The same, and kept in a file for the next time. A file that is absent, broken, of another mesh or of
  // another version is made again, and one that cannot be written is done without: a cache changes nothing
  // but the time.
  SurfaceIndex(const geometry::TriangleMesh& mesh, const std::filesystem::path& cache_file);
  ~SurfaceIndex();
  SurfaceIndex(SurfaceIndex&&) noexcept;
  SurfaceIndex& operator=(SurfaceIndex&&) noexcept;

  struct Data;
  [[nodiscard]] const Data& data() const { return *data_; }

 private:
  std::unique_ptr<const Data> data_;
};

// The part of the bone that cartilage covers where the mesh is bare bone, or the other way round.
struct CartilageRegion {
  std::vector<Eigen::Vector3d> points_mm;  // bone frame; the region is what lies within reach of one of them
  double reach_mm = 4;
};

struct RegistrationOptions {
  std::uint64_t seed = 1;
  bool use_marker_prior = true;  // the world marker sits on the bone
  std::optional<Eigen::Vector3d>
      target_in_bone_mm;  // where predicted_tre_mm holds; else the centroid of the points
  // The planned tunnel's entry: strokes are looked for within reach of it first, and everywhere when they
  // don't lie there.
  std::optional<Eigen::Vector3d> plan_entry_in_bone_mm = std::nullopt;
  // Its thickness is solved, or it is left out when the strokes don't hold it; the assumptions say which.
  std::optional<CartilageRegion> cartilage = std::nullopt;
};

// What a registration made of the cartilage. None: without one, or it was taken to lie on the mesh.
enum class CartilageUse { None, Solved, LeftOut };

// A pose that is predicted to be off by more at the target is not relied on.
inline constexpr double kMaxError_mm = 1.2;
// RegistrationSummary::runner_up_ratio: below the first two poses fit alike, and while drawing neither is a
// candidate; the second, and no more, is said where none comes near.
inline constexpr double kAlikeRatio = 1.15, kNoRivalRatio = 10;

// What the verdict on a pose rests on besides the error at the target, for experiments that set its
// thresholds.
struct VerdictEvidence {
  double length_in_use_mm = 0;  // of the strokes, smoothed; less what lies on cartilage that was left out
  double white_noise_mm = 0;    // of the tip, one coordinate
  // By how much the points miss the surface beyond what such noise explains, and how much is borne.
  double excess_misfit_mm = 0, bearable_excess_mm = 0;
  // Over the next pose, in independent measurements' log likelihood.
  double lead = 0;
  // Over the strokes' best pose on the mirror image of the bone, likewise; empty where that was not tried.
  std::optional<double> side_lead = std::nullopt;
  // At the target, one sigma, as the strokes hold it: less what an error of their scale may add.
  double error_by_strokes_mm = 0;
  // That the pose is the right one, by all of these and the predicted error; and how much it takes to rely on
  // it.
  double log_odds = 0, needed_log_odds = 0;
};

// How large the strokes are beside the bone, whatever even layer lies on that: 1.03 is 3 % too large. One
// sigma.
struct StrokeScale {
  double ratio = 1, sigma = 0;
};

struct RegistrationSummary {
  bool has_pose = false;  // false: nothing was found, the pose below is meaningless
  bool reliable = false;
  std::vector<std::string> reasons = {"no registration was run"};  // why it is not reliable; empty when it is
  std::vector<std::string> assumptions;  // what was taken for granted or left out, in plain words
  CartilageUse cartilage_use = CartilageUse::None;
  double cartilage_thickness_mm = 0;  // where it was solved: how far off the mesh the probe touches there
  geometry::RigidTransform marker_from_bone;
  geometry::Matrix6d covariance =
      geometry::Matrix6d::Zero();  // of the body twist of marker_from_bone, correlated errors in
  double rms_mm = 0;               // of the inliers
  double inlier_fraction = 0;
  int point_count = 0;
  double predicted_tre_mm = 0;  // one sigma, at the target; with what an error of the strokes' scale may add
  // Signed distance of each curve point to what was touched, in the order given: to the bone's mesh, and on
  // cartilage whose thickness was solved, to a surface that far off the mesh. On cartilage that was left out,
  // to the mesh.
  std::vector<double> point_residuals_mm;
  // How near the best different solution came: e to the power of its robust cost less the best one's (cost:
  // negative log likelihood, the mean of the points). Large is good: 1 fits alike, kNoRivalRatio is the most.
  double runner_up_ratio = 0;
  // What the residuals hold beyond the tip's own white noise, root mean square: slow errors of tracking, and
  // above all a bone that is another one than the mesh's. Judged inside the bone, where lifting and soft
  // tissue don't reach. What the pose took up of it, which is much with few strokes, is put back.
  double misfit_mm = 0;
  // What the residuals of different stretches of stroke share where they cross: the shape's own miss, since
  // errors of the tip differ from stretch to stretch.
  double shared_misfit_mm = 0;
  StrokeScale stroke_scale;
  VerdictEvidence evidence;
};

// Deterministic for a seed. Never throws on poor data: read the summary.
[[nodiscard]] RegistrationSummary register_curves(const SurfaceIndex& bone, const strokes::Curves& curves,
                                                  const RegistrationOptions& options = {});

// One-sigma error in mm that the covariance predicts at a point of the bone frame.
[[nodiscard]] double predicted_error_mm(const RegistrationSummary& registration,
                                        const Eigen::Vector3d& point_in_bone_mm);

// How far off the mesh the probe touches at a place of the bone's surface, by a registration that was told of
// the region; nullopt where that is not known.
[[nodiscard]] std::optional<double> cartilage_offset_mm(const RegistrationSummary& registration,
                                                        const CartilageRegion& region,
                                                        const Eigen::Vector3d& place_in_bone_mm);

}  // namespace arthronaut::registration
