// docs/handbook.md names buttons as **Label** (Key). Here it is read, and held against the program's actions.
#include <gtest/gtest.h>

#include <fstream>
#include <regex>
#include <set>
#include <string>

#include "tests/app/window/display.h"
#include "tests/temporary_folder.h"

namespace arthronaut::test {
namespace {

// The ids of the actions that a chapter may name begin with one of these; those of the bar at the top
// anywhere.
std::set<std::string> prefixes_of(const std::string& chapter) {
  if (chapter == "Cases") return {"start."};
  if (chapter == "Painting bones") return {"paint."};
  if (chapter == "Set up") return {"setup."};
  if (chapter == "Train") return {"train."};
  std::string prefix = chapter + ".";
  prefix[0] = static_cast<char>(std::tolower(prefix[0]));
  return {prefix};
}

TEST(Handbook, NamesEveryKeyAsTheProgramHasIt) {
  if (const std::string missing = missing_for_window_tests(); !missing.empty()) GTEST_SKIP() << missing;
  const TemporaryFolder folder;
  const VirtualDisplay display(1280, 720);
  RunningWorkstation app(display, folder.path());
  ASSERT_TRUE(app.wait_for_state("case", "open", 120));

  std::ifstream handbook(ARTHRONAUT_HANDBOOK);
  ASSERT_TRUE(handbook);
  const std::regex button(R"(\*\*([^*]+)\*\* \(([^)]+)\))");
  std::string line, chapter;
  std::map<std::string, int> named;
  while (std::getline(handbook, line)) {
    if (line.starts_with("#")) chapter = line.substr(line.find(' ') + 1);
    for (std::sregex_iterator it(line.begin(), line.end(), button); it != std::sregex_iterator(); ++it) {
      const std::string label = (*it)[1], key = (*it)[2];
      std::set<std::string> prefixes = prefixes_of(chapter);
      prefixes.insert({"app.", "mode."});
      bool is_there = false;
      for (const auto& [state, value] : app.states())
        for (const std::string& prefix : prefixes)
          is_there |= state.starts_with("key." + prefix) && value == key + " " + label;
      EXPECT_TRUE(is_there) << chapter << ": no button \"" << label << "\" with the key " << key;
      ++named[chapter];
    }
  }
  for (const char* mode :
       {"Handbook", "Cases", "Painting bones", "Plan", "Set up", "Navigate", "Review", "Train"})
    EXPECT_GT(named[mode], 1) << mode;
}

}  // namespace
}  // namespace arthronaut::test
