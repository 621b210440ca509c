// Why an import was refused, where whoever asked for it may answer otherwise than by showing the words.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "planning/bones/mesh_file.h"
#include "planning/geometry/error.h"
#include "planning/import/label_choice.h"

namespace arthronaut::importing {

enum class FailureReason : std::uint32_t {
  Other,
  ShowsBothKnees,  // and nobody has said which one is meant
  IsNoCt,          // no threshold finds its bones: they are to be painted
  NeedsUnit,       // no bone is as large as the mesh in mm, but in one of `units`
  NeedsLabels,     // a label map does not name the bones: they are among `labels`
};

struct Failure {
  FailureReason reason = FailureReason::Other;
  std::string words = {};                     // for a person
  double size_in_file = 0;                    // NeedsUnit: the largest extent of the mesh, in whatever unit
  std::vector<bones::LengthUnit> units = {};  // NeedsUnit: those in which it is as large as a bone
  std::vector<FoundLabel> labels = {};        // NeedsLabels: all but 0, in their order
};

class ImportRefused : public InvalidInput {
 public:
  // `failure`: its words are the whole message, with the file.
  explicit ImportRefused(Failure failure) : InvalidInput(failure.words), failure_(std::move(failure)) {}
  [[nodiscard]] const Failure& failure() const { return failure_; }

 private:
  Failure failure_;
};

// Throws InvalidInput of a file without a byte, as reading it would: before anything is asked about it.
inline void refuse_empty_file(const std::filesystem::path& source) {
  std::error_code none;
  if (std::filesystem::is_regular_file(source, none) && std::filesystem::file_size(source, none) == 0)
    throw InvalidInput(source, "", "is empty");
}

}  // namespace arthronaut::importing
