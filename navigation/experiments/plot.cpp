#include "navigation/experiments/plot.h"

#include <opencv2/imgproc.hpp>

#include "navigation/sources/picture.h"

namespace arthronaut::experiments {

void write_text(cv::Mat& plot, const std::string& text, cv::Point at, double size, const cv::Scalar& color) {
  cv::putText(plot, text, at, cv::FONT_HERSHEY_SIMPLEX, size, color, 1, cv::LINE_AA);
}

void write_plot(const std::filesystem::path& file, const cv::Mat& plot) {
  camera::Frame picture;
  picture.width = plot.cols;
  picture.height = plot.rows;
  picture.bgr.assign(plot.datastart, plot.dataend);
  sources::write_png(file, picture);
}

}  // namespace arthronaut::experiments
