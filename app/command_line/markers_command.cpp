#include "app/command_line/command.h"
#include "app/command_line/option_checks.h"
#include "app/report/marker_sheet.h"

namespace arthronaut::command_line {

void add_markers_command(CLI::App& app, Context& context) {
  struct Arguments {
    std::string output;
    report::MarkerSheetOptions sheet;
  };
  const auto arguments = std::make_shared<Arguments>();
  CLI::App* sub = add_subcommand(app, context, "markers",
                                 "Write a printable sheet of markers and a checkerboard at true size",
                                 "arthronaut markers -o markers.pdf --size-mm 4");
  sub->add_option("-o,--output", arguments->output, "PDF to write")->required()->check(a_file());
  sub->add_option("--ids", arguments->sheet.ids, "Marker ids of DICT_4X4_50")
      ->delimiter(',')
      ->check(a_marker_id())
      ->capture_default_str();
  sub->add_option("--size-mm", arguments->sheet.size_mm, "Side of the black square")
      ->check(between(0.1, 100))
      ->capture_default_str();
  sub->add_option("--square-mm", arguments->sheet.square_mm, "Side of the checkerboard's squares")
      ->check(between(0.1, 100))
      ->capture_default_str();
  sub->callback([arguments, &context] {
    refuse_another_ending(arguments->output, {".pdf"});
    refuse_before_the_work({.read = {}, .written = {arguments->output}});
    report::write_marker_sheet(arguments->output, arguments->sheet);
    context.say("Wrote " + arguments->output + ": check the 50 mm rule after printing.");
  });
}

}  // namespace arthronaut::command_line
