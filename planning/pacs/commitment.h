// Storage commitment, push model (PS3.4 J): asked for by N-ACTION, reported by N-EVENT-REPORT. Inner header
// of pacs.
#pragma once

#include <stop_token>
#include <string>
#include <vector>

#include "planning/pacs/send.h"

namespace arthronaut::pacs {

// Of those files that are stored; sets is_committed, and `commitment` and its note.
void ask_commitment(const Peer& peer, const ConnectionOptions& connection, const SendOptions& options,
                    SendSummary& summary, const std::stop_token& stop);

}  // namespace arthronaut::pacs
