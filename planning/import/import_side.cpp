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

bool shapes_may_tell(const BoneImport& import) {
  return std::ranges::count_if(import.bones, [](const ImportedBone& bone) {
           return bone.doubts.empty() && bone.filled_holes.empty();
         }) >= 2;
}

std::string why_no_side(const BoneImport& import, const std::string& of_fibula) {
  std::string words = "nothing tells which knee it is: ";
  words += import.side_in_images ? "its name and the mark in its images say different sides"
                                 : "its name does not say it, nor does a mark in images";
  if (!of_fibula.empty()) words += "; " + of_fibula;
  if (import.bones.size() < 2)
    words += "; the shape of one bone alone does not tell it surely";
  else if (judged_count(import) == 0 && !shapes_may_tell(import))
    words += "; the shapes of the bones are in doubt themselves";
  else
    words += "; the shapes of femur and tibia do not tell it both alike";
  return words + ". Look at the images or at the request for them, and add --side left or --side right";
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

bool side_is_contradicted(const BoneImport& import) {
  return import.side && (is_against(import.side_in_images, *import.side) ||
                         is_against(import.side_by_fibula, *import.side) ||
                         is_against(side_by_shapes(import), *import.side));
}

std::vector<cases::BoneDoubt> doubts_with(const BoneImport& import, const ImportedBone& bone,
                                          std::optional<bones::Side> side, bool is_said_by_person) {
  using enum cases::SideWitness;
  std::vector<cases::BoneDoubt> doubts(bone.doubts.begin(), bone.doubts.end());
  if (!bone.filled_holes.empty()) doubts.emplace_back(cases::FilledHoles{bone.filled_holes});
  std::ranges::copy_if(bone.image_cuts, std::back_inserter(doubts), &bones::ImageCut::is_wide);
  if (!side) return doubts;
  const auto tells = [&](cases::SideWitness witness, bones::Side told) {
    doubts.emplace_back(cases::SideDoubt{witness, told, *side});
  };
  if (is_against(import.side_in_images, *side)) tells(ImageMark, *import.side_in_images);
  if (is_against(import.side_by_fibula, *side)) {
    tells(Fibula, *import.side_by_fibula);
    return doubts;
  }
  const auto shape = side_by_shapes(import);
  if (!shape || !bone.shape_was_judged) return doubts;
  if (*shape != *side)
    tells(judged_count(import) > 1 ? BothShapes : OneShape, *shape);
  else if (import.side_source == SideSource::Shapes && !is_said_by_person)
    tells(ShapesAlone, *shape);
  return doubts;
}

bool side_is_borne_out(const BoneImport& import, bones::Side side) {
  return import.side_in_images == side || import.side_by_fibula == side || side_by_shapes(import) == side;
}

std::optional<cases::SideDoubt> side_note(const BoneImport& import, bones::Side side,
                                          bool is_said_by_person) {
  if (!is_said_by_person && import.side_source != SideSource::Person) return std::nullopt;
  const bool is_spoken_against = is_against(import.side_in_images, side) ||
                                 is_against(import.side_by_fibula, side) ||
                                 is_against(side_by_shapes(import), side);  // a doubt says so
  if (is_spoken_against || side_is_borne_out(import, side)) return std::nullopt;
  return cases::SideDoubt{cases::SideWitness::PersonAlone, side, side};
}

void say_side(BoneImport& import, bones::Side side) {
  // Known as it was known, unless it was the shapes alone that knew it.
  if (import.side == side && import.side_source != SideSource::Shapes) return;
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
  if (!import.side_by_fibula) import.side_by_fibula = more.side_by_fibula;
  if (!import.side_in_images) import.side_in_images = more.side_in_images;
  std::ranges::move(more.bones, std::back_inserter(import.bones));
  std::ranges::move(more.lines, std::back_inserter(import.lines));
  return true;
}

}  // namespace arthronaut::importing
