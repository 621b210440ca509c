#include "app/scene/image.h"

#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPNGWriter.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>
#include <string_view>

#include "planning/files/atomic_file.h"

namespace arthronaut::scene {

void write_png(const std::filesystem::path& file, const Image& image) {
  vtkNew<vtkImageData> data;
  data->SetDimensions(image.width, image.height, 1);
  data->AllocateScalars(VTK_UNSIGNED_CHAR, 3);
  const std::size_t stride = 3 * static_cast<std::size_t>(image.width);
  for (int y = 0; y < image.height; ++y) {  // VTK counts rows from the bottom
    const auto row = image.rgb.begin() + static_cast<std::ptrdiff_t>(stride * static_cast<std::size_t>(y));
    std::copy_n(row, stride, static_cast<unsigned char*>(data->GetScalarPointer(0, image.height - 1 - y, 0)));
  }
  vtkNew<vtkPNGWriter> writer;
  writer->SetInputData(data);
  writer->WriteToMemoryOn();
  writer->Write();
  vtkUnsignedCharArray* bytes = writer->GetResult();
  files::write_atomically(file, std::string_view(reinterpret_cast<const char*>(bytes->GetPointer(0)),
                                                 static_cast<std::size_t>(bytes->GetNumberOfValues())));
}

}  // namespace arthronaut::scene
