#include <cmath>
#include <memory>
#include <optional>
#include <utility>

#include "app/command_line/after_operation.h"
#include "app/command_line/command.h"
#include "app/command_line/interruption.h"
#include "app/command_line/option_checks.h"
#include "app/library/workstation_library.h"
#include "planning/cases/case_lock.h"
#include "planning/geometry/error.h"
#include "planning/import/case_import.h"
#include "planning/import/import_child.h"
#include "planning/import/import_process.h"
#include "planning/import/import_side.h"

namespace arthronaut::command_line {

namespace {

namespace fs = std::filesystem;

struct ImportArguments {
  std::string source, output, bone, side, unit, space, labels, series, name;
  std::optional<double> threshold;
  double memory_limit_gib = importing::ImportRequest{}.memory_limit_gib;
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

// Waits, shows how far it is, and passes an interruption on.
void watch(importing::ImportProcess& process, const Interruption& interruption) {
  constexpr double kLongestWait_s = 0.1;
  Progress line("", 100);  // of all stages
  while (process.wait_for(kLongestWait_s) == importing::ImportProcess::State::Running) {
    line.name(importing::in_words(process.progress().stage));
    line.advance_to(std::lround(100 * process.done_fraction()));
    if (interruption.caught() != 0) process.cancel();
  }
}

void import(Context& context, const ImportArguments& arguments) {
  const fs::path folder = arguments.output;
  cases::CaseLock lock;  // before the case is read; a new one nobody else knows of
  if (fs::exists(folder / "case.json")) lock = cases::lock_or_refuse(folder);
  if (!lock.notice().empty()) context.say(lock.notice() + ".");
  importing::refuse_folder(folder);
  importing::refuse_missing_side(folder, arguments.source, options_of(arguments));
  importing::BoneImportOptions options = options_of(arguments);
  options.needs_side = !fs::exists(folder / "case.json");
  const Interruption interruption;  // over the writing as well, which takes no time
  importing::ImportProcess process({.source = arguments.source,
                                    .options = std::move(options),
                                    .memory_limit_gib = arguments.memory_limit_gib});
  watch(process, interruption);
  if (interruption.caught() != 0) {
    process.cancel();
    interruption.end_program();
  }
  if (process.state() != importing::ImportProcess::State::Done) throw InvalidInput(process.message());
  importing::BoneImport import = process.take_result();
  if (arguments.without_identity) import.forget_patient();
  const std::vector<std::string> replaced = importing::replaced_in_words(folder, import);
  const cases::Case target = importing::add_to_case(folder, import, arguments.name, arguments.source);

  for (const auto& line : import.lines) context.say(line);
  for (const auto& line : replaced) context.say(line);
  std::vector<std::string> doubts;
  for (const importing::ImportedBone& imported : import.bones) {
    const std::string bone(bones::to_text(imported.bone.kind));
    for (const auto& line : imported.lines) context.say(bone + ": " + line);
    for (const auto& doubt : importing::doubts_with(import, imported, target.side))
      doubts.push_back(bone + ": " + cases::words_of(doubt));
    if (const auto space = imported.likelier_in())
      doubts.push_back(bone + ": --space " + std::string(bones::to_text(*space)) +
                       " reads it the other way round");
  }
  workstation_library::note_case(folder);
  const auto note = importing::side_note(import, target.side);
  const std::string by = note ? "as said; nothing in the images or the shape of the bones confirms it"
                              : importing::told_by(import.side_source);
  context.say("Wrote " + folder.string() + ": a " + std::string(bones::to_text(target.side)) + " knee" +
              (by.empty() ? "" : " (" + by + ")") + ".");
  const library::TakenImages taken{import.identity, import.origin.study_date, import.origin.series_uid};
  say_planned_cases(context, workstation_library::planned_cases_of({&taken, 1}).front(), taken.series_uid,
                    arguments.source);
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
  sub->add_option(
         "SOURCE", arguments->source,
         "Mesh (STL, PLY, OBJ, VTK, VTP), DICOM (folder, DICOMDIR or enhanced file), or volume (NIfTI, "
         "NRRD, MetaImage)")
      ->required();
  sub->add_option("-o,--output", arguments->output, "Case folder to write or to add to")
      ->required()
      ->check(a_file());
  sub->add_option("--bone", arguments->bone,
                  "femur or tibia; default: of a mesh by its name, of a CT or a label map both")
      ->check(CLI::IsMember({"femur", "tibia"}));
  sub->add_option("--side", arguments->side,
                  "left or right; default: by the name of the source, by the fibula in a CT, or by the shape "
                  "of the bones")
      ->check(CLI::IsMember({"left", "right"}));
  sub->add_option("--unit", arguments->unit, "Unit of a mesh's coordinates: mm, cm, m or in")
      ->check(CLI::IsMember({"mm", "cm", "m", "in"}));
  sub->add_option("--space", arguments->space,
                  "Axes of a mesh: lps or ras; default: as the file says, else lps")
      ->check(CLI::IsMember({"lps", "ras"}, CLI::ignore_case));
  sub->add_option("--label", arguments->labels,
                  "Labels of a label map, as in femur=5,tibia=6; default: by the names of its segments, or "
                  "by their shapes")
      ->check(read_by([](const std::string& text) { (void)importing::labels_from_text(text); }));
  sub->add_option("--threshold", arguments->threshold,
                  "Least value of bone in a grey volume; default for CT: 250 HU, 180 HU for coarse voxels")
      ->check(finite());
  sub->add_option("--series", arguments->series, "Series number or UID, for DICOM with several");
  sub->add_option("--name", arguments->name, "Name of the case; default: \"Knee\", date and time");
  sub->add_option("--memory-limit-gib", arguments->memory_limit_gib,
                  "Memory that reading and surface making may take; default: 2")
      ->check(above_zero());
  sub->add_flag(
      "--without-identity", arguments->without_identity,
      "Do not keep whose bones they are; else identity.json and study.json hold what a DICOM source says");
  sub->callback([&context, arguments] { import(context, *arguments); });
  // What ImportProcess starts this program with; not for a person.
  CLI::App* child = app.add_subcommand(importing::kImportChildWord)->group("");
  child->callback([&context] { context.exit_code = importing::run_import_child(); });
}

}  // namespace arthronaut::command_line
