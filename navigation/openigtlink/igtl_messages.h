// The messages that go out of an operation, ready to be sent: header, body and checksum.
//
// A transform of protocol version 1 has no place for its validity; one of version 2 says it in its metadata,
// as PLUS and 3D Slicer do ("TransformStatus": OK, INVALID). Who reads version 1 alone would read the numbers
// of a version 2 message wrongly: it goes to nobody who has not shown that he knows it.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "navigation/openigtlink/named_transforms.h"

namespace arthronaut::openigtlink {

using Message = std::vector<std::uint8_t>;

// device: whose status it is; name: of the error, where it is not OK.
[[nodiscard]] Message status_message(const std::string& device, const Status& status, const std::string& name,
                                     double utc_s);
[[nodiscard]] Message transform_message(const NamedTransform& named, double utc_s);
// Of version 2. Where it is not valid its pose is one of before.
[[nodiscard]] Message transform_message_2(const NamedTransform& named, bool is_valid, double utc_s);
[[nodiscard]] Message plan_message(const operation::OperationState& state, double utc_s);

}  // namespace arthronaut::openigtlink
