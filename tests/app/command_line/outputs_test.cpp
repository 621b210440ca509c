// What is written takes the place of nothing that would be lost, and is asked about before any work: every
// command by the same rules.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <csignal>

#include "planning/files/atomic_file.h"
#include "tests/app/command_line/program.h"
#include "tests/temporary_folder.h"

namespace arthronaut {
namespace {

namespace fs = std::filesystem;
using test::run_program;
using ::testing::AllOf;
using ::testing::HasSubstr;

struct WritingCommand {
  const char* name;
  std::vector<std::string> arguments;  // all but the output; "@" stands for the input
};

void PrintTo(const WritingCommand& command, std::ostream* stream) { *stream << command.name; }

class Output : public ::testing::TestWithParam<WritingCommand> {
 protected:
  Output() {
    test::write_file(input_, "somebody's work");
    fs::create_directories(folder_ / "Knee.arthro/sessions/0001");
    for (const char* own : {"case.json", "plan.json", "sessions/0001/session.json"})
      test::write_file(folder_ / "Knee.arthro" / own, "{}");
  }
  [[nodiscard]] test::ProgramResult write_to(const fs::path& output,
                                             const test::ProgramLimits& limits = {}) const {
    std::vector<std::string> arguments = GetParam().arguments;
    for (std::string& argument : arguments)
      if (argument == "@") argument = input_;
    arguments.insert(arguments.end(), {"-o", output});
    return run_program(arguments, limits);
  }
  const test::TemporaryFolder folder_;
  const fs::path input_ = folder_ / "input";
};

// The input is as it was: no command reads it before it has asked.
TEST_P(Output, IsNeverWhatIsRead) {
  fs::create_symlink(input_, folder_ / "link");
  for (const fs::path& output :
       {input_, folder_ / "../" / folder_.path().filename() / "input", folder_ / "link"}) {
    const auto result = write_to(output);
    EXPECT_EQ(result.exit_code, 3) << output;
    EXPECT_THAT(result.errors, AllOf(HasSubstr(output.filename()), HasSubstr("is what is read"))) << output;
  }
  EXPECT_EQ(files::read_text(input_), "somebody's work");
}

TEST_P(Output, IsNeverACasesOwnFile) {
  for (const char* own : {"plan.json", "sessions/0001/session.json"}) {
    const auto result = write_to(folder_ / "Knee.arthro" / own);
    EXPECT_EQ(result.exit_code, 3);
    EXPECT_THAT(result.errors, HasSubstr(std::string(own) + ": is one of the case's own files"));
    EXPECT_EQ(files::read_text(folder_ / "Knee.arthro" / own), "{}");
  }
}

TEST_P(Output, IsAskedAboutBeforeTheWork) {
  const auto nowhere = write_to(folder_ / "nowhere/out");
  EXPECT_EQ(nowhere.exit_code, 3);
  EXPECT_THAT(nowhere.errors, AllOf(HasSubstr("nowhere/out: the folder"), HasSubstr("does not exist")));
  const auto folder = write_to(folder_ / "Knee.arthro");
  EXPECT_EQ(folder.exit_code, 3);
  EXPECT_THAT(folder.errors, HasSubstr("Knee.arthro: is a folder, not a file"));
  if (::geteuid() == 0) {  // else the folder is the tester's own and writable
    const auto closed = write_to(folder_ / "out", {.as_nobody = true});
    EXPECT_EQ(closed.exit_code, 3);
    EXPECT_THAT(closed.errors,
                HasSubstr((folder_ / "out").string() + ": cannot be written: Permission denied"));
  }
  EXPECT_EQ(write_to("").exit_code, 2);
}

INSTANTIATE_TEST_SUITE_P(
    Of, Output,
    ::testing::Values(WritingCommand{"calibrate", {"calibrate", "--square-mm", "1.5", "@", "@", "@"}},
                      WritingCommand{"track", {"track", "--camera", "@", "--tools", "@", "@"}},
                      WritingCommand{"pivot", {"pivot", "--marker", "2", "--poses", "@"}},
                      WritingCommand{"digitise", {"digitise", "--poses", "@", "--tools", "@"}},
                      WritingCommand{"register", {"register", "--bone", "@", "--curves", "@"}},
                      WritingCommand{"rig", {"rig", "--tool", "probe", "--poses", "@"}},
                      WritingCommand{"compare", {"compare", "Knee.arthro", "--postop", "@"}},
                      WritingCommand{"check_fluid", {"check-fluid", "--camera", "@", "--tools", "@", "@"}},
                      WritingCommand{"train", {"train", "--exercise", "aim", "--hand", "@"}}),
    [](const auto& test) { return std::string(test.param.name); });

// Images are read by folder and by pattern too.
TEST(OutputFile, IsNoneOfAFolderOrAPatternThatIsRead) {
  const test::TemporaryFolder folder;
  fs::create_directory(folder / "ct");
  const std::string dicom = std::string(128, '\0') + "DICM";
  for (const char* image : {"ct/1.dcm", "f_0001.png"}) test::write_file(folder / image, dicom);
  const auto compared =
      run_program({"compare", folder / "Knee.arthro", "--postop", folder / "ct", "-o", folder / "ct/1.dcm"});
  EXPECT_THAT(compared.errors, HasSubstr("is what is read"));
  const auto tracked = run_program(
      {"track", "--camera", "c", "--tools", "t", folder / "f_%04d.png", "-o", folder / "f_0001.png"});
  EXPECT_THAT(tracked.errors, HasSubstr("is what is read"));
  for (const char* image : {"ct/1.dcm", "f_0001.png"}) EXPECT_EQ(files::read_text(folder / image), dicom);
}

// A case of the built-in knee: by -o, its plan is lost to no report; the export of another case's plan no
// less.
TEST(OutputFile, OfACaseIsNotLostToAReportOrAnExport) {
  const test::TemporaryFolder folder;
  for (const char* name : {"A.arthro", "B.arthro"})
    ASSERT_EQ(run_program({"phantom", "-o", folder / name}).exit_code, 0);
  const std::string plan = files::read_text(folder / "A.arthro/plan.json");
  const auto report = run_program({"report", folder / "A.arthro", "-o", folder / "A.arthro/plan.json"});
  EXPECT_EQ(report.exit_code, 3);
  EXPECT_THAT(report.errors, HasSubstr("own files"));
  const auto exported = run_program({"plan", folder / "B.arthro", "--export", folder / "A.arthro"});
  EXPECT_EQ(exported.exit_code, 3);
  EXPECT_THAT(exported.errors, HasSubstr("A.arthro: is a case's own folder"));
  EXPECT_EQ(files::read_text(folder / "A.arthro/plan.json"), plan);
  EXPECT_EQ(run_program({"report", folder / "A.arthro", "-o", folder / "A.arthro/report.json"}).exit_code, 0);
}

// A PDF of markers through a pipe, which is a pipe afterwards.
TEST(OutputFile, APdfGoesIntoAPipe) {
  const test::TemporaryFolder folder;
  ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
  const int reader = ::open((folder / "pipe").c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC);
  ASSERT_GT(::fcntl(reader, F_SETPIPE_SZ, 1 << 20), 0);  // all of it, since nobody reads meanwhile
  EXPECT_EQ(run_program({"markers", "-o", folder / "pipe"}).exit_code, 0);
  EXPECT_TRUE(fs::is_fifo(folder / "pipe"));
  std::array<char, 6> begin{};
  EXPECT_EQ(::read(reader, begin.data(), 5), 5);
  EXPECT_STREQ(begin.data(), "%PDF-");
  ::close(reader);
}

// "-" is standard output where the format is text; elsewhere no file of that name is made.
TEST(OutputFile, StandardOutputIsForText) {
  const test::TemporaryFolder folder;
  const fs::path here = fs::current_path();
  fs::current_path(folder.path());
  for (const std::vector<std::string>& arguments : {std::vector<std::string>{"markers", "-o", "-"},
                                                    {"report", "Knee.arthro", "-o", "-"},
                                                    {"phantom", "-o", "-"},
                                                    {"demo", "-o", "-"},
                                                    {"dicom", "Knee.arthro", "-o", "-"},
                                                    {"import", "femur.stl", "--side", "left", "-o", "-"}}) {
    const auto result = run_program(arguments);
    EXPECT_EQ(result.exit_code, 2) << arguments[0];
    EXPECT_THAT(result.errors, HasSubstr("is no text")) << arguments[0];
  }
  fs::current_path(here);
  EXPECT_THAT(folder.names(), ::testing::IsEmpty());
}

TEST(OutputFile, OfAReportHasAnEndingThatSaysWhatItIs) {
  const auto result = run_program({"report", "Knee.arthro", "-o", "report.docx"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.errors, HasSubstr(".pdf, .json and .csv"));
}

// demo, phantom and dicom alike: a folder that is absent or empty.
TEST(OutputFolder, IsAbsentOrEmpty) {
  const test::TemporaryFolder folder;
  test::write_file(folder / "mine", "x");
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"demo"}, {"phantom"}, {"dicom", folder / "none.arthro"}}) {
    std::vector<std::string> into = arguments;
    into.insert(into.end(), {"-o", folder.path()});
    const auto result = run_program(into);
    EXPECT_EQ(result.exit_code, 3) << arguments[0];
    EXPECT_THAT(result.errors, HasSubstr("exists and is not empty: nothing was written")) << arguments[0];
  }
  fs::create_directory(folder / "Knee.arthro");
  EXPECT_EQ(run_program({"phantom", "-o", folder / "Knee.arthro"}).exit_code, 0);
}

// A folder that is left half would refuse the next try of that name.
TEST(OutputFolder, OfADemoThatIsInterruptedIsGone) {
  const test::TemporaryFolder folder;
  const fs::path knee = folder / "demo.arthro";
  const auto result =
      run_program({"demo", "-o", knee}, {.interrupts_when = [&] { return fs::exists(knee / "pictures"); }});
  EXPECT_EQ(result.exit_code, 128 + SIGINT) << result.errors;
  EXPECT_THAT(folder.names(), ::testing::IsEmpty());
}

// A demo whose video the disk does not take says so of each record, and goes on.
TEST(OutputFolder, OfADemoSaysThatItsVideoCouldNotBeKept) {
  const test::TemporaryFolder folder;
  const fs::path knee = folder / "demo.arthro";
  const auto result = run_program(
      {"demo", "-o", knee}, {.file_size_bytes = 20'000'000,
                             .interrupts_when = [&] { return fs::exists(knee / "pictures/scratch.png"); }});
  EXPECT_THAT(result.errors, HasSubstr("the record of \"scratch\" is not reliable"));
  EXPECT_THAT(result.errors, HasSubstr("the video is not kept to its end: video.mkv: cannot write"));
}

// What was asked for on standard output and did not get there is an error, as in a file.
TEST(OutputFile, AFullDiskBehindStandardOutputIsTold) {
  const test::TemporaryFolder folder;
  const std::string knee = folder / "Knee.arthro";
  ASSERT_EQ(run_program({"phantom", "-o", knee}).exit_code, 0);
  for (const std::vector<std::string>& arguments : {std::vector<std::string>{"landmarks", knee, "--json"},
                                                    {"plan", knee, "--json"},
                                                    {"plan", knee},
                                                    {"cases", "--add", knee},
                                                    {"plan", "--help"},
                                                    {"--version"}}) {
    const auto result = run_program(arguments, {.output = "/dev/full"});
    EXPECT_EQ(result.exit_code, 3) << testing::PrintToString(arguments);
    EXPECT_THAT(result.errors, HasSubstr("standard output: cannot write"))
        << testing::PrintToString(arguments);
  }
  // Nothing is lost where nothing is said.
  EXPECT_EQ(run_program({"phantom", "--quiet", "-o", folder / "b.arthro"}, {.output = "/dev/full"}).exit_code,
            0);
}

}  // namespace
}  // namespace arthronaut
