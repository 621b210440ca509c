#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "app/command_line/command.h"
#include "planning/files/format.h"
#include "planning/files/json_document.h"
#include "planning/geometry/error.h"
#include "planning/images/series_list.h"

namespace arthronaut::command_line {

namespace {

nlohmann::ordered_json json_of(const images::ImageSeries& series) {
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
          {"spacing_mm", files::to_json(series.spacing_mm)},
          {"readable", series.is_readable()},
          {"wrong", std::move(wrong)},
          {"files", std::move(files)}};
}

void print_json(const images::SeriesList& list) {
  nlohmann::ordered_json document = {{"format", "arthronaut.series"}, {"version", 1}};
  document["series"] = nlohmann::ordered_json::array();
  for (const auto& series : list.series) document["series"].push_back(json_of(series));
  document["skipped"] = nlohmann::ordered_json::array();
  for (const auto& skipped : list.skipped)
    document["skipped"].push_back({{"file", skipped.file.string()}, {"reason", skipped.reason}});
  document["other_files"] = list.other_count;
  files::write_json("-", document);
}

void print(const Context& context, const images::SeriesList& list) {
  for (const auto& series : list.series) {
    std::string line = series.modality.empty() ? series.format : series.modality;
    if (!series.number.empty()) line += " series " + series.number;
    if (!series.description.empty()) line += " \"" + series.description + "\"";
    context.say(line);
    if (!series.uid.empty()) context.say("    UID " + series.uid);
    context.say(files::format("    %d %s; %d x %d x %d voxels of %.3g x %.3g x %.3g mm", series.image_count,
                              series.image_count == 1 ? "image" : "images", series.size.x(), series.size.y(),
                              series.size.z(), series.spacing_mm.x(), series.spacing_mm.y(),
                              series.spacing_mm.z()));
    if (!series.is_readable()) context.say("  ! cannot be opened: " + series.refusal);
    for (const auto& warning : series.warnings) context.say("  ! " + warning);
  }
  for (const auto& skipped : list.skipped)
    context.say("left out: " + skipped.file.string() + ": " + skipped.reason);
  if (list.other_count > 0)
    context.say(std::to_string(list.other_count) + (list.other_count == 1 ? " other file" : " other files"));
}

void list_series(const Context& context, const std::string& source, bool as_json) {
  images::SeriesList list;
  {
    Progress progress("Looking", 100);
    images::VolumeFileOptions options;
    options.on_progress = [&](double fraction) { progress.advance_to(static_cast<long>(100 * fraction)); };
    list = images::find_series(source, options);
  }
  if (list.series.empty()) {
    const std::string first = list.skipped.empty() ? ""
                                                   : " (" + list.skipped.front().file.filename().string() +
                                                         ": " + list.skipped.front().reason + ")";
    throw InvalidInput(source, "", "holds no image" + first);
  }
  if (as_json) {
    print_json(list);
  } else {
    print(context, list);
  }
}

}  // namespace

void add_series_command(CLI::App& app, Context& context) {
  struct Arguments {
    std::string source;
    bool as_json = false;
  };
  const auto arguments = std::make_shared<Arguments>();
  CLI::App* sub =
      add_subcommand(app, context, "series",
                     "List the image series of a folder, a DICOMDIR or a PACS download, and what is wrong "
                     "with each",
                     "arthronaut series /media/cdrom\n"
                     "  arthronaut import /media/cdrom --series UID -o Knee.arthro");
  sub->add_option("FOLDER", arguments->source, "Folder, DICOMDIR, or one volume file")->required();
  sub->add_flag("--json", arguments->as_json, "The list as JSON");
  sub->callback([&context, arguments] { list_series(context, arguments->source, arguments->as_json); });
}

}  // namespace arthronaut::command_line
