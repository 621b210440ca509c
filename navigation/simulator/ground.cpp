#include "navigation/simulator/ground.h"

#include <algorithm>
#include <cmath>

#include "navigation/simulator/light.h"

namespace arthronaut::simulator {
namespace {

// Neighbours whose depths differ by more do not lie on one surface, or on one that is seen very aslant.
constexpr float kOneSurface = 1.01f;

// The capsule behind the bone: red, far and without detail. Without it the rim would stand on black.
Eigen::Vector3f backdrop(const Eigen::Vector2d& tangent, float exposure) {
  constexpr float kFarMm = 36;
  static const Skin kTissue{{0.10f, 0.12f, 0.34f}, 0, 1};
  const Eigen::Vector3f direction = tangent.homogeneous().cast<float>();
  return lit(kFarMm * direction, -direction.normalized(), kTissue, exposure);
}

}  // namespace

Ground::Ground(const BoneView* bone, const std::vector<BonePixel>& bone_pixels, const PixelArea& area,
               const camera::Boundary& boundary, const RayTable& rays, float exposure)
    : bone_(bone),
      bone_pixels_(bone_pixels),
      area_(area),
      boundary_(boundary),
      rays_(rays),
      exposure_(exposure) {}

float Ground::depth_at(int column, int row) const {
  return bone_pixels_[static_cast<std::size_t>(row) * static_cast<std::size_t>(area_.width) +
                      static_cast<std::size_t>(column)]
      .depth_mm;
}

Eigen::Vector3f Ground::shade(int column, int row) const {
  const BonePixel& pixel =
      bone_pixels_[static_cast<std::size_t>(row) * static_cast<std::size_t>(area_.width) +
                   static_cast<std::size_t>(column)];
  return pixel.triangle >= 0 ? bone_->shade(pixel, exposure_)
                             : backdrop(rays_.tangent(column + area_.left, row + area_.top), exposure_);
}

// Light that the field stop will not pass need not be computed.
std::array<int, 2> Ground::open_columns(int row) const {
  const double dy = row + area_.top - boundary_.center_px.y(), radius = boundary_.radius_px + 4;
  if (std::abs(dy) >= radius) return {0, 0};
  const double reach = std::sqrt(radius * radius - dy * dy);
  const double center = boundary_.center_px.x() - area_.left;
  const int first = std::clamp(static_cast<int>(std::ceil(center - reach)), 0, area_.width);
  return {first, std::clamp(static_cast<int>(std::floor(center + reach)) + 1, first, area_.width)};
}

// The even columns of an even row, with one beyond the open ones each way.
void Ground::shade_nodes(int row, std::vector<Node>& nodes) const {
  const auto wider = [&](int other) {
    const auto a = open_columns(row), b = open_columns(std::clamp(other, 0, area_.height - 1));
    if (a[0] == a[1]) return b;
    if (b[0] == b[1]) return a;
    return std::array<int, 2>{std::min(a[0], b[0]), std::max(a[1], b[1])};
  };
  // The rows above and below take of these nodes, too, and may be open further.
  const auto above = wider(row - 1), below = wider(row + 1);
  const int first = std::max(0, std::min(above[0], below[0]) / 2 - 1);
  const int last = std::min((area_.width - 1) / 2, (std::max(above[1], below[1]) + 1) / 2 + 1);
  for (int node = first; node <= last; ++node) {
    nodes[static_cast<std::size_t>(node)] = {shade(2 * node, row), depth_at(2 * node, row)};
  }
}

void Ground::draw_rows(int first, int end, Eigen::Vector3f* light) const {
  std::vector<Node> above(static_cast<std::size_t>(area_.width / 2 + 2)), below(above.size());
  const auto last_node_row = (area_.height - 1) / 2 * 2;
  int held_row = -1;  // the row of `above`
  for (int row = first; row < end; ++row) {
    Eigen::Vector3f* out = light + static_cast<std::ptrdiff_t>(row) * area_.width;
    std::fill_n(out, area_.width, Eigen::Vector3f::Zero());
    const int upper = row / 2 * 2, lower = std::min(upper + 2, last_node_row);
    if (held_row != upper) {
      if (held_row >= 0) {
        std::swap(above, below);
      } else {
        shade_nodes(upper, above);
      }
      if (lower != upper) shade_nodes(lower, below);
      held_row = upper;
    }
    const std::vector<Node>& under = row == upper || lower == upper ? above : below;
    const auto [open_first, open_end] = open_columns(row);
    for (int column = open_first; column < open_end; ++column) {
      const auto node = static_cast<std::size_t>(column / 2);
      const std::size_t next = 2 * (column / 2 + 1) < area_.width && column % 2 == 1 ? node + 1 : node;
      const std::array<const Node*, 4> around{&above[node], &above[next], &under[node], &under[next]};
      const float depth = depth_at(column, row);
      const bool is_one = std::all_of(around.begin(), around.end(), [&](const Node* n) {
        return n->depth_mm < kOneSurface * depth && depth < kOneSurface * n->depth_mm;
      });
      out[column] = is_one ? Eigen::Vector3f(0.25f * (around[0]->light + around[1]->light + around[2]->light +
                                                      around[3]->light))
                           : shade(column, row);
    }
  }
}

}  // namespace arthronaut::simulator
