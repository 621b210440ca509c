#include "navigation/recording/kept_pictures.h"

#include <algorithm>
#include <utility>

namespace arthronaut::recording {

namespace {

// A part that was kept as it came.
class StreamPart final : public sources::FrameSource {
 public:
  explicit StreamPart(const sources::KeptStreamFile& file)
      : stream_(file, sources::KeptStream::Use::ToReplay) {}
  const sources::SourceInfo& info() const override { return stream_.info(); }
  camera::FramePtr next() override { return stream_.next(); }

 private:
  sources::KeptStream stream_;
};

// A part that was encoded: its pictures lie in their order.
class EncodedPart final : public sources::FrameSource {
 public:
  explicit EncodedPart(std::unique_ptr<sources::FrameSource> video) : video_(std::move(video)) {}
  const sources::SourceInfo& info() const override { return video_->info(); }
  camera::FramePtr next() override {
    const camera::FramePtr picture = video_->next();
    if (picture == nullptr) return nullptr;
    auto frame = std::make_shared<camera::Frame>(*picture);
    frame->packet = static_cast<std::int32_t>(picture->index);
    return frame;
  }

 private:
  std::unique_ptr<sources::FrameSource> video_;
};

}  // namespace

std::vector<KeptPicture> read_kept_pictures(SessionDatabase& database) {
  std::vector<KeptPicture> pictures;
  Statement row = database.prepare("SELECT * FROM pictures ORDER BY picture");
  // Records of before hold the frame alone: every picture is one that decoding may begin at.
  const bool is_of_before = row.column_count() < 6;
  while (row.step()) {
    const auto number = static_cast<std::int64_t>(pictures.size());
    KeptPicture picture{row.integer(1), number, number, 0};
    if (!is_of_before) {
      picture.packet = row.integer(2);
      picture.start_packet = row.integer(3);
      picture.start_ms = row.integer(4);
      if (!row.is_null(5)) picture.luma = static_cast<std::uint64_t>(row.integer(5));
    }
    pictures.push_back(picture);
  }
  return pictures;
}

std::vector<VideoPart> parts_of(const SessionHeader& header) {
  if (!header.video_parts.empty() || !header.video_is_reencoded) return header.video_parts;
  return {{header.video, 0, header.video_has_exact_luma ? PicturesAs::Lossless : PicturesAs::H264}};
}

std::span<const KeptPicture> pictures_of(const std::vector<VideoPart>& parts, std::size_t part,
                                         std::span<const KeptPicture> pictures) {
  const auto place_of = [&](std::size_t of) {
    return of < parts.size() ? std::min(static_cast<std::size_t>(parts[of].first_picture), pictures.size())
                             : pictures.size();
  };
  return pictures.subspan(place_of(part), place_of(part + 1) - place_of(part));
}

sources::KeptStreamFile kept_stream_file(const std::filesystem::path& session_folder,
                                         const std::vector<VideoPart>& parts, std::size_t part,
                                         const std::vector<KeptPicture>& pictures) {
  sources::KeptStreamFile file{session_folder / parts[part].file, parts[part].held_back, {}};
  for (const KeptPicture& picture : pictures_of(parts, part, pictures)) {
    if (file.starts.empty() || picture.start_packet > file.starts.back().packet)
      file.starts.push_back({picture.start_packet, picture.start_ms});
  }
  return file;
}

std::unique_ptr<sources::FrameSource> open_part(const std::filesystem::path& session_folder,
                                                const std::vector<VideoPart>& parts, std::size_t part) {
  if (parts[part].as == PicturesAs::AsTheyCame)
    return std::make_unique<StreamPart>(kept_stream_file(session_folder, parts, part, {}));
  const std::filesystem::path file = session_folder / parts[part].file;
  return std::make_unique<EncodedPart>(parts[part].as == PicturesAs::Lossless
                                           ? sources::open_video_with_exact_luma(file)
                                           : sources::open_video(file));
}

}  // namespace arthronaut::recording
