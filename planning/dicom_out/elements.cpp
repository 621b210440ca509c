#include "planning/dicom_out/elements.h"

#include "planning/geometry/error.h"

namespace arthronaut::dicom_out {

namespace {

void check(const OFCondition& condition, const DcmTagKey& key) {
  if (condition.good()) return;
  throw IoError(std::string("DICOM element ") + DcmTag(key).getTagName() +
                " cannot be written: " + condition.text());
}

}  // namespace

void put(DcmItem& item, const DcmTagKey& key, const std::string& value) {
  check(value.empty() ? item.insertEmptyElement(key) : item.putAndInsertString(key, value.c_str()), key);
}

void put_if_known(DcmItem& item, const DcmTagKey& key, const std::string& value) {
  if (!value.empty()) put(item, key, value);
}

void put_number(DcmItem& item, const DcmTagKey& key, int value) {
  check(item.putAndInsertUint16(key, static_cast<Uint16>(value)), key);
}

void put_long_number(DcmItem& item, const DcmTagKey& key, Uint32 value) {
  check(item.putAndInsertUint32(key, value), key);
}

void put_bytes(DcmItem& item, const DcmTagKey& key, const void* bytes, std::size_t count) {
  check(item.putAndInsertUint8Array(key, static_cast<const Uint8*>(bytes), static_cast<unsigned long>(count)),
        key);
}

void put_empty_sequence(DcmItem& item, const DcmTagKey& key) { check(item.insertEmptyElement(key), key); }

DcmItem& item_of(DcmItem& item, const DcmTagKey& sequence, long number) {
  DcmItem* found = nullptr;
  check(item.findOrCreateSequenceItem(sequence, found, number), sequence);
  return *found;
}

}  // namespace arthronaut::dicom_out
