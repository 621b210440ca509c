// What is wrong with what is asked for, whichever way it goes: for before a connection is made.
#pragma once

#include "planning/pacs/query.h"
#include "planning/pacs/retrieve.h"

namespace arthronaut::pacs {

// Each throws InvalidInput.
void check(const FindKeys& keys, const FindOptions& options);
void check(const RetrieveRequest& request);

}  // namespace arthronaut::pacs
