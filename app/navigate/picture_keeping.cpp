#include "app/navigate/picture_keeping.h"

#include <nlohmann/json.hpp>

#include "app/case/case_opening.h"
#include "planning/files/json_document.h"
#include "planning/files/private_folder.h"

namespace arthronaut::navigate {

namespace {

constexpr std::string_view kPicturesFormat = "arthronaut.pictures";
constexpr int kPicturesVersion = 1;

}  // namespace

std::filesystem::path picture_keeping_file() {
  return open_case::built_in_case_folder().parent_path() / "pictures.json";
}

recording::PicturesAs load_picture_keeping(const std::filesystem::path& file) {
  try {
    if (std::filesystem::exists(file))
      return recording::pictures_as_from_option(
          files::read_json(file, kPicturesFormat, kPicturesVersion).text("kept"));
  } catch (const std::runtime_error&) {  // as the header says
  }
  return recording::PicturesAs::AsTheyCame;
}

void save_picture_keeping(const std::filesystem::path& file, recording::PicturesAs as) {
  files::create_private_folder(file.parent_path());
  files::write_json(
      file, {{"format", kPicturesFormat}, {"version", kPicturesVersion}, {"kept", recording::to_option(as)}});
}

}  // namespace arthronaut::navigate
