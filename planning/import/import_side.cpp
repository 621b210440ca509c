#include "planning/import/import_side.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace arthronaut::importing {

namespace {

std::string word_of(bones::Side side) { return std::string(bones::to_text(side)); }

std::ptrdiff_t judged_count(const BoneImport& import) {
  return std::ranges::count_if(import.bones, &ImportedBone::shape_was_judged);
}

bool fibula_told(const BoneImport& import) { return import.side_was_seen && !import.side_is_by_shape; }

}  // namespace

std::optional<bones::Side> side_by_shapes(const BoneImport& import) {
  std::optional<bones::Side> all;
  for (const ImportedBone& bone : import.bones) {
    if (!bone.shape_was_judged) continue;
    if (!bone.side_by_shape || (all && *all != *bone.side_by_shape)) return std::nullopt;
    all = bone.side_by_shape;
  }
  return all;
}

std::string other_side_by_fibula(bones::Side fibula, bones::Side said) {
  return "the fibula lies on the " + word_of(fibula) + " of the tibia, as in a " + word_of(fibula) +
         " knee, but the side is " + word_of(said) + ": check the side";
}

std::string other_side_by_shape(bones::Side shape, bones::Side said, bool of_both) {
  return "by the shape of " + std::string(of_both ? "both bones" : "the bone") + " it is a " +
         word_of(shape) + " knee, but the side is " + word_of(said) + ": check the side";
}

std::string side_by_shape_alone(bones::Side shape) {
  return "that it is a " + word_of(shape) + " knee is told by the shape of its bones alone: check the side";
}

std::string other_side_in_images(bones::Side images, bones::Side said) {
  return "the images are marked as those of a " + word_of(images) + " knee, but the side is " +
         word_of(said) + ": check the side";
}

void take_side_of_images(BoneImport& import, std::optional<bones::Side> marked, bool was_said) {
  import.side_in_images = marked;
  if (!marked) return;
  std::string line = "the images are marked as those of a " + word_of(*marked) + " knee";
  if (!was_said && import.side && *import.side != *marked) {
    line += ", the name says that it is a " + word_of(*import.side) + " one: neither is taken";
    import.side.reset();
    import.side_was_guessed = false;
  } else if (!import.side) {
    import.side = marked;
    import.side_was_guessed = import.side_is_by_images = true;
  }
  import.lines.push_back(line);
}

void check_side_of_images(BoneImport& import) {
  if (!import.side || !import.side_in_images || *import.side == *import.side_in_images) return;
  for (ImportedBone& bone : import.bones)
    bone.doubts.push_back(other_side_in_images(*import.side_in_images, *import.side));
  import.side_is_contradicted = true;
}

std::vector<std::string> doubts_with(const BoneImport& import, const ImportedBone& bone, bones::Side side,
                                     bool is_said_by_person) {
  std::vector<std::string> doubts = bone.doubts;
  if (is_said_by_person) std::erase(doubts, side_by_shape_alone(side));
  if (import.side == side) return doubts;
  if (import.side) {
    // What spoke against the other side speaks for this one; what it was told by is no matter any more.
    std::erase(doubts, other_side_by_fibula(side, *import.side));
    for (const bool of_both : {true, false})
      std::erase(doubts, other_side_by_shape(side, *import.side, of_both));
    std::erase(doubts, side_by_shape_alone(*import.side));
    std::erase(doubts, other_side_in_images(side, *import.side));
  }
  if (import.side_in_images && *import.side_in_images != side)
    doubts.push_back(other_side_in_images(*import.side_in_images, side));
  if (fibula_told(import)) {
    doubts.push_back(other_side_by_fibula(*import.side, side));
  } else if (const auto shape = side_by_shapes(import);
             shape && *shape != side && bone.bone.kind == import.bones.front().bone.kind) {
    doubts.push_back(other_side_by_shape(*shape, side, judged_count(import) > 1));
  }
  return doubts;
}

void say_side(BoneImport& import, bones::Side side) {
  std::vector<std::vector<std::string>> doubts;
  for (const ImportedBone& bone : import.bones) doubts.push_back(doubts_with(import, bone, side, true));
  for (std::size_t i = 0; i < doubts.size(); ++i) import.bones[i].doubts = std::move(doubts[i]);
  if (import.side == side) {  // known as it was known
    if (import.side_is_by_shape) import.side_was_seen = import.side_is_by_shape = false;
    return;
  }
  const auto shape = side_by_shapes(import);
  import.side_is_contradicted = fibula_told(import) || (shape && *shape != side) ||
                                (import.side_in_images && *import.side_in_images != side);
  import.side = side;
  import.side_was_guessed = import.side_is_by_segment = import.side_is_by_images = false;
  import.side_was_seen = import.side_is_by_shape = false;
}

bool add_bones(BoneImport& import, BoneImport more) {
  if (import.side && more.side && *import.side != *more.side) return false;
  const auto tell = [](const BoneImport& who_knows, BoneImport& other) {
    if (!who_knows.side || other.side) return;
    say_side(other, *who_knows.side);
    other.side_was_guessed = who_knows.side_was_guessed;
    other.side_is_by_segment = who_knows.side_is_by_segment;
    other.side_was_seen = who_knows.side_was_seen;
    other.side_is_by_shape = who_knows.side_is_by_shape;
  };
  tell(import, more);
  tell(more, import);
  import.side_is_contradicted = import.side_is_contradicted || more.side_is_contradicted;
  std::ranges::move(more.bones, std::back_inserter(import.bones));
  std::ranges::move(more.lines, std::back_inserter(import.lines));
  return true;
}

}  // namespace arthronaut::importing
