#include "navigation/sources/libav.h"

namespace arthronaut::sources {

std::string libav_message(int error) {
  char text[AV_ERROR_MAX_STRING_SIZE] = {};
  av_strerror(error, text, sizeof text);
  return text;
}

bool BgrConverter::convert(const AVFrame& picture, camera::Frame& frame) {
  frame.width = picture.width;
  frame.height = picture.height;
  converter_.reset(sws_getCachedContext(converter_.release(), frame.width, frame.height,
                                        static_cast<AVPixelFormat>(picture.format), frame.width, frame.height,
                                        AV_PIX_FMT_BGR24, SWS_BICUBIC, nullptr, nullptr, nullptr));
  if (!converter_) return false;
  if (is_full_range_) {
    const int* const bt601 = sws_getCoefficients(SWS_CS_ITU601);
    constexpr int kFullRange = 1, kUnity = 1 << 16;
    sws_setColorspaceDetails(converter_.get(), bt601, kFullRange, bt601, kFullRange, 0, kUnity, kUnity);
  }
  frame.bgr.resize(static_cast<std::size_t>(3) * static_cast<std::size_t>(frame.width) *
                   static_cast<std::size_t>(frame.height));
  std::uint8_t* const planes[] = {frame.bgr.data()};
  const int strides[] = {3 * frame.width};
  sws_scale(converter_.get(), picture.data, picture.linesize, 0, frame.height, planes, strides);
  return true;
}

}  // namespace arthronaut::sources
