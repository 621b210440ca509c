#include "navigation/sources/recording_time.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <fstream>

#include "tests/temporary_folder.h"

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
}

namespace arthronaut::sources {
namespace {

// A video of one packet whose container says when it was made.
void write_container(const std::filesystem::path& file, const char* creation_time) {
  AVFormatContext* container = nullptr;
  ASSERT_GE(avformat_alloc_output_context2(&container, nullptr, "matroska", file.c_str()), 0);
  AVStream* const stream = avformat_new_stream(container, nullptr);
  stream->codecpar->codec_type = AVMEDIA_TYPE_VIDEO;
  stream->codecpar->codec_id = AV_CODEC_ID_MJPEG;
  stream->codecpar->width = stream->codecpar->height = 32;
  av_dict_set(&container->metadata, "creation_time", creation_time, 0);
  ASSERT_GE(avio_open(&container->pb, file.c_str(), AVIO_FLAG_WRITE), 0);
  ASSERT_GE(avformat_write_header(container, nullptr), 0);
  AVPacket* packet = av_packet_alloc();
  ASSERT_GE(av_new_packet(packet, 4), 0);
  std::fill_n(packet->data, 4, std::uint8_t{0});
  packet->pts = packet->dts = 0;
  packet->flags = AV_PKT_FLAG_KEY;
  ASSERT_GE(av_write_frame(container, packet), 0);
  av_packet_free(&packet);
  ASSERT_GE(av_write_trailer(container), 0);
  avio_closep(&container->pb);
  avformat_free_context(container);
}

// The file was written just now, by this test: only what the container says is of another year.
TEST(RecordingTime, IsTheContainersWhereItIsEarlier) {
  const test::TemporaryFolder folder;
  const auto file = folder / "clip.mkv";
  const std::string far = "2900-01-01T00:00:00Z";
  write_container(file, "2025-10-23T06:15:00.000000Z");
  EXPECT_EQ(recorded_utc(file, far), "2025-10-23T06:15:00Z");
  // A container cannot be younger than its file.
  write_container(file, "2199-10-23T06:15:00Z");
  const auto of_file = recorded_utc(file, far);
  ASSERT_TRUE(of_file);
  EXPECT_LT(*of_file, "2199");
  // A clock that was never set says nothing.
  write_container(file, "1970-01-01T00:00:00Z");
  ASSERT_TRUE(recorded_utc(file, far));
  EXPECT_GT(*recorded_utc(file, far), "2000");
}

TEST(RecordingTime, IsTheFilesElseAndUnknownWhereItCannotBe) {
  const test::TemporaryFolder folder;
  const auto file = folder / "no_video.mkv";
  std::ofstream(file) << "nothing that a container would say";
  const auto written = recorded_utc(file, "2900-01-01T00:00:00Z");
  ASSERT_TRUE(written);
  EXPECT_EQ(written->size(), 20u);
  EXPECT_FALSE(recorded_utc(file, "2001-01-01T00:00:00Z"));  // written after now
  EXPECT_FALSE(recorded_utc(folder / "none.mkv", "2900-01-01T00:00:00Z"));
}

}  // namespace
}  // namespace arthronaut::sources
