#include "app/command_line/command.h"
#include "app/report/report.h"

namespace arthronaut::command_line {

void add_report_command(CLI::App& app, Context& context) {
  struct Arguments {
    std::string case_folder, output;
    report::ReportOptions options;
  };
  const auto arguments = std::make_shared<Arguments>();
  CLI::App* sub =
      add_subcommand(app, context, "report", "Write the report: plan, theatre, planned against achieved",
                     "arthronaut report Knee.arthro -o report.pdf");
  sub->add_option("case", arguments->case_folder, "Case folder")->required();
  sub->add_option("-o,--output", arguments->output, "PDF to write")->required();
  sub->add_flag("--with-identity", arguments->options.with_identity,
                "Name the patient (identity.json of the case); without it the report names nobody");
  sub->callback([arguments, &context] {
    report::write_report(arguments->case_folder, arguments->output, arguments->options);
    context.say("Wrote " + arguments->output + ".");
  });
}

}  // namespace arthronaut::command_line
