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

bool is_against(const std::optional<bones::Side>& witness, bones::Side side) {
  return witness && *witness != side;
}

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

std::string told_by(SideSource source) {
  switch (source) {
    case SideSource::None:
    case SideSource::Person:
      return "";
    case SideSource::SourceName:
      return "by the name of the source";
    case SideSource::SegmentName:
      return "by the name of a segment";
    case SideSource::ImageMark:
      return "as the images are marked";
    case SideSource::Fibula:
      return "by the fibula";
    case SideSource::Shapes:
      return "by the shape of the bones alone";
  }
  return "";
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
    import.side_source = SideSource::None;
  } else if (!import.side) {
    import.side = marked;
    import.side_source = SideSource::ImageMark;
  }
  import.lines.push_back(line);
}

void check_side_of_images(BoneImport& import) {
  if (!import.side || !is_against(import.side_in_images, *import.side)) return;
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
  if (is_against(import.side_in_images, side))
    doubts.push_back(other_side_in_images(*import.side_in_images, side));
  if (is_against(import.side_by_fibula, side)) {
    doubts.push_back(other_side_by_fibula(*import.side_by_fibula, side));
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
    if (import.side_source == SideSource::Shapes) import.side_source = SideSource::Person;
    return;
  }
  import.side_is_contradicted = is_against(import.side_by_fibula, side) ||
                                is_against(side_by_shapes(import), side) ||
                                is_against(import.side_in_images, side);
  import.side = side;
  import.side_source = SideSource::Person;
}

bool add_bones(BoneImport& import, BoneImport more) {
  if (import.side && more.side && *import.side != *more.side) return false;
  const auto tell = [](const BoneImport& who_knows, BoneImport& other) {
    if (!who_knows.side || other.side) return;
    say_side(other, *who_knows.side);
    other.side_source = who_knows.side_source;
  };
  tell(import, more);
  tell(more, import);
  import.side_is_contradicted = import.side_is_contradicted || more.side_is_contradicted;
  if (!import.side_by_fibula) import.side_by_fibula = more.side_by_fibula;
  if (!import.side_in_images) import.side_in_images = more.side_in_images;
  std::ranges::move(more.bones, std::back_inserter(import.bones));
  std::ranges::move(more.lines, std::back_inserter(import.lines));
  return true;
}

}  // namespace arthronaut::importing
