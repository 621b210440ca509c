#include "planning/images/dicom_directory.h"

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dcdirrec.h>
#include <dcmtk/dcmdata/dctk.h>

#include <algorithm>
#include <map>

#include "planning/geometry/error.h"
#include "planning/images/dicom_file.h"
#include "planning/images/volume_bytes.h"

namespace arthronaut::images {

namespace {

namespace fs = std::filesystem;

// The file beside the directory, whatever the case of its name has become.
fs::path named_file(const fs::path& directory, const std::string& file_id) {
  fs::path found = directory.parent_path();
  if (found.empty()) found = ".";
  for (std::size_t at = 0; at <= file_id.size();) {
    const std::size_t end = std::min(file_id.find('\\', at), file_id.size());
    const std::string part = trimmed(std::string_view(file_id).substr(at, end - at));
    at = end + 1;
    if (part.empty() || part == "." || part == ".." || part.find('/') != std::string::npos)
      throw InvalidInput(directory, "", "names a file that is not in its folder: " + file_id.substr(0, 80));
    if (fs::exists(found / part)) {
      found /= part;
      continue;
    }
    std::error_code error;
    fs::path other;
    for (const auto& entry : fs::directory_iterator(found, error)) {
      if (lower_case(entry.path().filename().string()) == lower_case(part)) other = entry.path();
    }
    if (other.empty()) {
      throw InvalidInput(directory, "",
                         "names " + file_id.substr(0, 80) +
                             ", which is not there: copy the whole disc, or name the folder of the series");
    }
    found = other;
  }
  return found;
}

// The records by the byte at which each begins, by which they refer to each other.
using Records = std::map<Uint32, DcmItem*>;

Uint32 offset_of(DcmItem& item, const DcmTagKey& key) {
  Uint32 offset = 0;
  return item.findAndGetUint32(key, offset).good() ? offset : 0;
}

void collect(const fs::path& directory, Records& records, Uint32 first, std::vector<fs::path>& images) {
  constexpr std::size_t kMostLevels = 16;
  std::vector<Uint32> to_visit{first};
  while (!to_visit.empty()) {
    if (to_visit.back() == 0) {
      to_visit.pop_back();
      continue;
    }
    const std::string place = "record at byte " + std::to_string(to_visit.back());
    const auto found = records.find(to_visit.back());
    if (found == records.end()) throw InvalidInput(directory, place, "is not there");
    DcmItem* record = found->second;
    if (!record || to_visit.size() > kMostLevels)
      throw InvalidInput(directory, place, "is led to twice, or is too deep");
    found->second = nullptr;
    to_visit.back() = offset_of(*record, DCM_OffsetOfTheNextDirectoryRecord);
    if (unsigned_short_of(*record, DCM_RecordInUseFlag, 0xFFFF) == 0) continue;
    if (text_of(*record, DCM_DirectoryRecordType) == "IMAGE")
      images.push_back(named_file(directory, text_of(*record, DCM_ReferencedFileID)));
    to_visit.push_back(offset_of(*record, DCM_OffsetOfReferencedLowerLevelDirectoryEntity));
  }
}

}  // namespace

std::optional<std::vector<fs::path>> images_of_dicom_directory(const fs::path& file, std::size_t most_bytes) {
  const std::shared_ptr<DcmDataset> dataset = open_dicom(file, most_bytes);
  DcmSequenceOfItems* sequence = nullptr;
  if (dataset->findAndGetSequence(DCM_DirectoryRecordSequence, sequence).bad()) return std::nullopt;
  Records records;
  for (DcmObject* at = sequence->nextInContainer(nullptr); at; at = sequence->nextInContainer(at)) {
    if (auto* record = dynamic_cast<DcmDirectoryRecord*>(at)) records[record->getFileOffset()] = record;
  }
  std::vector<fs::path> images;
  collect(file, records, offset_of(*dataset, DCM_OffsetOfTheFirstDirectoryRecordOfTheRootDirectoryEntity),
          images);
  return images;
}

}  // namespace arthronaut::images
