#include "planning/library/case_query.h"

#include <algorithm>
#include <array>
#include <limits>
#include <sstream>
#include <tuple>
#include <utility>

#include "planning/files/folded_text.h"
#include "planning/files/local_time.h"
#include "planning/geometry/error.h"

namespace arthronaut::library {

namespace {

constexpr std::array<std::pair<CaseOrder, std::string_view>, 5> kOrders{{
    {CaseOrder::Newest, "newest"},
    {CaseOrder::Name, "name"},
    {CaseOrder::Created, "created"},
    {CaseOrder::State, "state"},
    {CaseOrder::EntryOffset, "offset"},
}};

// Null where nobody is to be named, or the case names nobody.
const cases::Identity* whose(const CaseRecord& record, const Identities* identities) {
  if (identities == nullptr) return nullptr;
  const auto found = identities->find(record.folder);
  return found == identities->end() ? nullptr : &found->second;
}

std::string searched(const CaseRecord& record, const cases::Identity* patient) {
  std::string text = record.name + "\n" + record.note + "\n" + word_of(record.side) + "\n" +
                     record.created_utc + "\n" + record.changed_utc + "\n" +
                     std::string(to_text(record.state())) + "\n" + files::local_day(record.created_utc) +
                     "\n" + files::local_day(record.changed_utc) + "\n" + record.plan_in_words() + "\n" +
                     record.folder.string() + "\n" + record.problem + "\n" + record.part_problem;
  for (const SessionFacts& session : record.sessions)
    text += "\n" + session.started_utc + "\n" + files::local_day(session.started_utc) + "\n" +
            word_of(session.bone) + "\n" + session.source_kind + "\n" + session.outcome();
  if (patient != nullptr)
    text += "\n" + patient->patient_name + "\n" + patient->name_in_words() + "\n" + patient->patient_id +
            "\n" + patient->birth_date + "\n" + patient->birth_date_in_words();
  return files::folded(text);
}

double last_offset_mm(const CaseRecord& record) {
  for (auto session = record.sessions.rbegin(); session != record.sessions.rend(); ++session)
    if (session->entry_offset_mm) return *session->entry_offset_mm;
  return -std::numeric_limits<double>::infinity();
}

// Negative, zero, positive as of strings.
int compare(const CaseRecord& a, const CaseRecord& b, CaseOrder order) {
  switch (order) {
    case CaseOrder::Newest:
      return b.changed_utc.compare(a.changed_utc);
    case CaseOrder::Created:
      return b.created_utc.compare(a.created_utc);
    case CaseOrder::State:
      return static_cast<int>(a.state()) - static_cast<int>(b.state());
    case CaseOrder::EntryOffset: {
      const double of_a = last_offset_mm(a), of_b = last_offset_mm(b);
      return of_a > of_b ? -1 : of_a < of_b ? 1 : 0;
    }
    case CaseOrder::Name:
      break;
  }
  return 0;
}

}  // namespace

std::string_view to_text(CaseOrder order) {
  return std::find_if(kOrders.begin(), kOrders.end(), [&](const auto& one) { return one.first == order; })
      ->second;
}

CaseOrder case_order_from_text(std::string_view text) {
  for (const auto& [order, word] : kOrders)
    if (word == text) return order;
  throw InvalidInput("\"" + std::string(text) + "\" is no order of cases");
}

std::vector<std::size_t> find_cases(std::span<const CaseRecord> records, const CaseQuery& query,
                                    const Identities* identities) {
  std::vector<std::string> words;
  std::istringstream stream(files::folded(query.words));
  for (std::string word; stream >> word;) words.push_back(std::move(word));
  std::vector<std::size_t> found;
  std::vector<std::string> names(records.size());
  for (std::size_t i = 0; i < records.size(); ++i) {
    const CaseRecord& record = records[i];
    if (query.side && record.side != query.side) continue;
    if (query.state && record.state() != *query.state) continue;
    if (!words.empty()) {
      const std::string text = searched(record, whose(record, identities));
      if (!std::all_of(words.begin(), words.end(),
                       [&](const std::string& word) { return text.find(word) != std::string::npos; }))
        continue;
    }
    names[i] = files::folded(record.name);
    found.push_back(i);
  }
  std::sort(found.begin(), found.end(), [&](std::size_t a, std::size_t b) {
    const int by_order = compare(records[a], records[b], query.order);
    if (by_order != 0) return by_order < 0;
    return std::tie(names[a], records[a].folder) < std::tie(names[b], records[b].folder);
  });
  return found;
}

}  // namespace arthronaut::library
