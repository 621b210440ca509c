#include "planning/dicom_out/object_bytes.h"

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dcostrmb.h>
#include <dcmtk/dcmdata/dctk.h>
#include <dcmtk/dcmdata/dcwcache.h>

#include <vector>

#include "planning/geometry/error.h"

namespace arthronaut::dicom_out {

namespace {

constexpr E_TransferSyntax kSyntax = EXS_LittleEndianExplicit;

// DCMTK writes until the buffer is full, and goes on where it was once that is empty again.
template <typename Write>
std::string written(DcmObject& object, const Write& write) {
  std::string bytes;
  std::vector<char> buffer(std::size_t{1} << 16);
  DcmOutputBufferStream stream(buffer.data(), static_cast<offile_off_t>(buffer.size()));
  DcmWriteCache cache;
  object.transferInit();
  OFCondition outcome = EC_Normal;
  do {
    outcome = write(stream, cache);
    void* filled = nullptr;
    offile_off_t length = 0;
    stream.flushBuffer(filled, length);
    bytes.append(static_cast<const char*>(filled), static_cast<std::size_t>(length));
  } while (outcome == EC_StreamNotifyClient);
  object.transferEnd();
  if (outcome.bad()) throw IoError(std::string("a DICOM object could not be written: ") + outcome.text());
  return bytes;
}

}  // namespace

std::string bytes_of(DcmDataset& dataset) {
  return written(dataset, [&](DcmOutputStream& stream, DcmWriteCache& cache) {
    return dataset.write(stream, kSyntax, EET_ExplicitLength, &cache, EGL_recalcGL, EPD_noChange);
  });
}

std::string bytes_of(DcmFileFormat& file) {
  if (const OFCondition outcome = file.validateMetaInfo(kSyntax); outcome.bad())
    throw IoError(std::string("a DICOM object has no meta information: ") + outcome.text());
  return written(file, [&](DcmOutputStream& stream, DcmWriteCache& cache) {
    return file.write(stream, kSyntax, EET_ExplicitLength, &cache, EGL_recalcGL, EPD_noChange);
  });
}

}  // namespace arthronaut::dicom_out
