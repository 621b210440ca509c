// One image as a peer sends it, from its C-STORE to the file. Inner header of pacs.
#pragma once

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmnet/dimse.h>

#include <functional>
#include <string>

#include "planning/pacs/incoming_series.h"

namespace arthronaut::pacs {

// Takes the data set that follows `request` and answers it. The bytes go to the file as they come, under the
// transfer syntax that was negotiated: nothing is decoded. What is not of the series, or bears no UID that
// can be a file's name, is read, refused and not kept.
//
// Returns a bad condition when the connection broke, with nothing kept. Throws IoError when it cannot be
// written (disk full); the connection can then only be aborted.
[[nodiscard]] OFCondition receive_image(T_ASC_Association& association, T_ASC_PresentationContextID context,
                                        const T_DIMSE_C_StoreRQ& request, int timeout_s,
                                        IncomingSeries& series);

}  // namespace arthronaut::pacs
