#include "app/start/case_library.h"

#include <algorithm>
#include <exception>
#include <utility>

#include "app/library/workstation_library.h"
#include "planning/cases/case_note.h"
#include "planning/geometry/error.h"

namespace arthronaut::start {

namespace fs = std::filesystem;

CaseLibrary::CaseLibrary(fs::path data_folder, std::function<void()> wake)
    : data_folder_(std::move(data_folder)), wake_(std::move(wake)) {}

CaseLibrary::~CaseLibrary() { stops_ = true; }

void CaseLibrary::refresh(const std::vector<fs::path>& recent) {
  if (is_looking()) return;
  what_.clear();
  if (records_.empty()) show_known();
  looking_.start(
      [this, recent] {
        const auto known = workstation_library::open_library(data_folder_);
        known->add_those_there(recent);
        Found found{known->look([this](std::size_t, std::size_t) { return !stops_; }), {}, {}};
        // Here, and not when words are sought: a share that answers late would hold the window up.
        if (!stops_) found.identities = library::read_identities(found.records);
        if (!known->notices().empty()) found.what = known->notices().back();
        return found;
      },
      wake_);
}

// Some 30 ms of a thousand cases, so at once.
void CaseLibrary::show_known() {
  try {  // as in poll()
    const auto known = workstation_library::open_library(data_folder_);
    records_ = known->known();
    if (!known->notices().empty()) what_ = known->notices().back();
  } catch (const std::exception& error) {
    what_ = error.what();
  }
}

bool CaseLibrary::poll() {
  if (!looking_.is_ready()) return false;
  try {  // the top of the looking thread: a list that cannot be had is said on the screen
    Found found = looking_.take();
    records_ = std::move(found.records);
    identities_ = std::move(found.identities);
    for (library::CaseRecord& record : records_)
      if (const auto note = notes_meanwhile_.find(record.folder); note != notes_meanwhile_.end())
        record.note = note->second;
    if (!found.what.empty()) what_ = std::move(found.what);
  } catch (const std::exception& error) {
    what_ = error.what();
  }
  notes_meanwhile_.clear();
  return true;
}

bool CaseLibrary::save_note(const fs::path& case_folder, const std::string& text, const std::string& before) {
  what_.clear();
  try {
    cases::save_note_over(case_folder, text, before);
  } catch (const InvalidInput& error) {
    what_ = error.what();
  } catch (const IoError& error) {
    what_ = error.what();
  }
  if (!what_.empty()) return false;
  if (is_looking()) notes_meanwhile_[case_folder] = text;
  for (library::CaseRecord& record : records_)
    if (record.folder == case_folder) record.note = text;
  return true;
}

bool CaseLibrary::forget(const fs::path& case_folder) {
  what_.clear();
  try {
    workstation_library::open_library(data_folder_)->forget(case_folder);
  } catch (const InvalidInput& error) {
    what_ = error.what();
  } catch (const IoError& error) {
    what_ = error.what();
  }
  if (!what_.empty()) return false;
  std::erase_if(records_, [&](const library::CaseRecord& record) { return record.folder == case_folder; });
  return true;
}

}  // namespace arthronaut::start
