// One DICOM file, opened by DCMTK, and the values of its named elements. Inner header of images.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "planning/bones/bone.h"

class DcmDataset;
class DcmItem;
class DcmTagKey;

namespace arthronaut::images {

// 128 bytes of anything, then "DICM": what every DICOM file on a disk begins with. Throws IoError.
[[nodiscard]] bool has_dicom_mark(const std::filesystem::path& file);

// The data set up to and with the pixels. Of large values, the pixels above all, only the place in the file
// is kept: a folder costs what its headers hold, and each byte is read once. A deflated data set is unpacked
// whole, up to `most_bytes`.
//
// Throws InvalidInput ("FILE: byte N: broken or cut off: reason") and IoError. The file must have the mark.
[[nodiscard]] std::shared_ptr<DcmDataset> open_dicom(const std::filesystem::path& file,
                                                     std::size_t most_bytes);

// Which series a file is of that open_dicom() refuses, as far as what stands before its damage says it; empty
// where that says nothing. Does not throw for what it finds.
[[nodiscard]] std::string series_uid_before_damage(const std::filesystem::path& file);

// All values of the element, a backslash between them, without blanks around; empty when absent.
[[nodiscard]] std::string text_of(DcmItem& item, const DcmTagKey& key);
// The same in UTF-8, from the character sets that the data set names, without control characters. Of text
// that is not of them each byte beyond ASCII is a question mark.
[[nodiscard]] std::string utf8_text_of(DcmItem& dataset, const DcmTagKey& key);
// nullopt unless the element holds exactly `count` finite numbers.
[[nodiscard]] std::optional<std::vector<double>> decimals_of(DcmItem& item, const DcmTagKey& key,
                                                             std::size_t count);
// "L" or "R", as an element for a laterality has it; nullopt for whatever else is there: "B" is both.
[[nodiscard]] std::optional<bones::Side> side_of(DcmItem& item, const DcmTagKey& key);
[[nodiscard]] int unsigned_short_of(DcmItem& item, const DcmTagKey& key, int absent);

}  // namespace arthronaut::images
