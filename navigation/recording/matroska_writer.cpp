#include "navigation/recording/matroska_writer.h"

#include <utility>

#include "planning/files/private_folder.h"
#include "planning/geometry/error.h"

extern "C" {
#include <libavutil/log.h>
}

namespace arthronaut::recording {

namespace {

// A cluster, the unit that reaches the disk, is no longer than this.
constexpr const char* kClusterMs = "250";

}  // namespace

MatroskaWriter::MatroskaWriter(const std::filesystem::path& file) : file_(file) {
  av_log_set_level(AV_LOG_QUIET);  // what goes wrong is told by exception
  AVFormatContext* created = nullptr;
  check(avformat_alloc_output_context2(&created, nullptr, "matroska", file.c_str()),
        "cannot start the video");
  container_.reset(created);
  stream_ = avformat_new_stream(created, nullptr);
  if (stream_ == nullptr) throw IoError(file_, "cannot start the video");
}

void MatroskaWriter::check(int result, const std::string& what) const {
  if (result < 0) throw IoError(file_, what + ": " + sources::libav_message(result));
}

void MatroskaWriter::begin() {
  files::begin_private_file(file_);
  check(avio_open(&container_->pb, file_.c_str(), AVIO_FLAG_WRITE), "cannot create");
  container_->flags |= AVFMT_FLAG_FLUSH_PACKETS;
  AVDictionary* settings = nullptr;
  av_dict_set(&settings, "cluster_time_limit", kClusterMs, 0);
  const int result = avformat_write_header(container_.get(), &settings);
  av_dict_free(&settings);
  check(result, "cannot write");
  is_begun_ = true;
}

void MatroskaWriter::write(AVPacket& packet, AVRational time_base) {
  av_packet_rescale_ts(&packet, time_base, stream_->time_base);
  packet.stream_index = stream_->index;
  const int written = av_write_frame(container_.get(), &packet);
  av_packet_unref(&packet);
  check(written, "cannot write");
  // The disk's own errors are kept until somebody asks.
  check(container_->pb->error, "cannot write");
}

void MatroskaWriter::end_cluster() { check(av_write_frame(container_.get(), nullptr), "cannot write"); }

void MatroskaWriter::finish() {
  // libavformat lets go of what a trailer is made of also where that failed, and a second one is of what is
  // gone.
  if (!std::exchange(is_begun_, false)) return;
  check(av_write_trailer(container_.get()), "cannot write");
  check(avio_closep(&container_->pb), "cannot write");
}

}  // namespace arthronaut::recording
