#include "app/command_line/cartilage_option.h"

#include "planning/bones/mesh_file.h"

namespace arthronaut::command_line {

void add_cartilage_option(CLI::App& command, std::string& mesh, const std::string& what_else) {
  command.add_option(
      "--cartilage", mesh,
      "Mesh of what is covered by cartilage that the bone's mesh lacks, or has too much: the strokes "
      "within 4 mm of its vertices lie off the bone by one thickness, which is solved, or they are "
      "left out" +
          what_else);
}

geometry::TriangleMesh read_cartilage(const CartilageArguments& arguments) {
  bones::MeshFileOptions options;
  if (!arguments.space.empty()) options.space = bones::space_from_text(arguments.space);
  // A patch of cartilage may be smaller than any bone: its size tells nothing about the unit.
  options.unit =
      arguments.unit.empty() ? bones::LengthUnit::Millimetre : bones::length_unit_from_text(arguments.unit);
  return bones::read_mesh(arguments.mesh, options);
}

}  // namespace arthronaut::command_line
