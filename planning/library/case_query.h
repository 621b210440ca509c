// Finding cases in a list of them: words, filters and orders.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "planning/library/case_record.h"
#include "planning/library/cohort.h"

namespace arthronaut::library {

enum class CaseOrder {
  Newest,  // by the last change
  Name,
  Created,
  State,
  EntryOffset,  // of the last drilled tunnel, the largest first; without one last
};
[[nodiscard]] std::string_view to_text(CaseOrder order);  // "newest", "name", "created", "state", "offset"
[[nodiscard]] CaseOrder case_order_from_text(std::string_view text);  // throws InvalidInput

struct CaseQuery {
  // Each must stand somewhere in name, note, side, dates, state, plan, folder or a session's bone, source and
  // outcome; capital or not.
  std::string words = {};
  std::optional<bones::Side> side = {};  // empty: either
  std::optional<CaseState> state = {};
  CaseOrder order = CaseOrder::Newest;
};

// Which of the records, in order. Equal ones are in the order of their names, then of their folders.
// identities (read_identities, kept in no index): words find a patient's name, number and day of birth, too.
// In a list that names nobody, that a name finds a case tells whose it is: only for a list that names the
// patients, or that says of a case that it was found by its patient.
[[nodiscard]] std::vector<std::size_t> find_cases(std::span<const CaseRecord> records, const CaseQuery& query,
                                                  const Identities* identities = nullptr);

}  // namespace arthronaut::library
