// A bone's landmarks in case.json, and wherever else a file of the case holds some. Inner header of cases.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "planning/files/json_document.h"
#include "planning/landmarks/landmarks.h"

namespace arthronaut::cases {

[[nodiscard]] nlohmann::ordered_json landmarks_to_json(const landmarks::Landmarks& landmarks,
                                                       const landmarks::LandmarkStates& states);
// Of the node's "landmarks"; none where it has none. A file that says no state is of a version before there
// were proposals: a person placed its landmarks. Throws InvalidInput (file, place, reason).
[[nodiscard]] landmarks::Landmarks landmarks_from(const files::JsonObject& bone,
                                                  landmarks::LandmarkStates& states);

}  // namespace arthronaut::cases
