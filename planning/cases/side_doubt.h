// Of which knee a bone is, where what it was made from does not bear out what the case says.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "planning/bones/bone.h"

namespace arthronaut::cases {

// ShapesAlone and PersonAlone contradict nothing: nothing else told the side.
enum class SideWitness { Fibula, OneShape, BothShapes, ShapesAlone, ImageMark, PersonAlone };
[[nodiscard]] std::string_view to_text(SideWitness witness);
// nullopt: names none.
[[nodiscard]] std::optional<SideWitness> side_witness_from_text(std::string_view text);

struct SideDoubt {
  SideWitness witness = SideWitness::Fibula;
  bones::Side told = bones::Side::Right;  // by the witness
  bones::Side said = bones::Side::Right;  // of the case; `told` where nothing contradicts it
  std::string looked_on = {};             // "2026-01-31": somebody looked and says so; empty: nobody did

  // Of a contradiction that nobody has looked at.
  [[nodiscard]] bool is_open() const { return told != said && looked_on.empty(); }
  // Speaks against nothing, and is to be read all the same.
  [[nodiscard]] bool is_note() const { return witness == SideWitness::PersonAlone; }
  [[nodiscard]] std::string words() const;
  bool operator==(const SideDoubt&) const = default;
};

// What words() made until bone_doubts.json held it as data; nullopt for any other sentence.
[[nodiscard]] std::optional<SideDoubt> side_doubt_from_words(const std::string& sentence);

}  // namespace arthronaut::cases
