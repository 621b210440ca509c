// One C-FIND on an association that stands. Inner header of pacs.
#pragma once

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dctk.h>

#include <functional>
#include <string>
#include <vector>

#include "planning/pacs/association.h"

namespace arthronaut::pacs {

// Contexts for C-FIND in both models.
void propose_find(std::vector<Proposal>& proposals);

struct FindOutcome {
  bool is_broken = false;  // the connection: it may be tried again
  bool is_cut = false;     // stopped after `most` answers
  bool is_over = false;    // the peer would not stop, so the connection was cut: it takes no further question
  std::string refusal = {};  // of the peer; empty: it answered to the end
};

// Sends the query and hands every answer to `take`, at most `most`. `query` must hold its level and its keys.
// An answer of more than 1 MB, and a search that goes on for ten times the answer's time-out, are refusals.
[[nodiscard]] FindOutcome send_find(Association& association, DcmDataset& query, int most,
                                    const std::function<void(DcmDataset&)>& take);

// Sets the value, in UTF-8 where it is not ASCII.
void put_key(DcmDataset& query, const DcmTagKey& key, const std::string& value);
// -1 where the answer does not say it.
[[nodiscard]] int count_of(DcmItem& answer, const DcmTagKey& key);

}  // namespace arthronaut::pacs
