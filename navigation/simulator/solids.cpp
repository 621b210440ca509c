#include "navigation/simulator/solids.h"

#include <array>
#include <cmath>
#include <opencv2/aruco.hpp>

#include "planning/geometry/error.h"

namespace arthronaut::simulator {
namespace {

const Skin kPaperSkin{{0.66f, 0.72f, 0.76f}, 0.02f, 4};
const Skin kInkSkin{{0.020f, 0.020f, 0.021f}, 0.01f, 4};
const Skin kSideSkin{{0.06f, 0.065f, 0.07f}, 0.05f, 5};
constexpr double kNearestMm = kNearest_mm;

void put(const Eigen::Vector3d& from, float (&to)[3]) {
  for (int i = 0; i < 3; ++i) to[i] = static_cast<float>(from[i]);
}

void put_columns(const Eigen::Matrix3d& from, float (&to)[3][3]) {
  for (int i = 0; i < 3; ++i) put(from.col(i), to[i]);
}

PrintNumbers numbers_of(const PrintedMarker& marker) {
  PrintNumbers print;
  const int count = marker.cells.count;
  if (count < 1 || count * count > 32 * PrintNumbers::kWords)
    throw InvalidInput("simulator: a marker has 1 to 16 cells each way");
  print.center_mm[0] = static_cast<float>(marker.center_mm.x());
  print.center_mm[1] = static_cast<float>(marker.center_mm.y());
  print.cells_per_mm = static_cast<float>(count / marker.size_mm);
  print.count = count;
  std::array<std::uint32_t, PrintNumbers::kWords> words{};
  for (std::size_t cell = 0; cell < marker.cells.is_white.size(); ++cell)
    words[cell / 32] |= std::uint32_t{marker.cells.is_white[cell]} << (cell % 32);
  for (std::size_t i = 0; i < words.size(); ++i) print.words[i] = static_cast<std::int32_t>(words[i]);
  return print;
}

// A ray in the plate's frame: origin + depth * direction.
struct LocalRay {
  Eigen::Vector3d origin, direction;
};

class Plate : public Solid {
 public:
  Plate(const geometry::RigidTransform& camera_from_plate, const PlateShape& shape)
      : shape_(shape),
        camera_from_plate_(camera_from_plate),
        rotation_(camera_from_plate.matrix()),
        origin_(camera_from_plate.inverse().translation_mm) {
    for (const PrintedMarker& marker : shape.markers) prints_.push_back(numbers_of(marker));
  }

  void meet(const RayRow& rays, int count, int first_part, const MetRow& met) const override {
    PlateNumbers plate;
    put_columns(rotation_, plate.axes);
    put(origin_, plate.origin_mm);
    for (int i = 0; i < 2; ++i) plate.half_size_mm[i] = static_cast<float>(shape_.half_size_mm[i]);
    plate.thickness_mm = static_cast<float>(shape_.thickness_mm);
    plate.tick_spacing_mm = static_cast<float>(shape_.tick_spacing_mm);
    plate.yields_mm = static_cast<float>(yields_mm);
    plate.is_round = shape_.is_round;
    plate.prints = prints_.data();
    plate.print_count = static_cast<int>(prints_.size());
    picture_kernel().meet_plate(plate, rays, count, first_part, met);
  }

  std::vector<Look> looks() const override {
    return {{kPaperSkin, true}, {kInkSkin, true}, {kSideSkin, false}};
  }

  bool hit(const Eigen::Vector3d& direction, SolidHit& hit) const override {
    const LocalRay ray{origin_, rotation_.transpose() * direction};
    return hit_face(ray, hit) || hit_side(ray, hit);
  }

  std::vector<Ball> cover() const override {
    // Squares of the plate's width, side by side along it; both faces and their corners lie in each one's
    // ball.
    const double half_width = shape_.is_round ? shape_.half_size_mm.x() : shape_.half_size_mm.minCoeff();
    const Eigen::Vector2d reach = shape_.is_round
                                      ? Eigen::Vector2d(0, 0)
                                      : Eigen::Vector2d((shape_.half_size_mm.array() - half_width).matrix());
    const int count = 1 + static_cast<int>(std::ceil(reach.maxCoeff() / half_width));
    std::vector<Ball> balls;
    for (int i = 0; i < count; ++i) {
      const double along = count == 1 ? 0 : -1 + 2.0 * i / (count - 1);
      balls.push_back({camera_from_plate_ *
                           Eigen::Vector3d(along * reach.x(), along * reach.y(), -0.5 * shape_.thickness_mm),
                       std::hypot(std::sqrt(2.0) * half_width, 0.5 * shape_.thickness_mm)});
    }
    return balls;
  }

 private:
  bool hit_face(const LocalRay& ray, SolidHit& hit) const {
    if (ray.direction.z() >= 0) return false;  // seen from behind
    const double depth = -ray.origin.z() / ray.direction.z();
    if (depth < kNearestMm) return false;
    const Eigen::Vector2d at = (ray.origin + depth * ray.direction).head<2>();
    if (!is_on_face(at)) return false;
    hit.depth_mm = depth;
    hit.normal = rotation_.col(2);
    hit.region = is_ink(at) ? kInk : kPaper;
    return true;
  }

  bool is_on_face(const Eigen::Vector2d& at) const {
    if (shape_.is_round) return at.squaredNorm() <= shape_.half_size_mm.x() * shape_.half_size_mm.x();
    return std::abs(at.x()) <= shape_.half_size_mm.x() && std::abs(at.y()) <= shape_.half_size_mm.y();
  }

  bool is_ink(const Eigen::Vector2d& at) const {
    for (const PrintedMarker& marker : shape_.markers) {
      const int count = marker.cells.count;
      const double column = ((at.x() - marker.center_mm.x()) / marker.size_mm + 0.5) * count;
      const double row = (0.5 - (at.y() - marker.center_mm.y()) / marker.size_mm) * count;
      if (column >= 0 && column < count && row >= 0 && row < count) {
        const int cell = static_cast<int>(row) * count + static_cast<int>(column);
        return !marker.cells.is_white[static_cast<std::size_t>(cell)];
      }
    }
    if (shape_.tick_spacing_mm <= 0) return false;
    // Every fifth tick is twice as long.
    const double ticks = at.x() / shape_.tick_spacing_mm;
    const double nearest = std::round(ticks);
    const double length = std::fmod(std::abs(nearest), 5.0) == 0 ? 2.0 : 1.0;
    return std::abs(ticks - nearest) * shape_.tick_spacing_mm < 0.06 &&
           at.y() > shape_.half_size_mm.y() - length;
  }

  bool hit_side(const LocalRay& ray, SolidHit& hit) const {
    return shape_.is_round ? hit_round_side(ray, hit) : hit_flat_sides(ray, hit);
  }

  bool hit_round_side(const LocalRay& ray, SolidHit& hit) const {
    const Eigen::Vector2d o = ray.origin.head<2>(), d = ray.direction.head<2>();
    const double a = d.squaredNorm(), b = o.dot(d);
    const double c = o.squaredNorm() - shape_.half_size_mm.x() * shape_.half_size_mm.x();
    const double root = b * b - a * c;
    if (root < 0 || a < 1e-12) return false;
    return accept_side((-b - std::sqrt(root)) / a, ray, hit, [&](const Eigen::Vector3d& at) {
      return Eigen::Vector3d(at.x(), at.y(), 0).normalized();
    });
  }

  bool hit_flat_sides(const LocalRay& ray, SolidHit& hit) const {
    for (int axis = 0; axis < 2; ++axis) {
      const double speed = ray.direction[axis];
      if (std::abs(speed) < 1e-12) continue;
      const double sign = speed > 0 ? -1 : 1;
      const double depth = (sign * shape_.half_size_mm[axis] - ray.origin[axis]) / speed;
      const double across = (ray.origin + depth * ray.direction)[1 - axis];
      if (std::abs(across) > shape_.half_size_mm[1 - axis]) continue;
      if (accept_side(depth, ray, hit, [&](const Eigen::Vector3d&) -> Eigen::Vector3d {
            return sign * Eigen::Vector3d::Unit(axis);
          })) {
        return true;
      }
    }
    return false;
  }

  template <class Normal>
  bool accept_side(double depth, const LocalRay& ray, SolidHit& hit, Normal normal) const {
    const Eigen::Vector3d at = ray.origin + depth * ray.direction;
    if (depth < kNearestMm || at.z() > 0 || at.z() < -shape_.thickness_mm) return false;
    hit.depth_mm = depth;
    hit.normal = rotation_ * normal(at);
    hit.region = kSide;
    return true;
  }

  PlateShape shape_;
  geometry::RigidTransform camera_from_plate_;
  Eigen::Matrix3d rotation_;
  Eigen::Vector3d origin_;  // of the camera, in the plate's frame
  std::vector<PrintNumbers> prints_;
};

class Checkerboard : public Solid {
 public:
  Checkerboard(const geometry::RigidTransform& camera_from_board, double square_mm)
      : rotation_(camera_from_board.matrix()),
        origin_(camera_from_board.inverse().translation_mm),
        square_mm_(square_mm) {}

  bool hit(const Eigen::Vector3d& direction, SolidHit& hit) const override {
    const Eigen::Vector3d local = rotation_.transpose() * direction;
    if (std::abs(local.z()) < 1e-9) return false;
    const double depth = -origin_.z() / local.z();
    if (depth < kNearestMm) return false;
    const Eigen::Vector2d at = (origin_ + depth * local).head<2>() / square_mm_;
    hit.depth_mm = depth;
    hit.normal = rotation_.col(2) * (origin_.z() > 0 ? 1 : -1);
    hit.region =
        (static_cast<long>(std::floor(at.x())) + static_cast<long>(std::floor(at.y()))) & 1 ? kPaper : kInk;
    return true;
  }

  void meet(const RayRow& rays, int count, int first_part, const MetRow& met) const override {
    BoardNumbers board;
    put_columns(rotation_, board.axes);
    put(origin_, board.origin_mm);
    board.square_mm = static_cast<float>(square_mm_);
    board.yields_mm = static_cast<float>(yields_mm);
    picture_kernel().meet_board(board, rays, count, first_part, met);
  }

  std::vector<Look> looks() const override { return {{kPaperSkin, true}, {kInkSkin, true}}; }

  std::vector<Ball> cover() const override { return {}; }

 private:
  Eigen::Matrix3d rotation_;
  Eigen::Vector3d origin_;
  double square_mm_;
};

class Rod : public Solid {
 public:
  Rod(const Eigen::Vector3d& from_mm, const Eigen::Vector3d& to_mm, double radius_mm, const Skin& skin)
      : from_(from_mm), along_(to_mm - from_mm), radius_(radius_mm), length_(along_.norm()), skin_(skin) {
    along_ /= length_;
  }

  bool hit(const Eigen::Vector3d& direction, SolidHit& hit) const override {
    // The cylinder about the axis, in the plane across it.
    const Eigen::Vector3d d = direction - along_.dot(direction) * along_;
    const Eigen::Vector3d o = -from_ + along_.dot(from_) * along_;
    const double a = d.squaredNorm(), b = o.dot(d), c = o.squaredNorm() - radius_ * radius_;
    const double root = b * b - a * c;
    if (root < 0) return false;
    if (a > 1e-12) {
      const double depth = (-b - std::sqrt(root)) / a;
      const double position = along_.dot(depth * direction - from_);
      if (depth > kNearestMm && position >= 0 && position <= length_) {
        return accept(depth, direction, from_ + position * along_, hit);
      }
    }
    return hit_end(direction, from_, hit) || hit_end(direction, from_ + length_ * along_, hit);
  }

  void meet(const RayRow& rays, int count, int first_part, const MetRow& met) const override {
    RodNumbers rod;
    put(from_, rod.from_mm);
    put(along_, rod.along);
    rod.radius_mm = static_cast<float>(radius_);
    rod.length_mm = static_cast<float>(length_);
    rod.yields_mm = static_cast<float>(yields_mm);
    picture_kernel().meet_rod(rod, rays, count, first_part, met);
  }

  std::vector<Look> looks() const override { return {{skin_, false}}; }

  std::vector<Ball> cover() const override {
    std::vector<Ball> balls;
    const int count = 2 + static_cast<int>(length_ / radius_);
    for (int i = 0; i < count; ++i) {
      // Half-way between two centres the rod's surface is still inside: the spacing is at most one radius.
      balls.push_back({from_ + length_ * i / (count - 1) * along_, 1.15 * radius_});
    }
    return balls;
  }

 private:
  bool hit_end(const Eigen::Vector3d& direction, const Eigen::Vector3d& center, SolidHit& hit) const {
    const double a = direction.squaredNorm(), b = -center.dot(direction);
    const double root = b * b - a * (center.squaredNorm() - radius_ * radius_);
    if (root < 0) return false;
    const double depth = (-b - std::sqrt(root)) / a;
    return depth > kNearestMm && accept(depth, direction, center, hit);
  }

  bool accept(double depth, const Eigen::Vector3d& direction, const Eigen::Vector3d& axis_point,
              SolidHit& hit) const {
    hit.depth_mm = depth;
    hit.normal = (depth * direction - axis_point) / radius_;
    hit.region = 0;
    return true;
  }

  Eigen::Vector3d from_, along_;
  double radius_, length_;
  Skin skin_;
};

}  // namespace

MarkerCells marker_cells(int id) {
  static const auto all = [] {
    std::array<MarkerCells, 50> drawn{};
    const auto dictionary = cv::aruco::getPredefinedDictionary(cv::aruco::DICT_4X4_50);
    for (int marker = 0; marker < 50; ++marker) {
      cv::Mat picture;
      cv::aruco::drawMarker(dictionary, marker, 6, picture, 1);
      MarkerCells& cells = drawn[static_cast<std::size_t>(marker)];
      cells.count = 6;
      for (int i = 0; i < 36; ++i) cells.is_white.push_back(picture.at<std::uint8_t>(i / 6, i % 6) > 0);
    }
    return drawn;
  }();
  return all.at(static_cast<std::size_t>(id));
}

std::unique_ptr<Solid> make_plate(const geometry::RigidTransform& camera_from_plate,
                                  const PlateShape& shape) {
  return std::make_unique<Plate>(camera_from_plate, shape);
}

std::unique_ptr<Solid> make_checkerboard(const geometry::RigidTransform& camera_from_board,
                                         double square_mm) {
  return std::make_unique<Checkerboard>(camera_from_board, square_mm);
}

std::unique_ptr<Solid> make_rod(const Eigen::Vector3d& from_mm, const Eigen::Vector3d& to_mm,
                                double radius_mm, const Skin& skin) {
  return std::make_unique<Rod>(from_mm, to_mm, radius_mm, skin);
}

Skin steel() { return {{0.075f, 0.078f, 0.08f}, 1.1f, 5}; }

}  // namespace arthronaut::simulator
