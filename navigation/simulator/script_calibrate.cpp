#include <cmath>

#include "navigation/simulator/random.h"
#include "navigation/simulator/script.h"

namespace arthronaut::simulator {

Script calibrate_script(const SimulationOptions& options) {
  constexpr int kPictures = 5;
  Random random(options.seed + 101);
  Script script;
  for (int i = 0; i < kPictures; ++i) {
    Moment moment;
    moment.mark_angle_deg = std::fmod(options.camera.reference_mark_angle_deg - 100 + 50 * i + 720, 360.0);
    // Tilted by 25 to 34 degrees, turned in its plane anyhow. The board comes nearest beside the lens mark,
    // so that the mark stands before a bright board; as the lens turns, so does the tilt.
    const double azimuth =
        geometry::rad_from_deg(moment.mark_angle_deg + random.between(-35, 35)) + geometry::kPi / 2;
    const double tilt = geometry::rad_from_deg(random.between(25, 34));
    const Eigen::Vector3d hinge(std::cos(azimuth), std::sin(azimuth), 0);
    const Eigen::Quaterniond facing_lens(Eigen::AngleAxisd(geometry::kPi, Eigen::Vector3d::UnitX()));
    const Eigen::Quaterniond in_plane(Eigen::AngleAxisd(random.between(-3, 3), Eigen::Vector3d::UnitZ()));
    // Further off than a surgeon would hold it: the squares at the rim then are smaller than the mark, not
    // its size.
    moment.camera_from_board = geometry::RigidTransform{
        (Eigen::Quaterniond(Eigen::AngleAxisd(tilt, hinge)) * facing_lens * in_plane).normalized(),
        {random.between(-1.5, 1.5), random.between(-1.5, 1.5), random.between(20, 24)}};
    script.push_back(moment);
  }
  return script;
}

}  // namespace arthronaut::simulator
