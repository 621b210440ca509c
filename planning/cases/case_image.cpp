#include "planning/cases/case_image.h"

#include "planning/files/private_folder.h"
#include "planning/geometry/error.h"
#include "planning/images/volume_file.h"

namespace arthronaut::cases {

namespace fs = std::filesystem;

images::Volume load_image(const fs::path& case_folder, const CaseImage& image,
                          const std::function<void(double)>& on_progress) {
  const fs::path file = case_folder / image.file;
  if (!fs::exists(file)) throw IoError(file, "is not there: the case has lost its images");
  images::VolumeFileOptions options;
  options.on_progress = on_progress;
  images::Volume volume = images::read_volume(file, options);
  if (volume.size != image.size)
    throw InvalidInput(file, "sizes", "are not what case.json says: it is another volume");
  volume.format = image.source;
  return volume;
}

void store_image(const fs::path& case_folder, int number, const images::EncodedVolume& volume,
                 CaseImage& image) {
  image.file = "images/" + std::to_string(number) + ".nrrd";
  files::create_private_folder(case_folder / "images");
  images::write_volume(case_folder / image.file, volume);
}

}  // namespace arthronaut::cases
