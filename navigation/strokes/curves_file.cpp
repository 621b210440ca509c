#include <cmath>
#include <cstdio>

#include "navigation/strokes/csv_place.h"
#include "navigation/strokes/curves.h"
#include "planning/files/atomic_file.h"
#include "planning/files/csv_table.h"

namespace arthronaut::strokes {

namespace {

constexpr double kFarthestTip_mm = 1000;  // no hand draws further off its world marker

// Empty where all three cells are.
std::optional<Eigen::Vector3d> read_shaft(const files::CsvTable& table, std::size_t row) {
  constexpr double kUnitTolerance = 1e-3;
  const std::optional<double> x = table.optional_number(row, "shaft_x");
  if (!x) return std::nullopt;
  const Eigen::Vector3d shaft(*x, table.number(row, "shaft_y"), table.number(row, "shaft_z"));
  if (std::abs(shaft.norm() - 1) > kUnitTolerance)
    table.fail(row, "shaft_x", "the direction is not of length 1");
  return shaft.normalized();
}

}  // namespace

Curves read_curves_file(const std::filesystem::path& file) {
  const auto table = files::CsvTable::read(file, {"curve", "time_s", "x_mm", "y_mm", "z_mm"});
  const bool has_shaft =
      table.has_column("shaft_x") && table.has_column("shaft_y") && table.has_column("shaft_z");
  Curves curves(table.row_count());
  for (std::size_t row = 0; row < table.row_count(); ++row) {
    curves[row].curve = table.int32(row, "curve");
    curves[row].time_s = table.optional_number(row, "time_s");
    curves[row].position_mm = place_in(table, row, {"x_mm", "y_mm", "z_mm"}, kFarthestTip_mm,
                                       "lies more than a metre from the world marker");
    if (has_shaft) curves[row].shaft_direction = read_shaft(table, row);
  }
  return curves;
}

void write_curves_file(const std::filesystem::path& file, const Curves& curves, ShaftColumns shaft) {
  const bool with_shaft = shaft == ShaftColumns::Write;
  std::string text = "curve,time_s,x_mm,y_mm,z_mm";
  text += with_shaft ? ",shaft_x,shaft_y,shaft_z\n" : "\n";
  char line[200];
  for (const CurvePoint& point : curves) {
    std::snprintf(line, sizeof line, "%d,", point.curve);
    text += line;
    if (point.time_s) {
      std::snprintf(line, sizeof line, "%.6f", *point.time_s);
      text += line;
    }
    std::snprintf(line, sizeof line, ",%.6f,%.6f,%.6f", point.position_mm.x(), point.position_mm.y(),
                  point.position_mm.z());
    text += line;
    if (with_shaft && point.shaft_direction) {
      const Eigen::Vector3d& direction = *point.shaft_direction;
      std::snprintf(line, sizeof line, ",%.6f,%.6f,%.6f", direction.x(), direction.y(), direction.z());
      text += line;
    } else if (with_shaft) {
      text += ",,,";
    }
    text += '\n';
  }
  files::write_atomically(file, text);
}

}  // namespace arthronaut::strokes
