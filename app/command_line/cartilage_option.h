// --cartilage of register and navigate.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "planning/geometry/triangle_mesh.h"

namespace arthronaut::command_line {

struct CartilageArguments {
  std::string mesh, space, unit;  // as given; space and unit may be empty
};

// what_else: continues the sentence of the help.
void add_cartilage_option(CLI::App& command, std::string& mesh, const std::string& what_else = "");

// A file that says nothing is in LPS; without a unit it is in mm, however small. Throws as bones::read_mesh.
[[nodiscard]] geometry::TriangleMesh read_cartilage(const CartilageArguments& arguments);

}  // namespace arthronaut::command_line
