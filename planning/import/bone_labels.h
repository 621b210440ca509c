// Which labels of a label map are which bones, where nobody says so: by the names of its segments, else by
// their shapes.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "planning/bones/bone.h"
#include "planning/images/volume.h"

namespace arthronaut::importing {

// The words of a name, in lower case: runs of letters.
[[nodiscard]] std::vector<std::string> words_in(const std::string& name);

// By the names of the segments; a name that stands twice is nobody's. For each that was found a line for a
// person is added to `lines`.
[[nodiscard]] std::map<bones::BoneKind, int> labels_by_name(const images::Volume& volume,
                                                            std::vector<std::string>& lines);

// By shape (anatomy_check.h): the only label with a femur's and the only one with a tibia's, below it. Empty
// where either is missing or there are several, as of both knees: then only a person knows. Makes a surface
// of each label of at least 15 cm3, of which there may be twelve.
[[nodiscard]] std::map<bones::BoneKind, int> labels_by_shape(const images::Volume& volume,
                                                             std::vector<std::string>& lines);

}  // namespace arthronaut::importing
