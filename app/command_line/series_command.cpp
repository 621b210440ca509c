#include <algorithm>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "app/command_line/after_operation.h"
#include "app/command_line/command.h"
#include "app/command_line/option_checks.h"
#include "planning/bones/mesh_file.h"
#include "planning/cases/identity.h"
#include "planning/files/format.h"
#include "planning/files/json_document.h"
#include "planning/geometry/error.h"
#include "planning/images/series_list.h"
#include "planning/import/series_process.h"

namespace arthronaut::command_line {

namespace {

struct SeriesArguments {
  std::string source;
  bool as_json = false;
  double memory_limit_gib = importing::SeriesRequest{}.memory_limit_gib;
};

nlohmann::ordered_json json_of(const images::ImageSeries& series,
                               const std::vector<library::PlannedCase>& planned) {
  auto files = nlohmann::ordered_json::array();
  for (const auto& file : series.files) files.push_back(file.string());
  auto wrong = nlohmann::ordered_json::array();
  if (!series.is_readable()) wrong.push_back(series.refusal);
  for (const auto& warning : series.warnings) wrong.push_back(warning);
  return {{"uid", series.uid},
          {"number", series.number},
          {"format", series.format},
          {"modality", series.modality},
          {"description", series.description},
          {"images", series.image_count},
          {"size", {series.size.x(), series.size.y(), series.size.z()}},
          {"spacing_mm",
           series.spacing_mm.minCoeff() > 0 ? files::to_json(series.spacing_mm) : nlohmann::ordered_json()},
          {"readable", series.is_readable()},
          {"wrong", std::move(wrong)},
          {"planned_cases", planned_cases_json(planned)},
          {"files", std::move(files)}};
}

void print_json(const images::SeriesList& list) {
  nlohmann::ordered_json document = {{"format", "arthronaut.series"}, {"version", 1}};
  document["series"] = nlohmann::ordered_json::array();
  const auto planned = planned_cases_of(list.series);
  for (std::size_t i = 0; i < list.series.size(); ++i)
    document["series"].push_back(json_of(list.series[i], planned[i]));
  document["skipped"] = nlohmann::ordered_json::array();
  for (const auto& skipped : list.skipped)
    document["skipped"].push_back({{"file", skipped.file.string()}, {"reason", skipped.reason}});
  document["other_files"] = list.other_count;
  files::write_json("-", document);
}

void print(const Context& context, const images::SeriesList& list, const std::string& source) {
  const auto planned = planned_cases_of(list.series);
  for (std::size_t i = 0; i < list.series.size(); ++i) {
    const images::ImageSeries& series = list.series[i];
    std::string line = series.modality.empty() ? series.format : series.modality;
    if (!series.number.empty()) line += " series " + series.number;
    if (!series.description.empty()) line += " \"" + series.description + "\"";
    context.say(line);
    if (!series.uid.empty()) context.say("    UID " + series.uid);
    std::string size =
        files::format("    %d %s", series.image_count, series.image_count == 1 ? "image" : "images");
    // Of what cannot be opened some of it is not known.
    if (series.size.minCoeff() > 0)
      size += files::format("; %d x %d x %d voxels", series.size.x(), series.size.y(), series.size.z());
    if (series.spacing_mm.minCoeff() > 0)
      size += files::format(" of %.3g x %.3g x %.3g mm", series.spacing_mm.x(), series.spacing_mm.y(),
                            series.spacing_mm.z());
    context.say(size);
    const cases::Identity whose{series.patient_name, series.patient_id, ""};
    for (const std::string& part : {whose.in_words(), cases::date_in_words(series.study_date)})
      if (!part.empty()) context.say("    " + part);
    if (!series.is_readable()) context.say("  ! cannot be opened: " + series.refusal);
    for (const auto& warning : series.warnings) context.say("  ! " + warning);
    say_planned_cases(context, planned[i], series.uid, source);
  }
  for (const auto& skipped : list.skipped)
    context.say("left out: " + skipped.file.string() + ": " + skipped.reason);
  if (list.other_count > 0)
    context.say(std::to_string(list.other_count) + (list.other_count == 1 ? " other file" : " other files"));
}

// In a process of its own, as the import: what the files hold ends in a message, not in this program's end.
images::SeriesList found_series(const SeriesArguments& arguments) {
  Progress progress("Looking", 100);
  importing::SeriesProcess process(
      {.source = arguments.source, .memory_limit_gib = arguments.memory_limit_gib});
  const auto state =
      process.finish([&progress](double looked) { progress.advance_to(static_cast<long>(100 * looked)); });
  if (state != importing::SeriesProcess::State::Done) throw InvalidInput(process.message());
  return process.list().value();
}

void list_series(const Context& context, const SeriesArguments& arguments) {
  const images::SeriesList list = found_series(arguments);
  if (list.series.empty()) {
    const std::string first = list.skipped.empty() ? ""
                                                   : " (" + list.skipped.front().file.filename().string() +
                                                         ": " + list.skipped.front().reason + ")";
    const auto is_mesh = [](const auto& entry) { return bones::is_mesh_file(entry.path()); };
    const bool has_mesh = std::filesystem::is_directory(arguments.source) &&
                          std::ranges::any_of(std::filesystem::directory_iterator(arguments.source), is_mesh);
    const std::string meshes =
        has_mesh ? "; its meshes are no images: arthronaut import takes each by its name" : "";
    throw InvalidInput(arguments.source, "", "holds no image" + first + meshes);
  }
  // Of one file there is nothing else to list. In a folder, what is wrong with each is the list.
  if (!std::filesystem::is_directory(arguments.source) &&
      std::ranges::none_of(list.series, &images::ImageSeries::is_readable))
    throw InvalidInput(arguments.source, "", "cannot be opened: " + list.series.front().refusal);
  if (arguments.as_json) {
    print_json(list);
  } else {
    print(context, list, arguments.source);
  }
}

}  // namespace

void add_series_command(CLI::App& app, Context& context) {
  const auto arguments = std::make_shared<SeriesArguments>();
  CLI::App* sub =
      add_subcommand(app, context, "series",
                     "List the image series of a folder, a DICOMDIR or a PACS download, and what is wrong "
                     "with each",
                     "arthronaut series /media/cdrom\n"
                     "  arthronaut import /media/cdrom --series UID -o Knee.arthro");
  sub->add_option("FOLDER", arguments->source, "Folder, DICOMDIR, or one volume file")->required();
  sub->add_flag("--json", arguments->as_json, "The list as JSON");
  sub->add_option("--memory-limit-gib", arguments->memory_limit_gib,
                  "Memory that looking may take; default: 2")
      ->check(above_zero());
  sub->callback([&context, arguments] { list_series(context, *arguments); });
}

}  // namespace arthronaut::command_line
