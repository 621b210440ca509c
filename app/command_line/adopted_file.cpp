#include "app/command_line/adopted_file.h"

#include <utility>

#include "planning/files/atomic_file.h"

namespace arthronaut::command_line {

namespace fs = std::filesystem;

AdoptedFile::AdoptedFile(std::string given, fs::path of_case)
    : given_(std::move(given)), of_case_(std::move(of_case)) {
  const bool is_the_cases =
      given_.empty() || fs::absolute(given_).lexically_normal() == fs::absolute(of_case_).lexically_normal();
  if (!is_the_cases) text_ = files::read_text(given_);
}

void AdoptedFile::write(const Context& context) const {
  if (!text_) return;
  const bool is_replaced = fs::exists(of_case_) && files::read_text(of_case_) != *text_;
  files::write_atomically(of_case_, *text_);
  if (is_replaced) context.say("The case's " + of_case_.filename().string() + " is now " + given_ + ".");
}

}  // namespace arthronaut::command_line
