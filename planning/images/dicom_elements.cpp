#include "planning/images/dicom_elements.h"

#include <array>

#include "planning/geometry/error.h"
#include "planning/images/volume_bytes.h"

namespace arthronaut::images {

namespace {

constexpr std::uint32_t kUndefined = 0xFFFFFFFF;
constexpr std::uint32_t kItem = 0xFFFEE000, kItemEnd = 0xFFFEE00D, kSequenceEnd = 0xFFFEE0DD;
constexpr std::uint32_t kPixelData = 0x7FE00010;
constexpr std::size_t kLongestValue = 1024;
constexpr int kDeepestNesting = 32;

struct ElementHeader {
  std::uint32_t tag = 0;
  std::uint32_t length = 0;
  bool is_unknown_type = false;  // UN: of undefined length, its inside is implicit
};

class Walker {
 public:
  Walker(const std::filesystem::path& file, std::string_view text, std::size_t at, bool is_explicit,
         std::endian order)
      : file_(file), text_(text), at_(at), is_explicit_(is_explicit), order_(order) {}

  [[nodiscard]] bool at_end() const { return at_ >= text_.size(); }
  [[nodiscard]] std::size_t byte() const { return at_; }

  ElementHeader header() {
    ElementHeader header;
    header.tag = static_cast<std::uint32_t>(unsigned_number(Scalar::UInt16)) << 16U;
    header.tag |= static_cast<std::uint32_t>(unsigned_number(Scalar::UInt16));
    const bool is_delimiter = header.tag >> 16U == 0xFFFE;
    if (!is_explicit_ || is_delimiter) {
      header.length = static_cast<std::uint32_t>(unsigned_number(Scalar::UInt32));
      return header;
    }
    const std::string_view type = bytes(2);
    for (const char c : type) {
      if (c < 'A' || c > 'Z') fail("expected the type of an element");
    }
    header.is_unknown_type = type == "UN";
    constexpr std::array<std::string_view, 13> kLong{"OB", "OD", "OF", "OL", "OV", "OW", "SQ",
                                                     "SV", "UC", "UN", "UR", "UT", "UV"};
    if (std::find(kLong.begin(), kLong.end(), type) != kLong.end()) {
      static_cast<void>(bytes(2));
      header.length = static_cast<std::uint32_t>(unsigned_number(Scalar::UInt32));
    } else {
      header.length = static_cast<std::uint32_t>(unsigned_number(Scalar::UInt16));
    }
    return header;
  }

  std::string_view bytes(std::size_t count) {
    if (text_.size() - at_ < count) fail("the file ends within an element");
    at_ += count;
    return text_.substr(at_ - count, count);
  }

  // Goes past a value: a sequence of undefined length is walked through, item by item.
  void skip(const ElementHeader& header, int depth) {
    if (header.length != kUndefined) {
      static_cast<void>(bytes(header.length));
      return;
    }
    if (depth > kDeepestNesting) fail("sequences are nested too deep");
    const bool was_explicit = is_explicit_;
    is_explicit_ = is_explicit_ && !header.is_unknown_type;
    for (;;) {
      const ElementHeader item = this->header();
      if (item.tag == kSequenceEnd) break;
      if (item.tag != kItem) fail("expected an item of a sequence");
      if (item.length != kUndefined) {
        static_cast<void>(bytes(item.length));
        continue;
      }
      for (ElementHeader inner = this->header(); inner.tag != kItemEnd; inner = this->header())
        skip(inner, depth + 1);
    }
    is_explicit_ = was_explicit;
  }

  [[noreturn]] void fail(const std::string& reason) const {
    throw InvalidInput(file_, "byte " + std::to_string(at_), "broken or cut off: " + reason);
  }

 private:
  double unsigned_number(Scalar type) { return decoded(type, order_, bytes(bytes_per(type)).data()); }

  const std::filesystem::path& file_;
  std::string_view text_;
  std::size_t at_;
  bool is_explicit_;
  std::endian order_;
};

std::string_view without_padding(std::string_view value) {
  while (!value.empty() && (value.back() == '\0' || value.back() == ' ')) value.remove_suffix(1);
  return value;
}

void read_dataset(Walker& walker, DicomElements& elements) {
  while (!walker.at_end()) {
    const ElementHeader header = walker.header();
    if (header.tag == kPixelData) {
      elements.has_pixel_data = true;
      elements.is_compressed = header.length == kUndefined;
      if (!elements.is_compressed) elements.raw_pixels = walker.bytes(header.length);
      return;  // what follows is padding and signatures
    }
    if (header.length <= kLongestValue) {
      elements.values.emplace(header.tag, walker.bytes(header.length));
    } else {
      walker.skip(header, 0);
    }
  }
}

}  // namespace

std::string DicomElements::text(std::uint16_t group, std::uint16_t element) const {
  const auto found = values.find(static_cast<std::uint32_t>(group) << 16U | element);
  return found == values.end() ? "" : trimmed(without_padding(found->second));
}

int DicomElements::unsigned_short(std::uint16_t group, std::uint16_t element, int absent) const {
  const auto found = values.find(static_cast<std::uint32_t>(group) << 16U | element);
  if (found == values.end() || found->second.size() < 2) return absent;
  return static_cast<int>(decoded(Scalar::UInt16, order, found->second.data()));
}

bool has_dicom_mark(std::string_view text) { return text.size() >= 132 && text.substr(128, 4) == "DICM"; }

DicomElements parse_dicom(const std::filesystem::path& file, std::string_view text) {
  DicomElements elements;
  // The file's own group is explicit and little endian, whatever follows.
  Walker meta(file, text, 132, true, std::endian::little);
  std::size_t dataset_at = meta.byte();
  while (text.size() - dataset_at >= 2 &&
         decoded(Scalar::UInt16, std::endian::little, text.data() + dataset_at) == 2) {
    const ElementHeader header = meta.header();
    if (header.length == kUndefined) meta.fail("an element of the file's header without a length");
    const std::string_view value = meta.bytes(header.length);
    if (header.tag == 0x00020010) elements.transfer_syntax = without_padding(value);
    dataset_at = meta.byte();
  }
  if (elements.transfer_syntax.empty()) throw InvalidInput(file, "", "names no transfer syntax");
  const std::string& syntax = elements.transfer_syntax;
  const bool is_explicit = syntax != "1.2.840.10008.1.2";
  if (syntax == "1.2.840.10008.1.2.2") elements.order = std::endian::big;
  if (syntax == "1.2.840.10008.1.2.1.99") {
    constexpr std::size_t kMostBytes = std::size_t{1} << 30;
    const std::string whole = inflated(file, text.substr(dataset_at), kMostBytes, Compression::Raw);
    Walker walker(file, whole, 0, true, std::endian::little);
    read_dataset(walker, elements);
    return elements;
  }
  Walker walker(file, text, dataset_at, is_explicit, elements.order);
  read_dataset(walker, elements);
  return elements;
}

}  // namespace arthronaut::images
