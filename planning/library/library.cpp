#include "planning/library/library.h"

#include <sys/stat.h>

#include <algorithm>
#include <utility>

#include "planning/files/private_folder.h"
#include "planning/geometry/error.h"
#include "planning/library/folder_search.h"
#include "planning/library/known_folders.h"
#include "planning/library/library_index.h"

namespace arthronaut::library {

namespace {

namespace fs = std::filesystem;

// One name for one folder: links and ".." resolved, where it is there.
fs::path known_as(const fs::path& folder) {
  std::error_code error;
  fs::path name = fs::weakly_canonical(fs::absolute(folder), error);
  if (error) name = fs::absolute(folder).lexically_normal();
  return name.has_filename() ? name : name.parent_path();  // "Knee.arthro/" is "Knee.arthro"
}

// Which file that is now: another one after it was put aside and made anew; 0 where there is none.
ino_t identity_of(const fs::path& file) {
  struct stat status {};
  return ::stat(file.c_str(), &status) == 0 ? status.st_ino : 0;
}

// Of a folder that may hold a thousand: its own name is resolved once.
std::vector<fs::path> cases_in(const fs::path& folder) {
  std::vector<fs::path> found;
  std::error_code error;
  const fs::path name = known_as(folder);
  for (fs::directory_iterator entry(name, error); !error && entry != fs::directory_iterator();
       entry.increment(error)) {
    std::error_code ignored;
    if (entry->is_symlink(ignored))
      found.push_back(known_as(entry->path()));
    else if (entry->is_directory(ignored))
      found.push_back(entry->path());
  }
  return found;
}

}  // namespace

struct Library::State {
  fs::path data_folder;
  SessionReader read_session;
  std::unique_ptr<LibraryIndex> index;
  ino_t index_identity = 0;  // of the file that it was opened on
  std::vector<std::string> notices;

  // Within a turn, so that of two programs one makes the index and the other finds it.
  void open() {
    files::create_private_folder(data_folder);
    const LibraryTurn turn(data_folder);
    const fs::path file = index_file(data_folder);
    const bool is_new = !fs::exists(file);
    try {
      open_index();
      if (is_new) fill();
    } catch (const IndexIsDamaged& damage) {
      make_anew(damage.what());
    }
  }

  void open_index() {
    index = std::make_unique<LibraryIndex>(index_file(data_folder));
    index_identity = identity_of(index_file(data_folder));
  }

  void fill() { index->add(load_known_folders(data_folder)); }

  void make_anew(const std::string& reason) {
    index.reset();
    const fs::path file = index_file(data_folder);
    std::error_code error;
    fs::path aside = file;
    aside += ".damaged";
    fs::rename(file, aside, error);
    if (error) throw IoError(file, "is damaged (" + reason + ") and cannot be put aside: " + error.message());
    fs::path journal = file;
    journal += "-journal";
    fs::remove(journal, error);  // of what was put aside
    notices.push_back("The list of cases was damaged (" + reason +
                      ") and is made anew from the cases' folders; nothing in them is lost.");
    try {
      open_index();
      fill();
    } catch (const IndexIsDamaged& damage) {
      throw IoError(file, damage.what());
    }
  }

  // Damage that shows only later is mended the same way, once; where another program has done that meanwhile,
  // its index is taken.
  template <class Work>
  auto on_index(const Work& work) {
    try {
      return work(*index);
    } catch (const IndexIsDamaged& damage) {
      const LibraryTurn turn(data_folder);
      const ino_t now = identity_of(index_file(data_folder));
      now != 0 && now != index_identity ? open_index() : make_anew(damage.what());
    }
    return work(*index);
  }

  // Those of them that are cases and not known yet.
  void add_fresh_of(const std::vector<fs::path>& folders) {
    const auto there = on_index([](const LibraryIndex& i) { return i.folders(); });
    std::vector<fs::path> fresh;
    for (const fs::path& folder : folders)
      if (!there.contains(folder.string()) && is_case_folder(folder)) fresh.push_back(folder);
    if (!fresh.empty()) (void)add(fresh);
  }

  std::size_t add(const std::vector<fs::path>& folders) {
    auto there = on_index([](const LibraryIndex& i) { return i.folders(); });
    std::vector<fs::path> fresh;
    for (const fs::path& folder : folders)
      if (there.insert(folder.string()).second) fresh.push_back(folder);
    if (fresh.empty()) return 0;
    {
      const LibraryTurn turn(data_folder);
      change_known_folders(data_folder, fresh, {}, turn);
    }
    on_index([&](LibraryIndex& i) { i.add(fresh); });
    return fresh.size();
  }
};

Library::Library(fs::path data_folder, SessionReader read_session) : state_(std::make_unique<State>()) {
  state_->data_folder = std::move(data_folder);
  state_->read_session = std::move(read_session);
  state_->open();
}

Library::~Library() = default;

const std::vector<std::string>& Library::notices() const { return state_->notices; }

std::vector<CaseRecord> Library::known() const {
  std::vector<CaseRecord> records;
  for (IndexedCase& one : state_->on_index([](const LibraryIndex& i) { return i.cases(); }))
    if (!one.record.name.empty()) records.push_back(std::move(one.record));
  return records;
}

std::vector<CaseRecord> Library::look(const std::function<bool(std::size_t, std::size_t)>& on_case) {
  state_->add_fresh_of(cases_in(state_->data_folder / "cases"));
  std::vector<IndexedCase> all = state_->on_index([](const LibraryIndex& i) { return i.cases(); });
  std::vector<IndexedCase> changed;
  std::vector<CaseRecord> records;
  bool goes_on = true;
  for (std::size_t i = 0; i < all.size(); ++i) {
    IndexedCase& one = all[i];
    const std::int64_t now = goes_on ? fingerprint_of(one.record.folder) : one.fingerprint;
    if (now == 0) {
      if (goes_on && one.record.is_there) {
        one.record.is_there = false;
        one.fingerprint = 0;
        if (one.record.name.empty()) one.record.name = one.record.folder.stem().string();
        changed.push_back(one);
      }
    } else if (goes_on && now != one.fingerprint) {
      goes_on = !on_case || on_case(i, all.size());
      if (goes_on) {
        // Looked at before it is read: what is written meanwhile is read the next time.
        one = {now, read_case_record(one.record.folder, state_->read_session)};
        // What could not be read may be read the next time, by a newer program or from a disk that is well
        // again: it is not known by what its files look like.
        // One that is being recorded may be cut off without a file that changes.
        const auto may_change = [](const SessionFacts& session) {
          return !session.problem.empty() || session.is_being_recorded;
        };
        if (!one.record.problem.empty() || !one.record.part_problem.empty() ||
            std::ranges::any_of(one.record.sessions, may_change))
          one.fingerprint = 0;
        changed.push_back(one);
      }
    }
    if (!one.record.name.empty()) records.push_back(std::move(one.record));
  }
  state_->on_index([&](LibraryIndex& index) { index.put(changed); });
  return records;
}

std::size_t Library::add(std::span<const fs::path> case_folders) {
  std::vector<fs::path> folders;
  for (const fs::path& folder : case_folders) {
    if (!is_case_folder(folder)) throw InvalidInput(folder, "", "is not a case: it holds no case.json");
    folders.push_back(known_as(folder));
  }
  return state_->add(folders);
}

void Library::add_those_there(std::span<const fs::path> case_folders) {
  std::vector<fs::path> folders;
  for (const fs::path& folder : case_folders)
    if (is_case_folder(folder)) folders.push_back(known_as(folder));
  (void)state_->add(folders);
}

void Library::forget(const fs::path& case_folder) {
  const std::vector<fs::path> folders{known_as(case_folder)};
  const auto there = state_->on_index([](const LibraryIndex& i) { return i.folders(); });
  if (!there.contains(folders.front().string()))
    throw InvalidInput(case_folder, "", "is not in the list of cases");
  {
    const LibraryTurn turn(state_->data_folder);
    change_known_folders(state_->data_folder, {}, folders, turn);
  }
  state_->on_index([&](LibraryIndex& index) { index.forget(folders); });
}

}  // namespace arthronaut::library
