#include "app/command_line/command.h"
#include "planning/cases/case.h"
#include "planning/cases/case_lock.h"
#include "planning/cases/identity.h"
#include "planning/files/utc_clock.h"
#include "planning/geometry/error.h"
#include "planning/import/bone_import.h"

namespace arthronaut::command_line {

namespace {

namespace fs = std::filesystem;

struct ImportArguments {
  std::string source, output, bone, side, unit, space, labels, series, name;
  std::optional<double> threshold;
  bool without_identity = false;
};

importing::BoneImportOptions options_of(const ImportArguments& arguments) {
  importing::BoneImportOptions options;
  if (!arguments.bone.empty()) options.kind = bones::bone_kind_from_text(arguments.bone);
  if (!arguments.side.empty()) options.side = bones::side_from_text(arguments.side);
  if (!arguments.unit.empty()) options.unit = bones::length_unit_from_text(arguments.unit);
  if (!arguments.space.empty()) options.space = bones::space_from_text(arguments.space);
  if (!arguments.labels.empty()) options.labels = importing::labels_from_text(arguments.labels);
  options.threshold = arguments.threshold;
  options.series = arguments.series;
  return options;
}

// The case to add to: the one that is there, or a new one of the side that is known.
cases::Case case_to_extend(const fs::path& folder, const ImportArguments& arguments,
                           const importing::BoneImport& import) {
  if (fs::exists(folder / "case.json")) {
    cases::Case existing = cases::load_case(folder);
    if (import.side && *import.side != existing.side) {
      throw InvalidInput(folder, "",
                         "is a " + std::string(bones::to_text(existing.side)) + " knee, the import is a " +
                             std::string(bones::to_text(*import.side)) + " one" +
                             (import.side_was_guessed ? " by its name (--side says otherwise)" : ""));
    }
    if (!arguments.name.empty()) existing.name = arguments.name;
    return existing;
  }
  if (fs::exists(folder) && !(fs::is_directory(folder) && fs::is_empty(folder))) {
    throw InvalidInput(folder, "", "exists and is not a case: nothing was written");
  }
  if (!import.side) {
    throw InvalidInput(arguments.source, "",
                       "its name does not say which knee it is: add --side left or --side right");
  }
  cases::Case created;
  // Not by the source's or the folder's name: it often is the patient's.
  created.name = arguments.name.empty() ? files::utc_now_as("Knee %Y-%m-%d") : arguments.name;
  created.side = *import.side;
  created.created_utc = files::utc_now();
  return created;
}

void add_bones(const fs::path& folder, cases::Case& target, const importing::BoneImport& import) {
  for (const importing::ImportedBone& imported : import.bones) {
    const bones::BoneKind kind = imported.bone.kind;
    // A tunnel planned on another surface would lie somewhere else in this one.
    if (target.bones.contains(kind) && target.plan.tunnels.contains(kind)) {
      throw InvalidInput(folder, "",
                         "holds a plan on its " + std::string(bones::to_text(kind)) +
                             ", which another bone would make wrong: import into another case");
    }
    target.bones[kind] = imported.bone;
    target.landmarks.erase(kind);
  }
}

// Another patient's bone in a case would be navigated by.
void refuse_another_patient(const fs::path& folder, const cases::Identity& of_import) {
  const auto of_case = cases::load_identity(folder);
  if (!of_case || of_import.is_empty() || *of_case == of_import) return;
  throw InvalidInput(folder, "",
                     "is the knee of another patient (" + of_case->in_words() +
                         ") than what was to be added (" + of_import.in_words() + "); nothing was written");
}

// A folder that this command made does not stay behind when the case cannot be written into it.
void save_whole(const fs::path& folder, const cases::Case& contents, const cases::Identity& identity) {
  const bool was_there = fs::exists(folder);
  try {
    cases::save_case(folder, contents);
    if (!identity.is_empty()) cases::save_identity(folder, identity);
  } catch (...) {
    std::error_code ignored;
    if (!was_there) fs::remove_all(folder, ignored);
    throw;
  }
}

void import(Context& context, const ImportArguments& arguments) {
  const fs::path folder = arguments.output;
  cases::CaseLock lock;  // before the case is read; a new one nobody else knows of
  if (fs::exists(folder / "case.json")) lock = cases::lock_or_refuse(folder);
  if (!lock.notice().empty()) context.say(lock.notice() + ".");
  importing::BoneImport import = importing::import_bones(arguments.source, options_of(arguments));
  if (arguments.without_identity) import.identity = {};
  refuse_another_patient(folder, import.identity);
  cases::Case target = case_to_extend(folder, arguments, import);
  add_bones(folder, target, import);
  save_whole(folder, target, import.identity);

  for (const auto& line : import.lines) context.say(line);
  std::vector<std::string> doubts;
  for (const importing::ImportedBone& imported : import.bones) {
    const std::string bone(bones::to_text(imported.bone.kind));
    for (const auto& line : imported.lines) context.say(bone + ": " + line);
    for (const auto& doubt : imported.doubts) doubts.push_back(bone + ": " + doubt);
  }
  context.say("Wrote " + folder.string() + ": a " + std::string(bones::to_text(target.side)) + " knee" +
              (import.side_was_guessed ? " (by the name of the source)" : "") + ".");
  if (!doubts.empty()) context.say_unreliable(folder.string(), doubts);
}

}  // namespace

void add_import_command(CLI::App& app, Context& context) {
  const auto arguments = std::make_shared<ImportArguments>();
  CLI::App* sub = add_subcommand(
      app, context, "import",
      "Make a case, or add a bone to one, from a mesh, a DICOM folder, a volume or a label map",
      "arthronaut import right_femur.stl -o Knee.arthro\n"
      "  arthronaut import labels.nrrd -o Knee.arthro --label femur=5,tibia=6 --side right");
  sub->add_option("SOURCE", arguments->source,
                  "Mesh (STL, PLY, OBJ, VTK, VTP), folder of DICOM files, or volume (NIfTI, NRRD, MetaImage)")
      ->required();
  sub->add_option("-o,--output", arguments->output, "Case folder to write or to add to")->required();
  sub->add_option("--bone", arguments->bone, "femur or tibia; default: by the name of the source")
      ->check(CLI::IsMember({"femur", "tibia"}));
  sub->add_option("--side", arguments->side, "left or right; default: by the name of the source")
      ->check(CLI::IsMember({"left", "right"}));
  sub->add_option("--unit", arguments->unit, "Unit of a mesh's coordinates: mm, cm, m or in")
      ->check(CLI::IsMember({"mm", "cm", "m", "in"}));
  sub->add_option("--space", arguments->space,
                  "Axes of a mesh: lps or ras; default: as the file says, else lps")
      ->check(CLI::IsMember({"lps", "ras"}, CLI::ignore_case));
  sub->add_option("--label", arguments->labels, "Labels of a label map, as in femur=5,tibia=6");
  sub->add_option("--threshold", arguments->threshold,
                  "Least value of bone in a grey volume; default for CT: 250 HU");
  sub->add_option("--series", arguments->series, "Series number or UID, for a DICOM folder with several");
  sub->add_option("--name", arguments->name, "Name of the case; default: \"Knee\" and the date");
  sub->add_flag("--without-identity", arguments->without_identity,
                "Do not keep whose bones they are; else identity.json holds what a DICOM source says");
  sub->callback([&context, arguments] { import(context, *arguments); });
}

}  // namespace arthronaut::command_line
