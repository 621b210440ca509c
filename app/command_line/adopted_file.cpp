#include "app/command_line/adopted_file.h"

#include <algorithm>
#include <utility>

#include "app/case/case_calibration.h"
#include "planning/files/atomic_file.h"

namespace arthronaut::command_line {

namespace fs = std::filesystem;

AdoptedFile::AdoptedFile(std::string given, fs::path of_case)
    : given_(std::move(given)), of_case_(std::move(of_case)) {
  const bool is_the_cases =
      given_.empty() || fs::absolute(given_).lexically_normal() == fs::absolute(of_case_).lexically_normal();
  if (!is_the_cases) text_ = files::read_text(given_);
}

void AdoptedFile::write(const Context& context, const std::string& kept_because) const {
  if (!text_) return;
  if (!kept_because.empty())
    return context.say("The case's " + of_case_.filename().string() + " stays as it is: " + kept_because +
                       ".");
  const bool is_replaced = fs::exists(of_case_) && files::read_text(of_case_) != *text_;
  files::write_atomically(of_case_, *text_);
  if (is_replaced) context.say("The case's " + of_case_.filename().string() + " is now " + given_ + ".");
}

bool has_simulated(const tools::ToolSet& tools) {
  return std::ranges::any_of(tools.tools, [](const tools::Tool& tool) {
    return tool.provenance.origin == provenance::Origin::Simulated;
  });
}

void adopt(const Context& context, const GivenFile& camera, const GivenFile& tools,
           const fs::path& case_folder) {
  // Both asked before either is written: a real camera speaks for the tools beside it.
  const std::string camera_stays = open_case::camera_is_kept(camera.is_simulated, case_folder);
  const std::string tools_stay = open_case::tools_are_kept(tools.is_simulated, case_folder);
  camera.file.write(context, camera_stays);
  tools.file.write(context, tools_stay);
}

}  // namespace arthronaut::command_line
