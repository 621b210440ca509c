// The library as the start shows it: what is known at once, and a look at the folders beside the screen.
//
// One thread; poll() once a frame. A thread of its own looks at the folders; `wake` is called from it.
#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "navigation/worker/awaited.h"
#include "planning/library/case_record.h"
#include "planning/library/cohort.h"

namespace arthronaut::start {

class CaseLibrary {
 public:
  CaseLibrary(std::filesystem::path data_folder, std::function<void()> wake);
  ~CaseLibrary();  // stops the look, and waits for the case that is being read
  CaseLibrary(const CaseLibrary&) = delete;
  CaseLibrary& operator=(const CaseLibrary&) = delete;

  // Where nothing is shown yet shows what the index says; looks at the folders and at these (recent cases).
  // Nothing while it looks.
  void refresh(const std::vector<std::filesystem::path>& recent);
  // Takes over what the thread has found; true once when it has.
  bool poll();
  [[nodiscard]] bool is_looking() const { return looking_.is_busy(); }

  // In no order. Another list after each refresh() and poll().
  [[nodiscard]] const std::vector<library::CaseRecord>& records() const { return records_; }
  // Whose they are, for the search; as the last look read it, and in no index.
  [[nodiscard]] const library::Identities& identities() const { return identities_; }
  // Each changes the list on disk and here. false: what() says why not.
  bool save_note(const std::filesystem::path& case_folder, const std::string& text,
                 const std::string& before);
  bool forget(const std::filesystem::path& case_folder);
  // What went wrong last, or what the user should know of the list; empty else.
  [[nodiscard]] const std::string& what() const { return what_; }

 private:
  void show_known();

  struct Found {
    std::vector<library::CaseRecord> records;
    std::string what;
    library::Identities identities;
  };
  std::filesystem::path data_folder_;
  std::function<void()> wake_;
  std::atomic<bool> stops_ = false;
  std::vector<library::CaseRecord> records_;
  library::Identities identities_;
  // Kept while the thread looks: it may have read the case before.
  std::map<std::filesystem::path, std::string> notes_meanwhile_;
  std::string what_;
  worker::Awaited<Found> looking_;  // last: ends first
};

}  // namespace arthronaut::start
