#include "navigation/openigtlink/igtl_messages.h"

#include <igtlPointMessage.h>
#include <igtlStatusMessage.h>
#include <igtlTimeStamp.h>
#include <igtlTransformMessage.h>
#include <igtl_util.h>

#include <cstddef>

namespace arthronaut::openigtlink {

namespace {

constexpr std::size_t kHeaderSize = 58, kBodySizeAt = 42, kChecksumAt = 50;

void put(Message& message, std::size_t at, std::size_t size, std::uint64_t value) {
  for (std::size_t i = size; i-- > 0; value >>= 8) message[at + i] = static_cast<std::uint8_t>(value);
}
void append(Message& message, std::size_t size, std::uint64_t value) {
  message.resize(message.size() + size);
  put(message, message.size() - size, size, value);
}

Message packed(igtl::MessageBase& message, const std::string& device, double utc_s) {
  message.SetDeviceName(device.c_str());
  auto time = igtl::TimeStamp::New();
  time->SetTime(utc_s);
  message.SetTimeStamp(time);
  message.Pack();
  const auto* const from = static_cast<const std::uint8_t*>(message.GetPackPointer());
  return {from, from + message.GetPackSize()};
}

// The same in version 2, which this library does not write: between header and content an extended header,
// behind the content one entry of metadata, its sizes first.
Message in_version_2(const Message& message, std::string_view key, std::string_view value) {
  constexpr std::uint64_t kExtendedHeaderSize = 12, kSizesOfOne = 10, kUsAscii = 3;
  Message made(message.begin(), message.begin() + kHeaderSize);
  append(made, 2, kExtendedHeaderSize);
  append(made, 2, kSizesOfOne);
  append(made, 4, key.size() + value.size());
  append(made, 4, 0);  // of the message: no answer is given by that number
  made.insert(made.end(), message.begin() + kHeaderSize, message.end());
  append(made, 2, 1);
  append(made, 2, key.size());
  append(made, 2, kUsAscii);
  append(made, 4, value.size());
  made.insert(made.end(), key.begin(), key.end());
  made.insert(made.end(), value.begin(), value.end());
  const std::uint64_t size = made.size() - kHeaderSize;
  put(made, 0, 2, 2);
  put(made, kBodySizeAt, 8, size);
  put(made, kChecksumAt, 8, crc64(made.data() + kHeaderSize, size, 0));
  return made;
}

}  // namespace

Message status_message(const std::string& device, const Status& status, const std::string& name,
                       double utc_s) {
  const auto message = igtl::StatusMessage::New();
  message->SetCode(status.is_ok ? igtl::StatusMessage::STATUS_OK : igtl::StatusMessage::STATUS_NOT_READY);
  message->SetErrorName(status.is_ok ? "" : name.c_str());
  message->SetStatusString(status.reason.c_str());
  return packed(*message, device, utc_s);
}

Message transform_message(const NamedTransform& named, double utc_s) {
  igtl::Matrix4x4 matrix;
  igtl::IdentityMatrix(matrix);
  const Eigen::Matrix3d rotation = named.target_from_source.matrix();
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column)
      matrix[row][column] = static_cast<float>(rotation(row, column));
    matrix[row][3] = static_cast<float>(named.target_from_source.translation_mm[row]);
  }
  const auto message = igtl::TransformMessage::New();
  message->SetMatrix(matrix);
  return packed(*message, named.name, utc_s);
}

Message transform_message_2(const NamedTransform& named, bool is_valid, double utc_s) {
  return in_version_2(transform_message(named, utc_s), "TransformStatus", is_valid ? "OK" : "INVALID");
}

Message plan_message(const operation::OperationState& state, double utc_s) {
  const auto message = igtl::PointMessage::New();
  for (const NamedPoint& point : plan_points(state)) {
    auto element = igtl::PointElement::New();
    element->SetName(point.name.c_str());
    element->SetGroupName("Plan");
    element->SetRGBA(255, 200, 0, 255);
    const Eigen::Vector3f at = point.position_mm.cast<float>();
    element->SetPosition(at.x(), at.y(), at.z());
    element->SetRadius(static_cast<float>(point.radius_mm));
    message->AddPointElement(element);
  }
  return packed(*message, "Plan", utc_s);
}

}  // namespace arthronaut::openigtlink
