// Inner header: what the experiments' plots are drawn with.
#pragma once

#include <filesystem>
#include <opencv2/core.hpp>
#include <string>

namespace arthronaut::experiments {

inline const cv::Scalar kInk(40, 40, 40), kGrid(222, 222, 222);

void write_text(cv::Mat& plot, const std::string& text, cv::Point at, double size,
                const cv::Scalar& color = kInk);
// PNG, replaced in one step. Throws IoError.
void write_plot(const std::filesystem::path& file, const cv::Mat& plot);

}  // namespace arthronaut::experiments
