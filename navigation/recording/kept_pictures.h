// Inner header: the pictures of a session's video, one after the other or any of them, whatever files they
// lie in and however they were kept.
#pragma once

#include <filesystem>
#include <memory>
#include <span>
#include <vector>

#include "navigation/recording/session.h"
#include "navigation/recording/session_database.h"
#include "navigation/sources/kept_stream.h"

namespace arthronaut::recording {

// Of the record, in order. Throws IoError.
[[nodiscard]] std::vector<KeptPicture> read_kept_pictures(SessionDatabase& database);

// The parts of a video that append_picture() wrote, also one of an older version, which does not name its
// one.
[[nodiscard]] std::vector<VideoPart> parts_of(const SessionHeader& header);
// Those of one part that are there.
[[nodiscard]] std::span<const KeptPicture> pictures_of(const std::vector<VideoPart>& parts, std::size_t part,
                                                       std::span<const KeptPicture> pictures);
// Where decoding may begin in a part that was kept as it came.
[[nodiscard]] sources::KeptStreamFile kept_stream_file(const std::filesystem::path& session_folder,
                                                       const std::vector<VideoPart>& parts, std::size_t part,
                                                       const std::vector<KeptPicture>& pictures);

// Pictures of one part as a decoder gives them out; Frame::packet is KeptPicture::packet.
[[nodiscard]] std::unique_ptr<sources::FrameSource> open_part(const std::filesystem::path& session_folder,
                                                              const std::vector<VideoPart>& parts,
                                                              std::size_t part);

}  // namespace arthronaut::recording
