// Numbers and sentences that several parts of a report say. Inner header of report.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <string>

#include "planning/files/format.h"

namespace arthronaut::report {

inline constexpr const char* kResearchSentence =
    "Made by research software that is not a medical device. The figures are for research and teaching; they "
    "support no clinical claim and no decision about a patient.";
inline constexpr const char* kDeidentifiedCase = "De-identified case";  // in the place of its name
inline constexpr const char* kNotTold = "not told";                     // of a report that names nobody

// Never "-0.0".
inline std::string number(double value, const char* unit, int decimals = 1) {
  const bool is_zero = std::abs(value) < 0.5 * std::pow(10, -decimals);
  return files::format("%.*f%s", decimals, is_zero ? 0 : value, unit);
}

// A hash is a word too long for a line: "3dd6dcd64e4a9eeb 069e29a556f187e8 ...".
inline std::string in_groups(const std::string& hash) {
  std::string groups;
  for (std::size_t at = 0; at < hash.size(); at += 16) groups += (at > 0 ? " " : "") + hash.substr(at, 16);
  return groups;
}

inline std::string point(const Eigen::Vector3d& p, int decimals = 1) {
  return number(p.x(), ", ", decimals) + number(p.y(), ", ", decimals) + number(p.z(), "", decimals);
}

}  // namespace arthronaut::report
