#include <cstdio>

#include "navigation/strokes/curves.h"
#include "planning/files/atomic_file.h"
#include "planning/files/csv_table.h"

namespace arthronaut::strokes {

Curves read_curves_file(const std::filesystem::path& file) {
  const auto table = files::CsvTable::read(file, {"curve", "time_s", "x_mm", "y_mm", "z_mm"});
  Curves curves(table.row_count());
  for (std::size_t row = 0; row < table.row_count(); ++row) {
    curves[row].curve = static_cast<int>(table.integer(row, "curve"));
    curves[row].time_s = table.optional_number(row, "time_s");
    curves[row].position_mm = {table.number(row, "x_mm"), table.number(row, "y_mm"), table.number(row, "z_mm")};
  }
  return curves;
}

void write_curves_file(const std::filesystem::path& file, const Curves& curves) {
  std::string text = "curve,time_s,x_mm,y_mm,z_mm\n";
  char line[200];
  for (const CurvePoint& point : curves) {
    std::snprintf(line, sizeof line, "%d,", point.curve);
    text += line;
    if (point.time_s) {
      std::snprintf(line, sizeof line, "%.6f", *point.time_s);
      text += line;
    }
    std::snprintf(line, sizeof line, ",%.6f,%.6f,%.6f\n", point.position_mm.x(), point.position_mm.y(),
                  point.position_mm.z());
    text += line;
  }
  files::write_atomically(file, text);
}

}  // namespace arthronaut::strokes
