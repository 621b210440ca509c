// A tracker for the tests: packs its messages by OpenIGTLink's own library, so that what is read was written
// by somebody else, and serves them to whoever connects.
#pragma once

#include <arpa/inet.h>
#include <igtlQuaternionTrackingDataMessage.h>
#include <igtlStatusMessage.h>
#include <igtlTimeStamp.h>
#include <igtlTrackingDataMessage.h>
#include <igtlTransformMessage.h>
#include <igtl_util.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

#include "navigation/openigtlink/ras_from_lps.h"

namespace arthronaut::test {

using Bytes = std::vector<std::uint8_t>;

inline double utc_s() {
  return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
}

// lps: as this program keeps it; it goes out in RAS.
inline void into_matrix(const geometry::RigidTransform& lps, igtl::Matrix4x4& matrix) {
  const geometry::RigidTransform ras = openigtlink::ras_from_lps(lps);
  const Eigen::Matrix3d rotation = ras.matrix();
  igtl::IdentityMatrix(matrix);
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column)
      matrix[row][column] = static_cast<float>(rotation(row, column));
    matrix[row][3] = static_cast<float>(ras.translation_mm[row]);
  }
}

// Length and checksum of the body as it is.
inline void seal(Bytes& message) {
  constexpr std::size_t kHeader = 58;
  std::uint64_t length = message.size() - kHeader;
  std::uint64_t checksum = crc64(message.data() + kHeader, length, 0);
  for (std::size_t i = 8; i-- > 0; length >>= 8, checksum >>= 8) {
    message[42 + i] = static_cast<std::uint8_t>(length);
    message[50 + i] = static_cast<std::uint8_t>(checksum);
  }
}

// The same as newer programs send it: an extended header of 12 bytes before the content, metadata behind it.
// This library does not write that yet.
inline Bytes as_version_2(Bytes message, const std::string& tool_status = "") {
  Bytes before{0, 12, 0, 2, 0, 0, 0, 3, 0, 0, 0, 1}, behind{0, 0, 'a', 'b', 'c'};
  if (!tool_status.empty()) {  // two entries of metadata: their sizes, then each key with its value
    const std::string texts =
        "Quality"
        "0.5"
        "TransformStatus" +
        tool_status;
    const auto size = static_cast<std::uint8_t>(tool_status.size());
    before = {0, 12, 0, 18, 0, 0, 0, static_cast<std::uint8_t>(texts.size()), 0, 0, 0, 1};
    behind = {0, 2, 0, 7, 0, 3, 0, 0, 0, 3, 0, 15, 0, 3, 0, 0, 0, size};
    behind.insert(behind.end(), texts.begin(), texts.end());
  }
  message[1] = 2;
  message.insert(message.begin() + 58, before.begin(), before.end());
  message.insert(message.end(), behind.begin(), behind.end());
  seal(message);
  return message;
}

inline Bytes packed(igtl::MessageBase& message, const std::string& device, double stamp_s) {
  message.SetDeviceName(device.c_str());
  auto time = igtl::TimeStamp::New();
  time->SetTime(stamp_s);
  message.SetTimeStamp(time);
  message.Pack();
  const auto* const from = static_cast<const std::uint8_t*>(message.GetPackPointer());
  return {from, from + message.GetPackSize()};
}

inline Bytes transform_message(const std::string& device, const geometry::RigidTransform& lps, double stamp_s,
                               int version = 1) {
  const auto message = igtl::TransformMessage::New();
  igtl::Matrix4x4 matrix;
  into_matrix(lps, matrix);
  message->SetMatrix(matrix);
  Bytes bytes = packed(*message, device, stamp_s);
  return version == 1 ? bytes : as_version_2(std::move(bytes));
}

inline Bytes matrix_message(const std::string& tool, const geometry::RigidTransform& lps, double stamp_s) {
  const auto message = igtl::TrackingDataMessage::New();
  auto element = igtl::TrackingDataElement::New();
  element->SetName(tool.c_str());
  igtl::Matrix4x4 matrix;
  into_matrix(lps, matrix);
  element->SetMatrix(matrix);
  message->AddTrackingDataElement(element);
  return packed(*message, "Tracker", stamp_s);
}

inline Bytes quaternion_message(const std::string& tool, const geometry::RigidTransform& lps,
                                double stamp_s) {
  const auto message = igtl::QuaternionTrackingDataMessage::New();
  auto element = igtl::QuaternionTrackingDataElement::New();
  element->SetName(tool.c_str());
  const geometry::RigidTransform ras = openigtlink::ras_from_lps(lps);
  const Eigen::Vector3f t = ras.translation_mm.cast<float>();
  const Eigen::Quaternionf q = ras.rotation.cast<float>();
  element->SetPosition(t.x(), t.y(), t.z());
  element->SetQuaternion(q.x(), q.y(), q.z(), q.w());
  message->AddQuaternionTrackingDataElement(element);
  return packed(*message, "Tracker", stamp_s);
}

inline Bytes status_message(const std::string& device, bool is_ok, const std::string& words) {
  const auto message = igtl::StatusMessage::New();
  message->SetCode(is_ok ? igtl::StatusMessage::STATUS_OK : igtl::StatusMessage::STATUS_NOT_READY);
  message->SetStatusString(words.c_str());
  return packed(*message, device, utc_s());
}

// Serves one client at a time on a port of its own, which stays the same when it is started again.
class TrackerPeer {
 public:
  TrackerPeer() { listen(); }
  ~TrackerPeer() { stop(); }
  TrackerPeer(const TrackerPeer&) = delete;
  TrackerPeer& operator=(const TrackerPeer&) = delete;

  [[nodiscard]] std::string address() const { return "igtl://127.0.0.1:" + std::to_string(port_); }
  // As a process that is killed: nothing listens any more.
  void stop() {
    drop();
    if (listening_ >= 0) ::close(listening_);
    listening_ = -1;
  }
  void start() {
    if (listening_ < 0) listen();
  }
  void drop() {
    if (client_ >= 0) ::close(client_);
    client_ = -1;
  }
  // False: nobody is there yet, or not any more.
  bool send(const Bytes& bytes) {
    if (listening_ >= 0 && client_ < 0) client_ = ::accept4(listening_, nullptr, nullptr, SOCK_NONBLOCK);
    if (client_ < 0) return false;
    if (::send(client_, bytes.data(), bytes.size(), MSG_NOSIGNAL) == static_cast<ssize_t>(bytes.size()))
      return true;
    drop();
    return false;
  }

 private:
  void listen() {
    listening_ = ::socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK, 0);
    const int on = 1;
    ::setsockopt(listening_, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
    sockaddr_in at{};
    at.sin_family = AF_INET;
    at.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    at.sin_port = htons(static_cast<std::uint16_t>(port_));
    socklen_t length = sizeof at;
    if (::bind(listening_, reinterpret_cast<sockaddr*>(&at), length) != 0 || ::listen(listening_, 1) != 0)
      throw std::runtime_error("no port to listen on");
    ::getsockname(listening_, reinterpret_cast<sockaddr*>(&at), &length);
    port_ = ntohs(at.sin_port);
  }
  int listening_ = -1, client_ = -1, port_ = 0;
};

}  // namespace arthronaut::test
