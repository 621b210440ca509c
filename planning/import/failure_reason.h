// Why an import was refused, where whoever asked for it may answer otherwise than by showing the words.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "planning/geometry/error.h"

namespace arthronaut::importing {

enum class FailureReason : std::uint32_t {
  Other,
  ShowsBothKnees,  // and nobody has said which one is meant
  IsNoCt,          // no threshold finds its bones: they are to be painted
};

class ImportRefused : public InvalidInput {
 public:
  ImportRefused(const std::filesystem::path& file, const std::string& words, FailureReason reason)
      : InvalidInput(file, "", words), reason_(reason) {}
  [[nodiscard]] FailureReason reason() const { return reason_; }

 private:
  FailureReason reason_;
};

}  // namespace arthronaut::importing
