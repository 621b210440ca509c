#include "planning/cases/side_doubt.h"

#include <array>
#include <utility>

namespace arthronaut::cases {

namespace {

using bones::Side;

constexpr std::array<std::pair<SideWitness, std::string_view>, 6> kWitnesses{
    {{SideWitness::Fibula, "fibula"},
     {SideWitness::OneShape, "one_shape"},
     {SideWitness::BothShapes, "both_shapes"},
     {SideWitness::ShapesAlone, "shapes_alone"},
     {SideWitness::ImageMark, "image_mark"},
     {SideWitness::PersonAlone, "person_alone"}}};

std::string testimony(SideWitness witness, const std::string& told) {
  switch (witness) {
    case SideWitness::Fibula:
      return "the fibula lies on the " + told + " of the tibia, as in a " + told + " knee";
    case SideWitness::OneShape:
      return "by the shape of the bone it is a " + told + " knee";
    case SideWitness::BothShapes:
      return "by the shape of both bones it is a " + told + " knee";
    case SideWitness::ShapesAlone:
      return "that it is a " + told + " knee is told by the shape of its bones alone";
    case SideWitness::ImageMark:
      return "the images are marked as those of a " + told + " knee";
    case SideWitness::PersonAlone:
      return "a " + told + " knee, as said: nothing in the images or the shape of the bones confirms it";
  }
  return "";
}

}  // namespace

std::string_view to_text(SideWitness witness) {
  for (const auto& [one, text] : kWitnesses)
    if (one == witness) return text;
  return "";
}

std::optional<SideWitness> side_witness_from_text(std::string_view text) {
  for (const auto& [witness, word] : kWitnesses)
    if (word == text) return witness;
  return std::nullopt;
}

std::string SideDoubt::words() const {
  if (is_note()) return testimony(witness, std::string(bones::to_text(told)));
  return testimony(witness, std::string(bones::to_text(told))) +
         (told == said ? "" : ", but the side is " + std::string(bones::to_text(said))) +
         (looked_on.empty() ? ": check the side"
                            : "; somebody looked on " + looked_on + " and says that it is");
}

std::optional<SideDoubt> side_doubt_from_words(const std::string& sentence) {
  constexpr std::string_view kLooked = "; somebody looked on ";
  constexpr std::size_t kDay = 10;  // "2026-01-31"
  const std::size_t looked = sentence.find(kLooked);
  const std::string day = looked == std::string::npos ? "" : sentence.substr(looked + kLooked.size(), kDay);
  for (const auto& [witness, word] : kWitnesses)
    for (const Side told : {Side::Left, Side::Right}) {
      const Side other = told == Side::Left ? Side::Right : Side::Left;
      const SideDoubt doubt{witness, told, witness == SideWitness::ShapesAlone ? told : other, day};
      if (doubt.words() == sentence) return doubt;
    }
  return std::nullopt;
}

}  // namespace arthronaut::cases
