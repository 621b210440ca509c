#include "app/navigate/picture_keeping.h"

#include <gtest/gtest.h>

#include <fstream>

#include "tests/temporary_folder.h"

namespace arthronaut::navigate {
namespace {

using recording::PicturesAs;

// What was chosen last is what the next start of the program finds; nothing, or what cannot be read, is the
// default.
TEST(PictureKeeping, IsRemembered) {
  const test::TemporaryFolder folder;
  const auto file = folder / "new" / "pictures.json";
  EXPECT_EQ(load_picture_keeping(file), PicturesAs::AsTheyCame);
  for (const PicturesAs as : {PicturesAs::H264, PicturesAs::Lossless, PicturesAs::AsTheyCame}) {
    save_picture_keeping(file, as);
    EXPECT_EQ(load_picture_keeping(file), as);
  }
  for (const char* const broken :
       {"", "{}", R"({"format": "arthronaut.pictures", "version": 1, "kept": "somehow"})"}) {
    std::ofstream(file) << broken;
    EXPECT_EQ(load_picture_keeping(file), PicturesAs::AsTheyCame) << broken;
  }
}

}  // namespace
}  // namespace arthronaut::navigate
