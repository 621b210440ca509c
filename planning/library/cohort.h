// The library as a file for other programs: every case as JSON, every session as a row of CSV.
#pragma once

#include <filesystem>
#include <map>
#include <span>
#include <string>

#include "planning/cases/identity.h"
#include "planning/library/case_record.h"
#include "planning/plan_review/tunnel_verdict.h"

namespace arthronaut::library {

// Whose knees they are, by the case's folder: null where nobody is to be named, which
// is what everything here does unless the user asks for it.
using Identities = std::map<std::filesystem::path, cases::Identity>;
// Of the cases that are there and have one; one that cannot be read is left out.
[[nodiscard]] Identities read_identities(std::span<const CaseRecord> records);

// What speaks against their plans, by the case's folder: of those that somebody has checked.
using PlanVerdicts = std::map<std::filesystem::path, plan_review::TunnelVerdict>;

// {"format": "arthronaut.cases", "version": 1, "cases": [...]}, in the order given. "-" is standard output.
// Throws IoError.
void write_cases_json(const std::filesystem::path& file, std::span<const CaseRecord> records,
                      const Identities* identities = nullptr, const PlanVerdicts& verdicts = {});

// One row a session, one for a case without any; what is not known is empty. Cells with commas, quotes or
// line ends are quoted (RFC 4180), a cell that a spreadsheet would take for a formula begins with an
// apostrophe.
[[nodiscard]] std::string cohort_csv(std::span<const CaseRecord> records,
                                     const Identities* identities = nullptr);

}  // namespace arthronaut::library
