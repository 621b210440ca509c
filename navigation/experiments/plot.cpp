#include "navigation/experiments/plot.h"

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "planning/files/atomic_file.h"
#include "planning/geometry/error.h"

namespace arthronaut::experiments {

void write_text(cv::Mat& plot, const std::string& text, cv::Point at, double size, const cv::Scalar& color) {
  cv::putText(plot, text, at, cv::FONT_HERSHEY_SIMPLEX, size, color, 1, cv::LINE_AA);
}

void write_plot(const std::filesystem::path& file, const cv::Mat& plot) {
  files::write_atomically(file, [&](const std::filesystem::path& temporary) {
    if (!cv::imwrite(temporary.string(), plot)) throw IoError(file, "the picture could not be written");
  });
}

}  // namespace arthronaut::experiments
