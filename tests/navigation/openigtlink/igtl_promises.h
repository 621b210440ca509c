// What the reader of OpenIGTLink promises of any bytes whatever, for its tests and for the fuzzer.
#pragma once

#include <algorithm>
#include <cmath>
#include <iterator>
#include <sstream>

#include "navigation/openigtlink/igtl_reader.h"
#include "tests/navigation/openigtlink/tracker_peer.h"

namespace arthronaut::test {

// Everything that was told, in order, to the last bit.
struct Told : openigtlink::MessageListener {
  void pose(std::string_view device, const std::optional<geometry::RigidTransform>& target_from_source,
            double stamp_utc_s) override {
    tell(device);
    words << stamp_utc_s;
    if (target_from_source) {
      const Eigen::Quaterniond& q = target_from_source->rotation;
      const Eigen::Vector3d& t = target_from_source->translation_mm;
      if (!t.allFinite() || !(std::abs(q.norm() - 1) < 1e-9)) broken = "a pose that is none";
      words << ' ' << q.coeffs().transpose() << ' ' << t.transpose();
      ++pose_count;
    }
    if (!(stamp_utc_s >= 0)) broken = "a stamp that is no time";
    words << '\n';
  }
  void status(std::string_view device, bool is_ok, std::string_view text) override {
    tell(device);
    tell(text);
    words << is_ok << '\n';
  }
  void refused(const std::string& why) override {
    if (why.empty()) broken = "refused without a word";
    tell(why);
    words << '\n';
  }
  void tell(std::string_view text) {
    if (std::any_of(text.begin(), text.end(), [](char c) { return c < 0x20 || c > 0x7E; }))
      broken = "words that can't be shown";
    words << text << ' ';
  }

  std::ostringstream words{std::ios::out};
  std::string broken;
  long pose_count = 0;
};

// The messages of a stream, each with the checksum of what its header says that it holds: a stream that was
// spoilt is seldom read farther than to the checksum.
inline void seal_all(Bytes& stream) {
  constexpr std::size_t kHeader = openigtlink::IgtlReader::kHeaderSize;
  for (std::size_t at = 0; stream.size() - at >= kHeader;) {
    std::uint64_t length = 0;
    for (std::size_t i = 0; i < 8; ++i) length = length << 8 | stream[at + 42 + i];
    if (length > stream.size() - at - kHeader) return;
    std::uint64_t checksum = crc64(stream.data() + at + kHeader, length, 0);
    for (std::size_t i = 8; i-- > 0; checksum >>= 8)
      stream[at + 50 + i] = static_cast<std::uint8_t>(checksum);
    at += kHeader + length;
  }
}

// What is told of a stream that comes in pieces of this size.
inline void read_in_pieces(std::span<const std::uint8_t> stream, std::size_t piece, Told& told) {
  told.words.precision(17);
  openigtlink::IgtlReader reader(told);
  while (!stream.empty()) {
    const std::size_t size = std::min(piece, stream.size());
    if (!reader.take(stream.first(size))) {
      told.words << "no more\n";
      return;
    }
    stream = stream.subspan(size);
  }
  told.words << (reader.is_within_message() ? "within" : "between");
}

// Empty where all holds: poses are rigid, words can be shown, and it does not matter in which pieces a stream
// comes. Counts poses in `pose_count`, where it is asked for.
inline std::string broken_promise(std::span<const std::uint8_t> stream, long* pose_count = nullptr) {
  Told whole;
  read_in_pieces(stream, std::max(stream.size(), std::size_t{1}), whole);
  if (pose_count != nullptr) *pose_count += whole.pose_count;
  if (!whole.broken.empty()) return whole.broken;
  for (const std::size_t piece : {std::size_t{1}, std::size_t{61}}) {
    Told told;
    read_in_pieces(stream, piece, told);
    if (told.words.str() != whole.words.str()) return "another reading in pieces: " + told.words.str();
  }
  return "";
}

// One message of each kind that is read, by name.
inline std::vector<std::pair<std::string, Bytes>> igtl_examples() {
  const geometry::RigidTransform pose{
      Eigen::Quaterniond(Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, -2, 0.5).normalized())), {12.5, -80, 33}};
  std::vector<std::pair<std::string, Bytes>> examples{
      {"transform", transform_message("Probe", pose, 1.8e9)},
      {"version_2", transform_message("Probe", pose, 1.8e9, 2)},
      {"matrices", matrix_message("Guide", pose, 1.8e9)},
      {"quaternions", quaternion_message("Drill", pose, 1.8e9)},
      {"status", status_message("Probe", false, "out of volume")}};
  Bytes all;
  for (const auto& [name, message] : examples) all.insert(all.end(), message.begin(), message.end());
  examples.emplace_back("all", std::move(all));
  return examples;
}

}  // namespace arthronaut::test
