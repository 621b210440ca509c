#include "navigation/sources/source_files.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <string>

namespace arthronaut::sources {
namespace {

std::string lower_extension(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

template <class Test>
std::vector<std::filesystem::path> files_in(const std::filesystem::path& folder, const Test& is_wanted) {
  std::vector<std::filesystem::path> files;
  std::error_code ignored;  // a folder that can't be read has nothing to offer
  for (const auto& entry : std::filesystem::directory_iterator(folder, ignored)) {
    if (is_wanted(entry.path()) && entry.is_regular_file(ignored)) files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace

bool looks_like_picture(const std::filesystem::path& file) {
  static constexpr std::array kPictures{".png",  ".jpg", ".jpeg", ".bmp", ".tif",
                                        ".tiff", ".ppm", ".pgm",  ".webp"};
  return std::find(kPictures.begin(), kPictures.end(), lower_extension(file)) != kPictures.end();
}

bool looks_like_video(const std::filesystem::path& file) {
  static constexpr std::array kVideos{".mp4", ".mkv", ".avi", ".mov"};
  return std::find(kVideos.begin(), kVideos.end(), lower_extension(file)) != kVideos.end();
}

std::vector<std::filesystem::path> pictures_in(const std::filesystem::path& folder) {
  return files_in(folder, looks_like_picture);
}

std::vector<std::filesystem::path> videos_in(const std::filesystem::path& folder) {
  return files_in(folder, looks_like_video);
}

}  // namespace arthronaut::sources
