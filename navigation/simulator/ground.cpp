#include "navigation/simulator/ground.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "navigation/simulator/picture_kernel.h"

namespace arthronaut::simulator {
namespace {

// Neighbours whose depths differ by more do not lie on one surface, or on one that is seen very aslant.
constexpr float kOneSurface = 1.01f;

}  // namespace

Ground::Ground(const BoneView* bone, const PixelArea& area, const camera::Boundary& boundary,
               const RayTable& rays, float exposure)
    : bone_(bone), area_(area), boundary_(boundary), rays_(rays), exposure_(exposure) {}

// Light that the field stop will not pass need not be computed.
std::array<int, 2> Ground::open_columns(int row) const {
  const double dy = row + area_.top - boundary_.center_px.y(), radius = boundary_.radius_px + 4;
  if (std::abs(dy) >= radius) return {0, 0};
  const double reach = std::sqrt(radius * radius - dy * dy);
  const double center = boundary_.center_px.x() - area_.left;
  const int first = std::clamp(static_cast<int>(std::ceil(center - reach)), 0, area_.width);
  return {first, std::clamp(static_cast<int>(std::floor(center + reach)) + 1, first, area_.width)};
}

// put(i, light) for each of the columns, of bone or of what is behind it.
template <typename Columns, typename Put>
void Ground::shade(int row, const Columns& columns, const BoneRows& bone_rows, Memory& memory,
                   Put put) const {
  Memory::Pixels &on_bone = memory.on_bone_, &beside = memory.beside_;
  for (Memory::Pixels* pixels : {&on_bone, &beside}) {
    pixels->columns.clear();
    pixels->triangles.clear();
  }
  const std::int32_t* const triangles = bone_rows.triangles(row);
  for (const int column : columns) {
    Memory::Pixels& pixels = triangles[column] >= 0 ? on_bone : beside;
    pixels.columns.push_back(column);
    pixels.triangles.push_back(triangles[column]);
  }
  for (Memory::Pixels* pixels : {&on_bone, &beside}) {
    const int count = static_cast<int>(pixels->columns.size());
    if (count == 0) continue;
    const auto room = static_cast<std::size_t>(padded(count));
    pixels->bgr.resize(3 * room);
    if (pixels == &on_bone) {
      bone_->shade(row, pixels->columns.data(), pixels->triangles.data(), count, exposure_, memory.shading_,
                   pixels->bgr.data());
    } else {
      pixels->x.resize(room);
      pixels->y.resize(room);
      for (std::size_t i = 0; i < pixels->columns.size(); ++i)
        rays_.row(area_.left + pixels->columns[i], area_.top + row, 1, &pixels->x[i], &pixels->y[i]);
      picture_kernel().light_backdrop({pixels->x.data(), pixels->y.data(), nullptr}, padded(count), exposure_,
                                      pixels->bgr.data());
    }
    for (std::size_t i = 0; i < pixels->columns.size(); ++i)
      put(pixels->columns[i], pixels->bgr.data() + 3 * i);
  }
}

namespace {

// Every other column, as a range.
class EvenColumns {
 public:
  EvenColumns(int first_node, int end_node) : first_(first_node), end_(end_node) {}
  struct Iterator {
    int node;
    int operator*() const { return 2 * node; }
    Iterator& operator++() {
      ++node;
      return *this;
    }
    bool operator!=(const Iterator& other) const { return node != other.node; }
  };
  [[nodiscard]] Iterator begin() const { return {first_}; }
  [[nodiscard]] Iterator end() const { return {end_}; }

 private:
  int first_, end_;
};

}  // namespace

// The even columns of an even row, with one beyond the open ones each way.
void Ground::shade_nodes(int row, const BoneRows& bone_rows, Memory& memory, Memory::Nodes& nodes) const {
  // The rows above and below take of these nodes, too, and may be open further.
  std::array<int, 2> open{area_.width, 0};
  for (const int other : {row - 1, row, row + 1}) {
    const auto columns = open_columns(std::clamp(other, 0, area_.height - 1));
    if (columns[0] == columns[1]) continue;
    open = {std::min(open[0], columns[0]), std::max(open[1], columns[1])};
  }
  if (open[0] >= open[1]) return;
  const int first = std::max(0, open[0] / 2 - 1), end = std::min(node_count(), (open[1] + 1) / 2 + 2);
  shade(row, EvenColumns(first, end), bone_rows, memory, [&](int column, const float* bgr) {
    std::copy_n(bgr, 3, nodes.bgr.data() + static_cast<std::ptrdiff_t>(column) / 2 * 3);
  });
  const float* const depth_mm = bone_rows.depth_mm(row);
  for (int node = first; node < end; ++node)
    nodes.depth_mm[static_cast<std::size_t>(node)] = depth_mm[2 * node];
  if (end < node_count()) return;
  // Right of the last node there is none: it stands for it.
  const auto last = static_cast<std::size_t>(end - 1);
  std::copy_n(nodes.bgr.data() + 3 * last, 3, nodes.bgr.data() + 3 * last + 3);
  nodes.depth_mm[last + 1] = nodes.depth_mm[last];
}

void Ground::draw_row(int row, const BoneRows& bone_rows, const Memory::Nodes& under, Memory& memory,
                      float* out) const {
  const auto [open_first, open_end] = open_columns(row);
  std::fill_n(out, 3 * open_first, 0.0f);
  std::fill(out + static_cast<std::ptrdiff_t>(3) * open_end,
            out + static_cast<std::ptrdiff_t>(3) * area_.width, 0.0f);
  if (open_first == open_end) return;
  const Memory::Nodes& above = memory.above_;
  const int first = open_first / 2, end = std::min(node_count(), (open_end + 1) / 2);
  // Sums of two nodes, one above the other, and their depths; with one node more at the end.
  for (int i = 3 * first; i < 3 * end + 3; ++i) {
    const auto k = static_cast<std::size_t>(i);
    memory.sum_[k] = above.bgr[k] + under.bgr[k];
  }
  for (int node = first; node <= end; ++node) {
    const auto k = static_cast<std::size_t>(node);
    memory.low_mm_[k] = std::min(above.depth_mm[k], under.depth_mm[k]);
    memory.high_mm_[k] = std::max(above.depth_mm[k], under.depth_mm[k]);
  }
  const float* sum = memory.sum_.data() + static_cast<std::ptrdiff_t>(3) * first;
  float* pair = out + static_cast<std::ptrdiff_t>(6) * first;
  const int whole = std::min(end, area_.width / 2);
  for (int node = first; node < whole; ++node, sum += 3, pair += 6) {
    for (int c = 0; c < 3; ++c) {
      pair[c] = 0.5f * sum[c];
      pair[3 + c] = 0.25f * (sum[c] + sum[3 + c]);
    }
  }
  if (whole < end)
    for (int c = 0; c < 3; ++c) pair[c] = 0.5f * sum[c];
  // The stop's edge may cut a pair in two.
  if (open_first % 2 == 1) std::fill_n(out + static_cast<std::ptrdiff_t>(3) * (open_first - 1), 3, 0.0f);
  if (open_end % 2 == 1 && open_end < area_.width)
    std::fill_n(out + static_cast<std::ptrdiff_t>(3) * open_end, 3, 0.0f);
  const int count =
      picture_kernel().list_breaks(bone_rows.depth_mm(row), memory.low_mm_.data(), memory.high_mm_.data(),
                                   kOneSurface, open_first, open_end, memory.breaks_.data());
  shade(row, std::span(memory.breaks_.data(), static_cast<std::size_t>(count)), bone_rows, memory,
        [&](int column, const float* bgr) {
          std::copy_n(bgr, 3, out + static_cast<std::ptrdiff_t>(3) * column);
        });
}

void Ground::draw_rows(int first, int end, const BoneRows& bone_rows, Memory& memory, float* light) const {
  const auto nodes = static_cast<std::size_t>(padded(node_count() + 1) + kTogether);
  for (Memory::Nodes* row : {&memory.above_, &memory.below_}) {
    row->bgr.assign(3 * nodes, 0.0f);
    row->depth_mm.assign(nodes, BoneRows::kNothing_mm);
  }
  memory.sum_.assign(3 * nodes, 0.0f);
  memory.low_mm_.assign(nodes, BoneRows::kNothing_mm);
  memory.high_mm_.assign(nodes, BoneRows::kNothing_mm);
  memory.breaks_.resize(static_cast<std::size_t>(area_.width));
  const int last_node_row = (area_.height - 1) / 2 * 2;
  for (int row = first; row < end; ++row) {
    const int lower = std::min(row / 2 * 2 + 2, last_node_row);
    if (row == first) {
      shade_nodes(row, bone_rows, memory, memory.above_);
    } else if (row % 2 == 0) {
      std::swap(memory.above_, memory.below_);
    }
    const bool is_between = row % 2 == 1 && lower > row;
    if (is_between) shade_nodes(lower, bone_rows, memory, memory.below_);
    draw_row(row, bone_rows, is_between ? memory.below_ : memory.above_, memory,
             light + static_cast<std::ptrdiff_t>(3) * area_.width * row);
  }
}

}  // namespace arthronaut::simulator
