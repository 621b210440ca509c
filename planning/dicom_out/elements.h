// Putting values into DCMTK's items. All throw IoError, naming the element, when DCMTK refuses one.
// Inner header of dicom_out.
#pragma once

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dctk.h>

#include <string>

namespace arthronaut::dicom_out {

// Empty: the element stands there without a value, as one of type 2 that is not known.
void put(DcmItem& item, const DcmTagKey& key, const std::string& value);
void put_if_known(DcmItem& item, const DcmTagKey& key, const std::string& value);
void put_number(DcmItem& item, const DcmTagKey& key, int value);          // 16 bits, not negative
void put_long_number(DcmItem& item, const DcmTagKey& key, Uint32 value);  // 32 bits
void put_bytes(DcmItem& item, const DcmTagKey& key, const void* bytes, std::size_t count);
void put_empty_sequence(DcmItem& item, const DcmTagKey& key);
// That item of the sequence, from 0; made where it is the next.
[[nodiscard]] DcmItem& item_of(DcmItem& item, const DcmTagKey& sequence, long number);

}  // namespace arthronaut::dicom_out
