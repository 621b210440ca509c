// Hazard 19: a case is its owner's alone, and names nobody but in identity.json.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <fstream>

#include "planning/cases/case.h"
#include "planning/cases/case_lock.h"
#include "planning/cases/identity.h"
#include "planning/files/atomic_file.h"
#include "planning/geometry/error.h"
#include "tests/message_of.h"
#include "tests/planning/geometry/shapes.h"
#include "tests/temporary_folder.h"

namespace arthronaut::cases {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

fs::perms rights_of(const fs::path& entry) {
  return fs::symlink_status(entry).permissions() & fs::perms::mask;
}

// What anybody but the owner may do something with, folder and contents.
std::vector<std::string> open_to_others(const fs::path& folder) {
  std::vector<std::string> open;
  const auto look = [&](const fs::path& entry) {
    if (fs::is_symlink(entry)) return;
    const auto wanted = fs::is_directory(entry) ? fs::perms{0700} : fs::perms{0600};
    if (rights_of(entry) != wanted) open.push_back(entry.string());
  };
  look(folder);
  for (const auto& entry : fs::recursive_directory_iterator(folder)) look(entry.path());
  return open;
}

class Privacy : public ::testing::Test {
 protected:
  // The most careless habit: whatever is private is so by the program's doing.
  void SetUp() override { umask_ = ::umask(0); }
  void TearDown() override { ::umask(umask_); }
  static Case example() {
    return {.name = "Knee 2026-11-22",
            .created_utc = "",
            .bones = {{bones::BoneKind::Femur, {.mesh = test::box({40, 30, 50}), .source = "binary STL"}}},
            .landmarks = {},
            .plan = {.tunnels = {{bones::BoneKind::Femur, {.entry_mm = {40, 0, 0}, .diameter_mm = 9}}}}};
  }

  mode_t umask_ = 0;
  test::TemporaryFolder temporary_;
  fs::path folder_ = temporary_ / "Knee.arthro";
};

TEST_F(Privacy, Hazard19WhatIsWrittenIntoACaseIsItsOwnersAlone) {
  const CaseLock lock = [&] {
    save_case(folder_, example());
    return CaseLock(folder_);
  }();
  save_plan(folder_, example().plan);
  save_cartilage(folder_, bones::BoneKind::Femur, test::box({8, 3, 5}));
  save_identity(folder_, {"Muster^Anna", "4711", "19900131"});
  const auto session = create_session_folder(folder_);
  files::write_atomically(session / "session.json", std::string_view("{}"));
  // A writer of its own, as of a video.
  files::write_atomically(session / "video.mkv",
                          [](const fs::path& temporary) { std::ofstream(temporary) << "pictures"; });
  EXPECT_THAT(open_to_others(folder_), IsEmpty());
}

// Cases of older versions, and what libraries wrote (databases), are mended when the case is opened and when
// it is let go. Files that links lead to are not the case's.
TEST_F(Privacy, Hazard19AnOpenCaseIsMended) {
  save_case(folder_, example());
  fs::create_directories(folder_ / "sessions" / "20260131-120000");
  std::ofstream(folder_ / "sessions" / "20260131-120000" / "session.sqlite") << "frames";
  fs::permissions(folder_, fs::perms{0755});
  std::ofstream(temporary_ / "elsewhere") << "not the case's";
  fs::create_symlink(temporary_ / "elsewhere", folder_ / "link");
  {
    const CaseLock lock(folder_);
    EXPECT_THAT(open_to_others(folder_), IsEmpty());
    std::ofstream(folder_ / "sessions" / "written_meanwhile") << "by a library";
  }
  EXPECT_THAT(open_to_others(folder_), IsEmpty());
  EXPECT_EQ(rights_of(temporary_ / "elsewhere"), fs::perms{0666});
}

// A folder that is opened by a slip and is no case keeps its rights.
TEST_F(Privacy, LeavesFoldersThatAreNoCaseAlone) {
  fs::create_directory(temporary_ / "home");
  { const CaseLock lock(temporary_ / "home"); }
  EXPECT_EQ(rights_of(temporary_ / "home"), fs::perms{0777});
}

TEST_F(Privacy, Hazard19IdentityStandsInItsOwnFileAlone) {
  save_case(folder_, example());
  EXPECT_FALSE(load_identity(folder_).has_value());
  const Identity anna{"Muster^Anna", "4711", "19900131"};
  save_identity(folder_, anna);
  save_case(folder_, load_case(folder_));
  EXPECT_EQ(load_identity(folder_), anna);
  for (const auto& entry : fs::directory_iterator(folder_)) {
    if (entry.path() == identity_file(folder_)) continue;
    const std::string text = files::read_text(entry.path());
    for (const char* word : {"Muster", "4711", "19900131"})
      EXPECT_EQ(text.find(word), std::string::npos) << entry.path();
  }
  save_identity(folder_, {});
  EXPECT_FALSE(fs::exists(identity_file(folder_)));
}

// A date that took the place of the patient's own is not shown as it.
TEST_F(Privacy, NobodyWasBornInTheYearOne) {
  EXPECT_EQ((Identity{"", "4711", "19900131"}.birth_date_in_words()), "1990-01-31");
  EXPECT_EQ((Identity{"", "4711", "00010101"}.birth_date_in_words()), "");
  EXPECT_EQ((Identity{"", "4711", "00010101"}.in_words()), "4711");
  EXPECT_EQ(date_in_words("20260131"), "2026-01-31");
  EXPECT_EQ(date_in_words("2026-013"), "2026-013");
  EXPECT_EQ(date_in_words("00010101"), "") << "nobody was imaged then";
}

TEST_F(Privacy, Hazard19IdentityIsPrivateEvenInAnOpenFolder) {
  fs::create_directory(folder_);
  save_identity(folder_, {"Muster^Anna", "", ""});
  EXPECT_EQ(rights_of(identity_file(folder_)), fs::perms{0600});
}

TEST_F(Privacy, IdentityIsReadableByPeople) {
  EXPECT_EQ((Identity{"Muster^Anna^^Dr.", "4711", "19900131"}.in_words()),
            "Muster, Anna, Dr. · 4711 · 1990-01-31");
  EXPECT_EQ((Identity{"Yamada^Tarou=山田^太郎", "", "1990"}.in_words()), "Yamada, Tarou · 1990");
  EXPECT_EQ(Identity{}.in_words(), "");
}

TEST_F(Privacy, ABrokenIdentityIsSaid) {
  save_case(folder_, example());
  files::write_atomically(identity_file(folder_), std::string_view("{\"format\": \"arthronaut.identity\"}"));
  EXPECT_THAT(test::message_of<InvalidInput>([&] { (void)load_identity(folder_); }),
              HasSubstr("identity.json"));
}

}  // namespace
}  // namespace arthronaut::cases
