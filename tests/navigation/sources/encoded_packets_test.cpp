#include "navigation/sources/encoded_packets.h"

#include <gtest/gtest.h>

#include <cstring>

namespace arthronaut::sources {
namespace {

// A packet of these bytes; av_new_packet puts the zeros behind its end that libavcodec asks for.
LibavPtr<AVPacket> packet_of(const std::vector<std::uint8_t>& bytes) {
  LibavPtr<AVPacket> packet(av_packet_alloc());
  EXPECT_EQ(av_new_packet(packet.get(), static_cast<int>(bytes.size())), 0);
  if (!bytes.empty()) std::memcpy(packet->data, bytes.data(), bytes.size());
  return packet;
}

struct Units {
  std::vector<std::uint8_t> bytes;
  Units& add(std::initializer_list<std::uint8_t> unit) {
    bytes.insert(bytes.end(), {0, 0, 0, 1});
    bytes.insert(bytes.end(), unit);
    return *this;
  }
  [[nodiscard]] bool is_one_picture(AVCodecID codec = AV_CODEC_ID_H264) const {
    return sources::is_one_picture(*packet_of(bytes), codec);
  }
};

// Parameter sets and hints before it, several slices: all of one picture, none of the next.
TEST(OnePicture, IsWhatBeginsOnceAndFirst) {
  EXPECT_TRUE(Units().add({0x65, 0x88, 0x80}).is_one_picture());
  EXPECT_TRUE(Units()
                  .add({0x09, 0xF0})
                  .add({0x67, 1})
                  .add({0x68, 1})
                  .add({0x06, 5})
                  .add({0x65, 0x88})
                  .is_one_picture());
  EXPECT_TRUE(Units().add({0x41, 0x9A}).add({0x41, 0x02}).add({0x41, 0x01}).is_one_picture())
      << "three slices";
  EXPECT_FALSE(Units().add({0x41, 0x9A}).add({0x41, 0x9A}).is_one_picture()) << "two pictures";
  EXPECT_FALSE(Units().add({0x41, 0x02}).is_one_picture()) << "its middle";
  EXPECT_FALSE(Units().add({0x41, 0x02}).add({0x41, 0x9A}).is_one_picture())
      << "the end of one, and the next";
  EXPECT_FALSE(Units().add({0x67, 1}).add({0x68, 1}).is_one_picture()) << "none";
  EXPECT_FALSE(Units().is_one_picture());
}

TEST(OnePicture, OfHevcLikewiseAndOfOthersNobodyKnows) {
  EXPECT_TRUE(Units()
                  .add({0x40, 1, 0xC0})
                  .add({0x26, 1, 0xAF})
                  .add({0x26, 1, 0x20})
                  .is_one_picture(AV_CODEC_ID_HEVC));
  EXPECT_FALSE(Units().add({0x02, 1, 0xD0}).add({0x02, 1, 0xD0}).is_one_picture(AV_CODEC_ID_HEVC));
  EXPECT_FALSE(Units().add({0x02, 1, 0x50}).is_one_picture(AV_CODEC_ID_HEVC));
  EXPECT_FALSE(Units().add({0x00, 0x0F}).is_one_picture(AV_CODEC_ID_MPEG2VIDEO));
}

}  // namespace
}  // namespace arthronaut::sources
