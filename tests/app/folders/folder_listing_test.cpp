#include "app/folders/folder_listing.h"

#include <gtest/gtest.h>

#include <fstream>

#include "tests/temporary_folder.h"

namespace arthronaut::folders {
namespace {

using Kind = FolderEntry::Kind;

// Cases before folders before files, by name whatever their case; what is neither is counted, what is hidden
// is not there.
TEST(FolderListing, SortsCasesFoldersAndFiles) {
  const test::TemporaryFolder folder;
  for (const char* name : {"b", "A", ".hidden", "Knee.arthro"})
    std::filesystem::create_directory(folder / name);
  for (const char* name :
       {"Knee.arthro/case.json", "femur.STL", "ct.nii.gz", "IM0001", "notes.txt", "DICOMDIR"})
    std::ofstream(folder / name) << "x";
  const FolderListing listing = list_folder(folder.path());
  ASSERT_EQ(listing.entries.size(), 6U);
  const auto is = [&](std::size_t i, const std::string& name, Kind kind) {
    EXPECT_EQ(listing.entries[i].name, name);
    EXPECT_EQ(listing.entries[i].kind, kind) << name;
  };
  is(0, "Knee.arthro", Kind::Case);
  is(1, "A", Kind::Folder);
  is(2, "b", Kind::Folder);
  is(3, "ct.nii.gz", Kind::Image);
  is(4, "DICOMDIR", Kind::Image);
  is(5, "femur.STL", Kind::Mesh);
  EXPECT_EQ(listing.other_files, 2U);
  EXPECT_EQ(listing.failure, "");
}

// 3D Slicer's markups can be chosen; any other JSON is none of ours.
TEST(FolderListing, ListsMarkups) {
  const test::TemporaryFolder folder;
  for (const char* name : {"plan.mrk.json", "plan.json"}) std::ofstream(folder / name) << "{}";
  const FolderListing listing = list_folder(folder.path());
  ASSERT_EQ(listing.entries.size(), 1U);
  EXPECT_EQ(listing.entries[0].name, "plan.mrk.json");
  EXPECT_EQ(listing.entries[0].kind, Kind::Markups);
  EXPECT_EQ(listing.other_files, 1U);
}

// A folder that is not there, or a file, is said; nothing is thrown. A path that ends in a stroke is the
// folder.
TEST(FolderListing, SaysWhatItCannotList) {
  const test::TemporaryFolder folder;
  EXPECT_NE(list_folder(folder / "absent").failure, "");
  EXPECT_EQ(list_folder(folder.path().string() + "/").folder, folder.path());
  EXPECT_EQ(list_folder("/").folder, "/");
}

}  // namespace
}  // namespace arthronaut::folders
