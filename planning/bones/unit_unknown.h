// What read_mesh_file() throws of a mesh that is of no bone's size in mm, for whoever can ask a person.
#pragma once

#include <vector>

#include "planning/bones/mesh_file.h"
#include "planning/geometry/error.h"

namespace arthronaut::bones {

// No bone of the knee is as large as the mesh in mm, and no unit was stated.
class UnitUnknown : public InvalidInput {
 public:
  UnitUnknown(const std::filesystem::path& file, double size_in_file);
  [[nodiscard]] double size_in_file() const { return size_in_file_; }  // the largest extent of its box
  // Those in which it is as large as a bone; may be none.
  [[nodiscard]] const std::vector<LengthUnit>& fitting_units() const { return fitting_units_; }

 private:
  double size_in_file_;
  std::vector<LengthUnit> fitting_units_;
};

}  // namespace arthronaut::bones
