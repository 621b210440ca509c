#include "navigation/openigtlink/igtl_reader.h"

#include <igtl_util.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "navigation/openigtlink/ras_from_lps.h"

namespace arthronaut::openigtlink {

namespace {

using Bytes = std::span<const std::uint8_t>;

constexpr std::size_t kNameSize = 20, kTypeSize = 12;
// Larger than any picture or volume that is sent: what claims more is no header.
constexpr std::uint64_t kLargestBody = std::uint64_t{1} << 32;
constexpr int kNewestVersion = 3;
constexpr std::size_t kExtendedHeaderSize = 12;
constexpr std::uint16_t kStatusOk = 1;
// What PLUS and 3D Slicer say of a tool beside its pose: OK, MISSING, OUT_OF_VOLUME, ...
constexpr std::string_view kToolStatusKey = "TransformStatus", kToolSeen = "OK";
constexpr double kFarthest_mm = 1e5;

std::uint64_t number_at(Bytes bytes, std::size_t at, std::size_t size) {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < size; ++i) value = value << 8 | bytes[at + i];
  return value;
}

double float_at(Bytes bytes, std::size_t at) {
  return std::bit_cast<float>(static_cast<std::uint32_t>(number_at(bytes, at, 4)));
}

// Up to its first zero, without what could not be shown.
std::string text_at(Bytes bytes, std::size_t at, std::size_t size) {
  std::string text;
  for (std::size_t i = 0; i < size && bytes[at + i] != 0; ++i)
    text += bytes[at + i] >= 0x20 && bytes[at + i] < 0x7F ? static_cast<char>(bytes[at + i]) : '?';
  return text;
}

std::optional<geometry::RigidTransform> in_lps(const Eigen::Quaterniond& rotation,
                                               const Eigen::Vector3d& translation_mm) {
  if (!translation_mm.allFinite() || translation_mm.norm() > kFarthest_mm) return std::nullopt;
  return ras_from_lps({rotation.normalized(), translation_mm});
}

// Three columns of a rotation and a translation, twelve floats.
std::optional<geometry::RigidTransform> matrix_at(Bytes bytes, std::size_t at) {
  constexpr double kTolerance = 1e-3;
  Eigen::Matrix3d rotation;
  Eigen::Vector3d translation_mm;
  for (int i = 0; i < 9; ++i) rotation(i % 3, i / 3) = float_at(bytes, at + 4 * static_cast<std::size_t>(i));
  for (int i = 0; i < 3; ++i) translation_mm[i] = float_at(bytes, at + 36 + 4 * static_cast<std::size_t>(i));
  if (!rotation.allFinite()) return std::nullopt;
  const Eigen::Matrix3d unit = rotation.transpose() * rotation - Eigen::Matrix3d::Identity();
  if (unit.cwiseAbs().maxCoeff() > kTolerance || rotation.determinant() < 0) return std::nullopt;
  return in_lps(Eigen::Quaterniond(rotation), translation_mm);
}

// A position and a quaternion x, y, z, w: seven floats.
std::optional<geometry::RigidTransform> quaternion_at(Bytes bytes, std::size_t at) {
  constexpr double kTolerance = 1e-3;
  double v[7];
  for (std::size_t i = 0; i < 7; ++i) v[i] = float_at(bytes, at + 4 * i);
  const Eigen::Quaterniond rotation(v[6], v[3], v[4], v[5]);
  if (!(std::abs(rotation.norm() - 1) <= kTolerance)) return std::nullopt;
  return in_lps(rotation, {v[0], v[1], v[2]});
}

// What the metadata say of this key; empty: nothing. A count, the sizes of each key and value, then all keys
// with their values. nullopt: the sizes do not fit.
std::optional<std::string> metadata_value(Bytes sizes, Bytes values, std::string_view wanted) {
  if (sizes.empty()) return "";
  if (sizes.size() < 2) return std::nullopt;
  constexpr std::size_t kEntry = 8;
  const std::uint64_t count = number_at(sizes, 0, 2);
  if (sizes.size() != 2 + kEntry * count) return std::nullopt;
  std::string found;
  std::size_t at = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint64_t key_size = number_at(sizes, 2 + kEntry * i, 2);
    const std::uint64_t value_size = number_at(sizes, 2 + kEntry * i + 4, 4);
    if (key_size + value_size > values.size() - at) return std::nullopt;
    if (text_at(values, at, key_size) == wanted) found = text_at(values, at + key_size, value_size);
    at += key_size + value_size;
  }
  return found;
}

bool is_read(const std::string& type) {
  return type == "TRANSFORM" || type == "TDATA" || type == "QTDATA" || type == "STATUS";
}

}  // namespace

IgtlReader::IgtlReader(MessageListener& listener) : listener_(listener) {
  header_.reserve(kHeaderSize);
  body_.reserve(kMostBody);
}

bool IgtlReader::take(Bytes bytes) {
  while (!bytes.empty()) {
    if (!has_header_) {
      const std::size_t part = std::min(kHeaderSize - header_.size(), bytes.size());
      header_.insert(header_.end(), bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(part));
      bytes = bytes.subspan(part);
      if (header_.size() < kHeaderSize) return true;
      if (!begin_body()) return false;
    } else {
      const auto part = static_cast<std::size_t>(std::min<std::uint64_t>(to_come_, bytes.size()));
      if (!is_passed_over_)
        body_.insert(body_.end(), bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(part));
      bytes = bytes.subspan(part);
      to_come_ -= part;
    }
    if (has_header_ && to_come_ == 0) end_body();
  }
  return true;
}

bool IgtlReader::begin_body() {
  const Bytes header(header_);
  message_.version = static_cast<int>(number_at(header, 0, 2));
  message_.type = text_at(header, 2, kTypeSize);
  message_.device = text_at(header, 2 + kTypeSize, kNameSize);
  const std::uint64_t stamp = number_at(header, 34, 8);  // seconds, and 2^-32 of one
  message_.stamp_utc_s =
      static_cast<double>(stamp >> 32) + static_cast<double>(stamp & 0xFFFFFFFFU) * 0x1p-32;
  message_.body_size = number_at(header, 42, 8);
  message_.checksum = number_at(header, 50, 8);
  const bool is_type =
      !message_.type.empty() && std::all_of(message_.type.begin(), message_.type.end(), [](char c) {
        return (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
      });
  if (message_.version < 1 || message_.version > kNewestVersion || !is_type ||
      message_.body_size > kLargestBody) {
    listener_.refused("what comes is no OpenIGTLink");
    return false;
  }
  listener_.header(message_.version, message_.type);
  has_header_ = true;
  to_come_ = message_.body_size;
  is_passed_over_ = !is_read(message_.type) || message_.body_size > kMostBody;
  if (is_passed_over_ && is_read(message_.type))
    listener_.refused("a " + message_.type + " of " + std::to_string(message_.body_size) +
                      " bytes is too large");
  return true;
}

void IgtlReader::end_body() {
  has_header_ = false;
  header_.clear();
  ++ended_count_;
  if (!is_passed_over_) {
    if (crc64(body_.data(), body_.size(), 0) != message_.checksum)
      listener_.refused("the checksum of a " + message_.type + " is wrong");
    else
      read_message(body_);
  }
  body_.clear();
}

void IgtlReader::read_message(Bytes content) {
  const auto refuse = [&] {
    listener_.refused("a " + message_.type + " has lengths that do not fit into it");
  };
  std::string tool_status;
  if (message_.version > 1) {  // an extended header before the content, metadata behind it
    if (content.size() < kExtendedHeaderSize) return refuse();
    const std::uint64_t before = number_at(content, 0, 2);
    const std::uint64_t sizes = number_at(content, 2, 2), values = number_at(content, 4, 4);
    if (before < kExtendedHeaderSize || before + sizes + values > content.size()) return refuse();
    const Bytes metadata = content.last(sizes + values);
    const auto value = metadata_value(metadata.first(sizes), metadata.last(values), kToolStatusKey);
    if (!value) return refuse();
    tool_status = *value;
    content = content.subspan(before, content.size() - before - sizes - values);
  }
  if (message_.type == "TRANSFORM") {
    if (content.size() != 48) return refuse();
    // A tool that is not seen keeps its last pose, with a stamp of now.
    if (!tool_status.empty() && tool_status != kToolSeen)
      return listener_.status(message_.device, false, tool_status);
    return listener_.pose(message_.device, matrix_at(content, 0), message_.stamp_utc_s);
  }
  if (message_.type == "STATUS") {
    constexpr std::size_t kFixed = 30;
    if (content.size() < kFixed) return refuse();
    const std::string words = text_at(content, kFixed, content.size() - kFixed);
    return listener_.status(message_.device, number_at(content, 0, 2) == kStatusOk, words);
  }
  const bool is_matrix = message_.type == "TDATA";
  const std::size_t size = is_matrix ? 70 : 50;
  if (content.size() % size != 0) return refuse();
  for (std::size_t at = 0; at < content.size(); at += size) {
    constexpr std::size_t kBeforePose = kNameSize + 2;
    const std::string name = text_at(content, at, kNameSize);
    listener_.pose(
        name.empty() ? message_.device : name,
        is_matrix ? matrix_at(content, at + kBeforePose) : quaternion_at(content, at + kBeforePose),
        message_.stamp_utc_s);
  }
}

}  // namespace arthronaut::openigtlink
