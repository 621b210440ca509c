#include "navigation/markers/exposed_code.h"

#include <algorithm>

namespace arthronaut::markers {

ExposedCode::ExposedCode(const MarkerCode& code, double size_mm) {
  constexpr int kMargin = 2;
  static_assert((kMaxCells + 2 * kMargin) * (kMaxCells + 2 * kMargin) <=
                sizeof(ExposedMoments::neighbours) / sizeof(std::uint16_t));
  code_.cells = code.cells;
  code_.width = code.cells + 2 * kMargin;
  code_.cells_per_mm = static_cast<float>(code.cells / size_mm);
  const auto is_bright = [&code](int row, int column) {
    const bool is_inside = row >= 0 && column >= 0 && row < code.cells && column < code.cells;
    return !is_inside || code.is_bright(row, column);
  };
  for (int row = -kMargin; row < code.cells + kMargin; ++row) {
    for (int column = -kMargin; column < code.cells + kMargin; ++column) {
      unsigned bits = 0;
      for (int i = 0; i < 9; ++i)
        bits |= static_cast<unsigned>(is_bright(row - 1 + i / 3, column - 1 + i % 3)) << i;
      code_.neighbours[(row + kMargin) * code_.width + column + kMargin] = static_cast<std::uint16_t>(bits);
    }
  }
}

void ExposedCode::move(const ExposedPose& pose, int moment_count) {
  code_.count = std::clamp(moment_count, 1, kMaxMoments);
  for (int k = 0; k < code_.count; ++k) {
    ExposedMoments::Moment& moment = code_.moments[k];
    const double time = (k + 0.5) / code_.count - 0.5;
    const geometry::RigidTransform marker_from_camera =
        (pose.camera_from_marker * geometry::exp(time * pose.velocity + 0.5 * time * time * pose.change))
            .inverse();
    moment.time = static_cast<float>(time);
    const Eigen::Matrix3f rotation = marker_from_camera.matrix().cast<float>();
    for (int i = 0; i < 9; ++i) moment.marker_from_camera[i] = rotation(i / 3, i % 3);
    for (int i = 0; i < 3; ++i) moment.eye[i] = static_cast<float>(marker_from_camera.translation_mm[i]);
  }
}

void ExposedCode::look(const LookedAt& at, SeenLevels& levels) const {
  processor_has_avx2() ? look_at_code_avx2(code_, at, levels) : look_at_code(code_, at, levels);
}

void ExposedCode::look_at_level(const LookedAt& at, SeenLevels& levels) const {
  processor_has_avx2() ? look_at_level_avx2(code_, at, levels) : markers::look_at_level(code_, at, levels);
}

}  // namespace arthronaut::markers
