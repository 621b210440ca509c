#include "navigation/markers/seen_code.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "navigation/markers/cell_light.h"

namespace arthronaut::markers {
namespace {

constexpr double kSpread = 0.2;  // of the samples within a cell
constexpr int kMinSamples = 3;   // of five that are not saturated
constexpr double kMinRange = 4;  // in light
// How far a cell may be from its level, as a share of the range; what has to agree.
constexpr double kAgrees = 0.3;
constexpr double kMinAgreeing = 0.45;
constexpr int kMinAgreeingInside = 7, kMaxOppositeInside = 3, kClearLead = 4, kLead = 5;
constexpr int kMinClearInside = 5;  // where none says the opposite
constexpr int kMinCoveredScore = 5;
constexpr int kSeePasses = 4;
// Seen by the light of border and margin alone, which all codes have alike, a code that could agree in the
// end is about right already.
constexpr int kMinHopefulInside = 4, kMaxHopefulOpposite = 6, kHopefulPasses = 3;
// Of a cell that a highlight may hide a part of: its parts, how far from its middle they reach, so that its
// neighbours' smear does not, how many of them have to be dark, and how many how bright. Where a highlight
// fades over a dark cell there is a band of any brightness, but it is narrow.
constexpr int kPartsAcross = 6, kMinDarkParts = 4, kMinBrightParts = 15;
constexpr double kPartsReach = 0.3, kPartAgrees = 0.2;
// A bright cell is nowhere this dark, so one that is by so many parts is dark under what the highlight adds.
constexpr double kNoBright = 0.6;
constexpr int kMinNoBrightParts = 6;

// A cell, or one of the margin, as the picture shows it.
struct SeenCell {
  double value = 0, x = 0, y = 0;
  int row = 0, column = 0;
  bool is_margin = false, is_inside = false;
  bool is_white = false;  // saturated or out of the view: the value says nothing
  int parts = -1;         // of an inner cell that is white or beside a white one: index of its parts
};
struct CellParts {
  std::array<float, kPartsAcross * kPartsAcross> light;
  int count;  // that are not saturated
};
struct SeenSquare {
  std::array<SeenCell, (kMaxCells + 2) * (kMaxCells + 2)> all;
  std::array<CellParts, (kMaxCells - 2) * (kMaxCells - 2)> parts;
  int count = 0;

  [[nodiscard]] std::span<const SeenCell> cells() const {
    return std::span(all).first(static_cast<std::size_t>(count));
  }
};
enum class Shade : std::uint8_t { Dark, Bright, Neither, Unseen };
using Shades = std::array<Shade, (kMaxCells + 2) * (kMaxCells + 2)>;

// `at` takes a place on the marker (in sides, y up) to the camera frame.
template <typename Place>
float light_at(const LinearImage& image, const camera::CameraModel& camera, const Place& at, double x,
               double y) {
  constexpr float kNone = -1;
  const auto pixel = camera.project(at(x, -y));
  if (!pixel || !camera.is_inside_view(*pixel) || !image.contains(pixel->x(), pixel->y())) return kNone;
  return image.sample(static_cast<float>(pixel->x()), static_cast<float>(pixel->y()));
}

template <typename Place>
void see_cells(const LinearImage& image, const camera::CameraModel& camera, int cells, const Place& at,
               SeenSquare& seen) {
  const int wide = cells + 2;
  seen.count = wide * wide;
  for (int i = 0; i < seen.count; ++i) {
    SeenCell& cell = seen.all[i];
    cell.row = i / wide - 1;
    cell.column = i % wide - 1;
    cell.is_margin = cell.row < 0 || cell.column < 0 || cell.row >= cells || cell.column >= cells;
    cell.is_inside = cell.row > 0 && cell.column > 0 && cell.row + 1 < cells && cell.column + 1 < cells;
    // The margin is no wider than a cell: its half next to the square.
    const auto middle = [cells](int k) { return k < 0 ? -0.4 : k >= cells ? cells + 0.4 : k + 0.5; };
    cell.x = middle(cell.column) / cells - 0.5;
    cell.y = middle(cell.row) / cells - 0.5;
    double sum = 0;
    int samples = 0;
    for (int k = 0; k < 5; ++k) {
      const double spread = (cell.is_margin ? 0.5 : 1) * kSpread / cells;
      const double dx = k == 0 ? 0 : (k % 2 ? spread : -spread), dy = k == 0 ? 0 : (k < 3 ? spread : -spread);
      const float value = light_at(image, camera, at, cell.x + dx, cell.y + dy);
      if (value < 0) continue;
      sum += value;
      ++samples;
    }
    cell.is_white = samples < kMinSamples;
    cell.value = sum / std::max(1, samples);
  }
}

template <typename Place>
void see_parts(const LinearImage& image, const camera::CameraModel& camera, int cells, const Place& at,
               SeenSquare& seen) {
  int count = 0;
  const auto is_near_white = [&](int i) {
    for (int row = -1; row <= 1; ++row) {
      for (int column = -1; column <= 1; ++column) {
        if (seen.all[i + row * (cells + 2) + column].is_white) return true;
      }
    }
    return false;
  };
  for (int i = 0; i < seen.count; ++i) {
    SeenCell& cell = seen.all[i];
    if (!cell.is_inside || !is_near_white(i)) continue;
    cell.parts = count++;
    CellParts& parts = seen.parts[cell.parts];
    parts.count = 0;
    const auto off = [cells](int k) { return kPartsReach / cells * (2.0 * k / (kPartsAcross - 1) - 1); };
    for (int k = 0; k < kPartsAcross * kPartsAcross; ++k) {
      const float value =
          light_at(image, camera, at, cell.x + off(k % kPartsAcross), cell.y + off(k / kPartsAcross));
      if (value >= 0) parts.light[parts.count++] = value;
    }
  }
}

Shade shade_of(const SeenCell& cell, const SeenSquare& seen, const LightFit& fit) {
  const double bias = fit.bias(cell.x, cell.y), gain = std::max(fit.gain(cell.x, cell.y), 1e-3);
  if (cell.parts < 0) {
    const double level = (cell.value - bias) / gain;
    if (cell.is_white) return Shade::Unseen;
    return std::abs(level) < kAgrees       ? Shade::Dark
           : std::abs(level - 1) < kAgrees ? Shade::Bright
                                           : Shade::Neither;
  }
  const CellParts& parts = seen.parts[cell.parts];
  int dark = 0, bright = 0, no_bright = 0;
  for (int k = 0; k < parts.count; ++k) {
    const double level = (parts.light[k] - bias) / gain;
    dark += level < kAgrees;
    no_bright += level < kNoBright;
    bright += std::abs(level - 1) < kPartAgrees;
  }
  if (dark >= kMinDarkParts || no_bright >= kMinNoBrightParts) return Shade::Dark;
  return dark == 0 && bright >= kMinBrightParts ? Shade::Bright : Shade::Unseen;
}

// The marker's cell that is seen here, its top-left being corner `turn` of what is looked at.
Shade expected_shade(const MarkerCode& code, const SeenCell& cell, int turn) {
  if (cell.is_margin) return Shade::Bright;
  const int there = turned_cell(cell.row, cell.column, (4 - turn) % 4, code.cells);
  return code.is_bright(there / code.cells, there % code.cells) ? Shade::Bright : Shade::Dark;
}

// The light that most of the cells that are taken agree on: what covers is left out step by step. False when
// there is none.
template <typename Taken, typename Bright>
bool fit_light(const SeenSquare& seen, int passes, const Taken& is_taken, const Bright& is_bright,
               LightFit& fit) {
  for (int pass = 0; pass < passes; ++pass) {
    const LightFit last = fit;
    const double range = last.gain(0, 0);
    fit = LightFit();
    for (const SeenCell& cell : seen.cells()) {
      if (cell.is_white || !is_taken(cell)) continue;
      const bool bright = is_bright(cell);
      double weight = 1;
      if (pass > 0) {
        const double error = (cell.value - last.light(cell.x, cell.y, bright)) / (kAgrees * range);
        weight = 1 / ((1 + error * error) * (1 + error * error));
      }
      fit.add(weight, cell.x, cell.y, cell.value, bright);
    }
    // A slope of the light is not expected to be larger than the light.
    fit.solve(0.3);
    if (!(fit.gain(0, 0) > kMinRange)) return false;
  }
  return true;
}

// The codes and turns that are worth a judgement: most of what is looked at is no marker. Where border and
// margin don't tell the light, all are.
class HopefulCodes {
 public:
  explicit HopefulCodes(const SeenSquare& seen) : seen_(seen) {
    LightFit fit;
    knows_light_ = fit_light(
        seen, kHopefulPasses, [](const SeenCell& cell) { return !cell.is_inside; },
        [](const SeenCell& cell) { return cell.is_margin; }, fit);
    if (!knows_light_) return;
    for (int i = 0; i < seen.count; ++i)
      shades_[i] = seen.all[i].is_inside ? shade_of(seen.all[i], seen, fit) : Shade::Unseen;
  }
  [[nodiscard]] bool may_be(const MarkerCode& code, int turn) const {
    if (!knows_light_) return true;
    int agreeing = 0, opposite = 0;
    for (int i = 0; i < seen_.count; ++i) {
      if (shades_[i] == Shade::Unseen || shades_[i] == Shade::Neither) continue;
      const bool agrees = shades_[i] == expected_shade(code, seen_.all[i], turn);
      agreeing += agrees;
      opposite += !agrees;
    }
    return agreeing >= kMinHopefulInside && opposite <= kMaxHopefulOpposite;
  }

 private:
  const SeenSquare& seen_;
  bool knows_light_ = false;
  Shades shades_{};
};

// How many of the inner cells that are seen say this code, less those that say the opposite.
int score_inside(const SeenSquare& seen, const Shades& shades, const MarkerCode& code, int turn) {
  int score = 0;
  for (int i = 0; i < seen.count; ++i) {
    if (!seen.all[i].is_inside || shades[i] == Shade::Unseen || shades[i] == Shade::Neither) continue;
    score += shades[i] == expected_shade(code, seen.all[i], turn) ? 1 : -1;
  }
  return score;
}

// What the cells say of one code whose top-left is corner `turn` of what they were seen on.
SeenCode judge_cells(const SeenSquare& seen, const KnownCodes& codes, std::size_t index, int turn) {
  const MarkerCode& code = codes.declared[index];
  LightFit fit;
  if (!fit_light(
          seen, kSeePasses, [](const SeenCell&) { return true; },
          [&](const SeenCell& cell) { return expected_shade(code, cell, turn) == Shade::Bright; }, fit))
    return {};
  SeenCode result;
  Shades shades;
  for (int i = 0; i < seen.count; ++i) {
    const SeenCell& cell = seen.all[i];
    shades[i] = shade_of(cell, seen, fit);
    if (shades[i] == Shade::Unseen) continue;
    const Shade should = expected_shade(code, cell, turn);
    ++result.seen;
    result.agreeing += shades[i] == should;
    if (!cell.is_inside) continue;
    ++result.seen_inside;
    result.agreeing_inside += shades[i] == should;
    result.bright_inside += shades[i] == should && should == Shade::Bright;
    result.opposite_inside += shades[i] != should && shades[i] != Shade::Neither;
  }
  if (!result.agrees()) return result;  // most of what is looked at is no marker
  int other_score = -seen.count;
  for (std::size_t other = 0; other < codes.declared.size(); ++other) {
    if (other != index && codes.is_elsewhere(other)) continue;
    for (int other_turn = 0; other_turn < 4; ++other_turn) {
      if (other == index && other_turn == turn) continue;
      other_score = std::max(other_score, score_inside(seen, shades, codes.declared[other], other_turn));
    }
  }
  const int score = result.agreeing_inside - result.opposite_inside;
  result.lead = score - other_score;
  if (result.lead < kClearLead) return result;
  for (const MarkerCode& other : codes.dictionary) {
    const auto is_other = [&](const MarkerCode& declared) { return declared.id == other.id; };
    if (std::any_of(codes.declared.begin(), codes.declared.end(), is_other)) continue;
    for (int other_turn = 0; other_turn < 4; ++other_turn)
      result.is_undeclared |= score_inside(seen, shades, other, other_turn) > score;
  }
  return result;
}

// How much brighter the margin is than the border, both as far as they are seen.
double margin_contrast(const SeenSquare& seen) {
  std::array<double, 2> sum{}, n{};
  for (const SeenCell& cell : seen.cells()) {
    if (cell.is_inside || cell.is_white) continue;
    sum[cell.is_margin] += cell.value;
    n[cell.is_margin] += 1;
  }
  return n[0] < 8 || n[1] < 10 ? 0 : sum[1] / n[1] - sum[0] / n[0];
}

}  // namespace

bool SeenCode::agrees() const {
  const bool is_mixed = bright_inside > 0 && bright_inside < agreeing_inside;
  const bool is_clear = opposite_inside == 0 && agreeing_inside >= kMinClearInside && is_mixed;
  return agreeing > kMinAgreeing * seen &&
         (is_clear || (agreeing_inside >= kMinAgreeingInside && opposite_inside <= kMaxOppositeInside));
}

bool SeenCode::is_confirmed() const {
  return agrees() && lead >= (opposite_inside == 0 ? kClearLead : kLead) && !is_undeclared;
}

SeenCode see_code(const LinearImage& image, const camera::CameraModel& camera,
                  const geometry::RigidTransform& camera_from_marker, double size_mm, const KnownCodes& codes,
                  std::size_t index) {
  SeenSquare seen;
  const int cells = codes.declared[index].cells;
  const auto at = [&](double x, double y) {
    return camera_from_marker * Eigen::Vector3d(x * size_mm, y * size_mm, 0);
  };
  see_cells(image, camera, cells, at, seen);
  see_parts(image, camera, cells, at, seen);
  return judge_cells(seen, codes, index, 0);
}

std::optional<ReadCode> read_covered_code(const LinearImage& image, const camera::CameraModel& camera,
                                          const Corners& square, const KnownCodes& codes) {
  const auto homography = square_homography(square, 1.0);
  if (codes.declared.empty() || !homography) return std::nullopt;
  SeenSquare seen;
  const int cells = codes.declared.front().cells;
  const auto at = [&](double x, double y) -> Eigen::Vector3d {
    return *homography * Eigen::Vector3d(x, y, 1);
  };
  see_cells(image, camera, cells, at, seen);
  if (margin_contrast(seen) < kMinRange) return std::nullopt;
  see_parts(image, camera, cells, at, seen);
  const HopefulCodes hopeful(seen);
  std::optional<ReadCode> best;
  int most = 0;
  for (std::size_t i = 0; i < codes.declared.size(); ++i) {
    if (codes.is_elsewhere(i)) continue;
    for (int turn = 0; turn < 4; ++turn) {
      if (!hopeful.may_be(codes.declared[i], turn)) continue;
      const SeenCode code = judge_cells(seen, codes, i, turn);
      const int score = code.agreeing_inside - 2 * code.opposite_inside;
      if (!code.is_confirmed() || score < kMinCoveredScore || score <= most) continue;
      most = score;
      best = ReadCode{static_cast<int>(i), turn, code.opposite_inside, true};
    }
  }
  return best;
}

}  // namespace arthronaut::markers
