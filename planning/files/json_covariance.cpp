#include "planning/files/json_covariance.h"

#include <Eigen/Eigenvalues>
#include <nlohmann/json.hpp>
#include <string>

#include "planning/files/json_document.h"

namespace arthronaut::files {

namespace {

// As correlations, so that mm and radians, pixels and shares weigh alike.
Eigen::MatrixXd correlations_of(const Eigen::MatrixXd& covariance) {
  const Eigen::ArrayXd sigmas = covariance.diagonal().array().sqrt();
  const Eigen::VectorXd scale = (sigmas > 0).select(sigmas.inverse(), 1.0);
  return scale.asDiagonal() * covariance * scale.asDiagonal();
}

}  // namespace

Eigen::MatrixXd read_covariance(const JsonObject& object, std::string_view key, int size) {
  constexpr double kRounding = 1e-3;
  const std::vector<double> values = object.numbers(key);
  if (values.size() != static_cast<std::size_t>(size) * static_cast<std::size_t>(size))
    object.fail(key, "must hold " + std::to_string(size * size) + " numbers, row by row");
  using RowByRow = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const Eigen::MatrixXd covariance = Eigen::Map<const RowByRow>(values.data(), size, size);
  if (!(covariance.diagonal().minCoeff() >= 0)) object.fail(key, "a variance must not be negative");
  const Eigen::MatrixXd correlations = correlations_of(covariance);
  if ((correlations - correlations.transpose()).cwiseAbs().maxCoeff() > kRounding)
    object.fail(key, "must be symmetric");
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(correlations, Eigen::EigenvaluesOnly);
  if (!(eigen.eigenvalues().minCoeff() >= -kRounding))
    object.fail(key, "is no covariance: what lies beside its diagonal is too large for it");
  return covariance;
}

nlohmann::ordered_json covariance_to_json(const Eigen::MatrixXd& covariance) {
  auto values = nlohmann::ordered_json::array();
  for (Eigen::Index row = 0; row < covariance.rows(); ++row)
    for (Eigen::Index column = 0; column < covariance.cols(); ++column)
      values.push_back(covariance(row, column));
  return values;
}

}  // namespace arthronaut::files
