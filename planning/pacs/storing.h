// One image as a peer sends it, from its C-STORE to the file. Inner header of pacs.
#pragma once

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmnet/dimse.h>

#include <functional>
#include <string>
#include <vector>

#include "planning/pacs/incoming_series.h"
#include "planning/pacs/line.h"

namespace arthronaut::pacs {

// Takes the data set that follows `request` and answers it. The bytes go to the file as they come, under the
// transfer syntax that was negotiated: nothing is decoded. What was not asked for (IncomingSeries::expect()),
// is of another class than its presentation context, or bears no UID that can be a file's name, is read,
// refused and not kept.
//
// Returns a bad condition when the connection broke, with nothing kept, or is to be ended since the peer goes
// on sending what is refused. Throws IoError when it cannot be written (disk full), or would leave too little
// of the disk free; the connection can then only be aborted.
[[nodiscard]] OFCondition receive_image(T_ASC_Association& association, Line& line,
                                        T_ASC_PresentationContextID context, const T_DIMSE_C_StoreRQ& request,
                                        int timeout_s, IncomingSeries& series);

// A class whose objects are stored, and an encoding that they may come in: all that DICOM has for images,
// except those that compress the whole data set or leave the pixels elsewhere (JPIP).
[[nodiscard]] bool can_be_stored(const std::string& sop_class);
[[nodiscard]] bool can_be_kept(const std::string& transfer_syntax);
[[nodiscard]] const std::vector<std::string>& compressed_syntaxes();

}  // namespace arthronaut::pacs
