// Text of a data set in UTF-8, whatever character set the hospital writes.
#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dcspchrs.h>
#include <dcmtk/dcmdata/dctk.h>
#include <iconv.h>

#include <algorithm>
#include <optional>

#include "planning/images/dicom_file.h"

namespace arthronaut::images {

namespace {

constexpr char kEscape = '\x1b';

bool is_ascii(char c) { return static_cast<unsigned char>(c) < 0x80; }
bool is_control(char c) { return static_cast<unsigned char>(c) < 0x20 || c == '\x7f'; }

// By a set that the C library knows; nothing when the text is not of it.
std::optional<std::string> converted(std::string text, const char* set) {
  const iconv_t converter = iconv_open("UTF-8", set);
  if (converter == reinterpret_cast<iconv_t>(-1)) return std::nullopt;
  std::string utf8(4 * text.size() + 4, '\0');  // a character has two bytes at least, or becomes three
  char *from = text.data(), *to = utf8.data();
  std::size_t from_bytes = text.size(), to_bytes = utf8.size();
  const bool is_done = iconv(converter, &from, &from_bytes, &to, &to_bytes) != static_cast<std::size_t>(-1);
  iconv_close(converter);
  if (!is_done) return std::nullopt;
  utf8.resize(utf8.size() - to_bytes);
  return utf8;
}

// The sets that the data set names, as DCMTK has them. A set begins anew after a delimiter, within a name as
// well.
std::optional<std::string> by_named_sets(DcmItem& dataset, const std::string& text) {
  DcmSpecificCharacterSet sets;
  OFString utf8;
  if (sets.selectCharacterSet(dataset).bad() ||
      sets.convertString(text.c_str(), text.size(), utf8, "\\^=").bad())
    return std::nullopt;
  return std::string(utf8.c_str(), utf8.length());
}

// Kanji (ISO 2022 IR 87 and 159), which DCMTK cannot convert by the C library although that knows them by
// another name. The katakana of ISO_IR 13 beside them, of eight bits, have an escape sequence of their own
// there.
std::optional<std::string> from_japanese(const std::string& text) {
  if (text.find("\x1b$") == std::string::npos) return std::nullopt;
  std::string escaped;
  for (const char c : text)
    escaped +=
        is_ascii(c) ? std::string(1, c) : std::string("\x1b(I") + static_cast<char>(c & 0x7f) + "\x1b(J";
  return converted(escaped, "ISO-2022-JP-3");
}

}  // namespace

std::string utf8_text_of(DcmItem& dataset, const DcmTagKey& key) {
  std::string text = text_of(dataset, key);
  if (!std::all_of(text.begin(), text.end(), [](char c) { return is_ascii(c) && c != kEscape; })) {
    auto utf8 = by_named_sets(dataset, text);
    if (!utf8) utf8 = from_japanese(text);
    if (!utf8) utf8 = converted(text, "UTF-8");  // some write it and do not say so
    if (!utf8)
      std::replace_if(
          text.begin(), text.end(), [](char c) { return !is_ascii(c); }, '?');
    if (utf8) text = *utf8;
  }
  std::erase_if(text, is_control);
  return text;
}

}  // namespace arthronaut::images
