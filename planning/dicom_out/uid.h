// Unique identifiers of DICOM that follow from what they name: the same contents have the same identifier on
// every machine and on every day. Inner header of dicom_out.
#pragma once

#include <string>
#include <string_view>

namespace arthronaut::dicom_out {

// "2.25." and the decimal number of a UUID (DICOM PS3.5, B.2), which is the first 128 bits of the SHA-256 of
// `purpose` and `contents` with the marks of a version 8, a UUID of one's own making (RFC 9562, 5.8).
// `purpose` keeps identifiers of different things apart that are made of the same contents.
[[nodiscard]] std::string uid_of(std::string_view purpose, std::string_view contents);

// 1 to 64 digits and dots, with a digit at both ends. Leading zeros of a component, which the standard
// forbids, are taken: what is filed beside a study has to carry its identifier, right or wrong.
[[nodiscard]] bool is_uid(std::string_view text);

}  // namespace arthronaut::dicom_out
