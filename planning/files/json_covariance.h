// Covariances in Arthronaut's JSON files: all numbers of the matrix in one array, row by row.
#pragma once

#include <Eigen/Core>
#include <nlohmann/json_fwd.hpp>
#include <string_view>

namespace arthronaut::files {

class JsonObject;

// size x size numbers that something can scatter by: symmetric, no variance below 0, and no combination of
// them whose variance is below 0 by more than a thousandth of its parts, which is borne because files are
// rounded. Throws InvalidInput ("FILE: place: reason") for anything else.
[[nodiscard]] Eigen::MatrixXd read_covariance(const JsonObject& object, std::string_view key, int size);

[[nodiscard]] nlohmann::ordered_json covariance_to_json(const Eigen::MatrixXd& covariance);

}  // namespace arthronaut::files
