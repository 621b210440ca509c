// The pixels of one DICOM file: stored plainly or by RLE, JPEG, JPEG-LS (all three by DCMTK) or JPEG 2000 (by
// GDCM). Inner header of images.
#pragma once

#include <filesystem>
#include <memory>
#include <vector>

class DcmDataset;

namespace arthronaut::images {

struct DicomFrame {
  int number = 0;  // within its file, from 0
  int columns = 0, rows = 0;
  double slope = 1, intercept = 0;  // of the rescaling
};

// Keeps of a data set what describes the pixels, and where they lie in the file; lets the rest go.
class DicomPixels {
 public:
  DicomPixels(std::filesystem::path file, std::shared_ptr<DcmDataset> dataset);

  // Rescaled pixels, columns * rows of them. Throws InvalidInput: pixels missing or cut off, colours, a
  // compression that cannot be decoded. `values` is then as it was.
  void append_frame(const DicomFrame& frame, std::vector<float>& values) const;

 private:
  std::filesystem::path file_;
  std::shared_ptr<DcmDataset> dataset_;
};

}  // namespace arthronaut::images
