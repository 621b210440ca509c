#include "app/command_line/option_checks.h"

#include <cmath>
#include <utility>

#include "planning/files/format.h"
#include "planning/geometry/error.h"

namespace arthronaut::command_line {

namespace {

// limits: as the help has them.
CLI::Validator of_number(const std::string& limits, const std::function<bool(double)>& is_right) {
  return {[limits, is_right](const std::string& text) {
            double value = 0;
            if (CLI::detail::lexical_cast(text, value) && is_right(value)) return std::string();
            return "\"" + text + "\" is not a number, " + limits;
          },
          limits};
}

}  // namespace

CLI::Validator between(double least, double greatest) {
  return of_number(files::format("%.16g to %.16g", least, greatest),
                   [least, greatest](double value) { return value >= least && value <= greatest; });
}

CLI::Validator finite() {
  return of_number("finite", [](double value) { return std::isfinite(value); });
}

CLI::Validator above_zero() {
  return of_number("above 0", [](double value) { return value > 0 && std::isfinite(value); });
}

CLI::Validator read_by(std::function<void(const std::string&)> read) {
  return {[read = std::move(read)](const std::string& text) {
            try {
              read(text);
            } catch (const InvalidInput& error) {
              return std::string(error.what());
            }
            return std::string();
          },
          ""};
}

}  // namespace arthronaut::command_line
