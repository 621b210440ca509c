// What the command line promises before it has seen any file.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <regex>
#include <sstream>

#include "app/command_line/command.h"
#include "tests/app/command_line/program.h"
#include "tests/temporary_folder.h"

namespace arthronaut {
namespace {

using test::run_program;
using ::testing::HasSubstr;

class Subcommand : public ::testing::TestWithParam<const char*> {};

// Every subcommand of the interface exists, explains itself and shows an example that starts with its own
// name.
TEST_P(Subcommand, HelpsWithAnExample) {
  const auto result = run_program({GetParam(), "--help"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.output, HasSubstr(std::string("arthronaut ") + GetParam()));
  EXPECT_THAT(result.output, HasSubstr("Example"));
  EXPECT_THAT(result.output, HasSubstr("--quiet"));
  EXPECT_THAT(result.output, HasSubstr("--verbose"));
}

// An option that does not exist is wrong usage everywhere.
TEST_P(Subcommand, RefusesAnUnknownOption) {
  const auto result = run_program({GetParam(), "--no-such-option"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.errors, ::testing::StartsWith("arthronaut: "));
  EXPECT_THAT(result.errors, HasSubstr(std::string("see arthronaut ") + GetParam()));
}

INSTANTIATE_TEST_SUITE_P(All, Subcommand,
                         ::testing::Values("calibrate", "cases", "check-fluid", "accuracy", "compare",
                                           "track", "pivot", "digitise", "register", "import", "landmarks",
                                           "plan", "phantom", "navigate", "replay", "report", "dicom",
                                           "resume", "rig", "segment", "series", "verify", "pacs", "markers",
                                           "demo", "train", "sources", "experiment"),
                         [](const auto& test) {
                           std::string name = test.param;
                           std::replace(name.begin(), name.end(), '-',
                                        '_');  // a name of a test has no hyphen
                           return name;
                         });

TEST(CommandLine, SaysItsVersion) {
  const auto result = run_program({"--version"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.output, HasSubstr("arthronaut 0."));
}

// A stream's password goes nowhere that others read.
TEST(CommandLine, TheLogHoldsNoPassword) {
  const test::TemporaryFolder folder;
  (void)run_program({"navigate", folder / "none.arthro", "--video", "rtsp://nurse:s3cret@127.0.0.1:1/scope",
                     "--log", folder / "run.log"});
  std::ifstream stream(folder / "run.log");
  const std::string log{std::istreambuf_iterator<char>(stream), {}};
  EXPECT_THAT(log, HasSubstr("127.0.0.1"));
  EXPECT_THAT(log, ::testing::Not(HasSubstr("s3cret")));
}

// The log tells how a run was started, what went wrong, and how it ended; a second run appends.
TEST(CommandLine, LogsStartErrorAndEnd) {
  const test::TemporaryFolder folder;
  const std::string log = folder / "run.log";
  EXPECT_EQ(run_program({"report", folder / "none.arthro", "-o", folder / "a.pdf", "--log", log}).exit_code,
            3);
  EXPECT_EQ(run_program({"phantom", "-o", folder / "Knee.arthro", "--log", log, "--quiet"}).exit_code, 0);
  std::ifstream stream(log);
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  using ::testing::AllOf;
  ASSERT_THAT(lines, ::testing::SizeIs(::testing::Ge(5)));
  EXPECT_THAT(lines[0], AllOf(HasSubstr(" info "), HasSubstr("started: arthronaut 0."), HasSubstr("report")));
  EXPECT_THAT(lines[1], AllOf(HasSubstr(" error "), HasSubstr("none.arthro")));
  EXPECT_THAT(lines[2], HasSubstr("ended with exit code 3"));
  EXPECT_THAT(lines.back(), HasSubstr("ended with exit code 0"));
}

// A log that can't be written is told before anything is done.
TEST(CommandLine, RefusesALogThatCannotBeWritten) {
  const test::TemporaryFolder folder;
  const auto result =
      run_program({"phantom", "-o", folder / "Knee.arthro", "--log", folder / "none" / "run.log"});
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_THAT(result.errors, HasSubstr("run.log"));
  EXPECT_FALSE(std::filesystem::exists(folder / "Knee.arthro"));
}

// A slip of the keyboard is named, and nothing is opened.
TEST(CommandLine, RefusesAnUnknownSubcommand) {
  const auto result = run_program({"trakc", "--help-me"});
  EXPECT_EQ(result.exit_code, 2);
  const auto with_options = run_program({"trakc", "--camera", "camera.json"});
  EXPECT_EQ(with_options.exit_code, 2);
  EXPECT_THAT(with_options.errors, HasSubstr("\"trakc\" is neither a subcommand nor a case folder"));
  const auto word = run_program({"trakc"});
  EXPECT_EQ(word.exit_code, 2);
  EXPECT_THAT(word.errors, HasSubstr("trakc"));
}

TEST(CommandLine, SaysWhichRequiredOptionIsMissing) {
  const auto result = run_program({"track", "--tools", "tools.json", "-o", "-", "clip.mkv"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.errors, HasSubstr("--camera"));
}

// A word that is no medium is a slip of the keyboard too.
TEST(CommandLine, RefusesAnUnknownMedium) {
  const auto result =
      run_program({"track", "--camera", "c", "--tools", "t", "--medium", "mud", "-o", "-", "clip.mkv"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.errors, HasSubstr("mud"));
}

// Before any file is read or any peer is called: a value that cannot be right is wrong usage, and is named.
TEST(CommandLine, AValueThatCannotBeRightIsWrongUsage) {
  const std::vector<std::string> with_bone{"register", "--bone", "b", "--curves", "c", "-o", "r.json"};
  const std::vector<std::string> with_case{"navigate", "Knee.arthro", "--video", "clip.mkv"};
  const std::vector<std::string> with_peer{"--peer", "PACS@127.0.0.1:104"};
  const auto expect_refused = [](std::vector<std::string> arguments, const std::vector<std::string>& more,
                                 const std::string& named) {
    arguments.insert(arguments.end(), more.begin(), more.end());
    const auto result = run_program(arguments);
    EXPECT_EQ(result.exit_code, 2) << named;
    EXPECT_THAT(result.errors, HasSubstr(named));
  };
  for (const auto& command : {with_bone, with_case}) {
    expect_refused(command, {"--space", "las"}, "--space");
    expect_refused(command, {"--unit", "parsec"}, "--unit");
  }
  expect_refused(with_bone, {"--target", "1e308,0,0"}, "--target");
  for (const char* command : {"demo", "phantom"})
    expect_refused({command, "-o", "k"}, {"--seed", "-1"}, "--seed");
  expect_refused(with_bone, {"--seed", "-1"}, "--seed");
  expect_refused({"markers", "-o", "m.pdf"}, {"--ids", "3,50"}, "--ids");
  expect_refused({"pivot", "--poses", "p.csv", "-o", "t.json"}, {"--marker", "99"}, "--marker");
  expect_refused({"pivot", "--marker", "2", "--poses", "p.csv", "-o", "t.json"}, {"--world", "50"},
                 "--world");
  expect_refused({"check-fluid", "--camera", "c.json", "--tools", "t.json", "r.mkv"}, {"--markers", "5,99"},
                 "--markers");
  expect_refused({"markers", "-o", "m.pdf"}, {"--size-mm", "101"}, "--size-mm");
  expect_refused({"markers"}, {"-o", "m.png"}, "m.png does not end in .pdf");
  expect_refused({"calibrate", "--square-mm", "1.5", "-o", "c.json"}, {"a.png", "b.png"}, "three pictures");
  for (const char* whole : {"2.5", "1e1", "9999999999", "nan"}) {
    const std::string is_no_number = "\"" + std::string(whole) + "\" must be a whole number, ";
    expect_refused({"compare", "K.arthro", "--postop", "p.nrrd", "-o", "a.json"}, {"--label", whole},
                   "--label: " + is_no_number);
    expect_refused({"pivot", "--poses", "p.csv", "-o", "t.json"}, {"--marker", whole},
                   "--marker: " + is_no_number);
    expect_refused(with_case, {"--igtl", whole}, "--igtl: " + is_no_number);
    expect_refused({"experiment", "registration", "--bone", "b"}, {"--trials", whole},
                   "--trials: " + is_no_number);
  }
  expect_refused({"demo", "-o", "k"}, {"--seed", "1.5"}, "--seed: \"1.5\" must be a whole number, ");
  expect_refused({"rig", "--poses", "p.csv", "--tool", "probe", "-o", "t.json"}, {"--markers", "5,5"},
                 "--markers");
  expect_refused({"rig", "--poses", "p.csv", "--tool", "", "-o", "t.json"}, {}, "--tool");
  expect_refused({"pacs", "echo"}, {"--peer", "PACS@host:0"}, "--peer");
  expect_refused({"pacs", "echo", "--aet", "back\\slash"}, with_peer, "--aet");
  expect_refused({"pacs", "find"}, with_peer, "names no patient");
  for (const char* date : {"2026", "20260131-2027", "-"})
    expect_refused({"pacs", "find", "--date=" + std::string(date)}, with_peer, "is no date");
  expect_refused({"pacs", "get", "--series", "knee", "-o", "got"}, with_peer, "no UID");
}

// Of an option that changes nothing whoever gave it believes that it did.
TEST(CommandLine, AnOptionThatWouldChangeNothingIsWrongUsage) {
  const std::vector<std::string> navigate{"navigate", "Knee.arthro", "--video", "clip.mkv"};
  const std::vector<std::string> send{"pacs", "send", "--web", "http://127.0.0.1:1/dicom-web", "results"};
  const std::vector<std::pair<std::vector<std::string>, std::vector<std::string>>> senseless{
      {navigate, {"--igtl-network"}},
      {navigate, {"--space", "ras"}},
      {navigate, {"--unit", "cm"}},
      {navigate, {"--no-copy", "--pictures", "h264"}},
      {send, {"--password-file", "secret"}},
      {send, {"--aet", "THEATRE"}},
      {send, {"--listen", "11113"}},
      {send, {"--no-commitment"}},
      {send, {"--commitment-wait-s", "9"}},
      {{"pacs", "send", "--peer", "PACS@127.0.0.1:104", "results"},
       {"--no-commitment", "--require-commitment"}},
      {{"cases"}, {"--with-identity"}},
      {{"segment", "knee.nrrd", "--seeds", "s.nrrd", "-o", "l.nrrd"}, {"--side", "left"}},
      {{"experiment", "lens-rotation", "--video", "v", "--camera", "c", "--truth", "t"}, {"--frames", "9"}},
  };
  for (const auto& [command, option] : senseless) {
    std::vector<std::string> arguments = command;
    arguments.insert(arguments.end(), option.begin(), option.end());
    const auto result = run_program(arguments);
    EXPECT_EQ(result.exit_code, 2) << option.front();
    EXPECT_THAT(result.errors, HasSubstr(option.front()));
  }
}

// It stands on the program as well as on what it does.
TEST(CommandLine, QuietStandsOnTheProgramToo) {
  const test::TemporaryFolder folder;
  const auto result = run_program({"--quiet", "phantom", "-o", folder / "Knee.arthro"});
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_EQ(result.output + result.errors, "");
}

struct Help {
  std::vector<std::string> subcommands;
  std::vector<std::pair<std::string, std::string>> fractions;  // options that take them, with their type
};

// In this process: two hundred starts of the executable would take a minute.
test::ProgramResult run_here(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "arthronaut");
  std::vector<char*> argv;
  for (std::string& argument : arguments) argv.push_back(argument.data());
  ::testing::internal::CaptureStdout();
  ::testing::internal::CaptureStderr();
  test::ProgramResult result;
  result.exit_code = command_line::run_command_line(static_cast<int>(argv.size()), argv.data(),
                                                    [](const auto&) { return 0; });
  result.output = ::testing::internal::GetCapturedStdout();
  result.errors = ::testing::internal::GetCapturedStderr();
  return result;
}

Help help_of(std::vector<std::string> command) {
  command.push_back("--help");
  std::istringstream lines(run_here(command).output);
  const std::regex fraction(R"( +(?:-\w,)?(--[\w-]+) (FLOAT|MEDIUM|X,Y,Z)\b.*)"),
      subcommand(R"(  ([a-z][\w-]*).*)");
  Help help;
  bool lists_subcommands = false;
  for (std::string line; std::getline(lines, line);) {
    std::smatch found;
    if (!line.starts_with(' ')) lists_subcommands = line == "Subcommands:";
    if (lists_subcommands && std::regex_match(line, found, subcommand)) help.subcommands.push_back(found[1]);
    if (std::regex_match(line, found, fraction)) help.fractions.emplace_back(found[1], found[2]);
  }
  return help;
}

// Asks it of the command's options and of those of its subcommands; which they are.
std::vector<std::string> refuse_what_is_no_number(const std::vector<std::string>& command) {
  std::vector<std::string> refused;
  const Help help = help_of(command);
  for (const auto& [option, type] : help.fractions) {
    for (std::string value : {"nan", "inf", "1e999"}) {
      if (type == "X,Y,Z") value += ",0,0";
      std::vector<std::string> arguments = command;
      arguments.push_back(option + "=" + value);
      const auto result = run_here(arguments);
      EXPECT_EQ(result.exit_code, 2) << option << "=" << value;
      EXPECT_THAT(result.errors, HasSubstr(option)) << value;
    }
    refused.push_back((command.empty() ? "" : command.back() + " ") + option);
  }
  for (const std::string& name : help.subcommands) {
    std::vector<std::string> subcommand = command;
    subcommand.push_back(name);
    const auto of_it = refuse_what_is_no_number(subcommand);
    refused.insert(refused.end(), of_it.begin(), of_it.end());
  }
  return refused;
}

// Not a number, infinite and too large: no option takes these for a number, and each is named, before any
// other thing that is missing.
TEST(CommandLine, NoOptionTakesWhatIsNoNumber) {
  EXPECT_THAT(refuse_what_is_no_number({}),
              ::testing::IsSupersetOf({"calibrate --square-mm", "get --most-gb", "get --timeout-s",
                                       "markers --size-mm", "navigate --duration-s", "plan --entry",
                                       "registration --area", "track --medium"}));
}

}  // namespace
}  // namespace arthronaut
