#include "planning/cases/case_lock.h"

#include <fcntl.h>
#include <pwd.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>
#include <utility>

#include "planning/cases/case_sides.h"
#include "planning/files/atomic_file.h"
#include "planning/files/json_document.h"
#include "planning/files/local_time.h"
#include "planning/files/private_folder.h"
#include "planning/files/running_process.h"
#include "planning/files/utc_clock.h"
#include "planning/geometry/error.h"

namespace arthronaut::cases {

namespace {

namespace fs = std::filesystem;
constexpr std::string_view kLockFormat = "arthronaut.lock";
constexpr int kLockVersion = 1;

std::string host_name() {
  std::array<char, 256> name{};
  return ::gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "unknown host";
}

std::string user_name() {
  const passwd* user = ::getpwuid(::geteuid());
  return user != nullptr ? user->pw_name : "user " + std::to_string(::geteuid());
}

struct ProcessState {
  bool is_over = false;  // killed, and not yet buried by its parent
  // When it began, in the kernel's ticks since the machine's start, with which start that was: tells it from
  // a later process of the same number. Empty where the kernel does not show it.
  std::string start;
};

ProcessState state_of(long process) {
  std::ifstream stream("/proc/" + std::to_string(process) + "/stat");
  std::string line;
  std::getline(stream, line);
  // The name may hold spaces and brackets; after its last bracket come the state (3) and on to the start
  // (22).
  const auto name_end = line.rfind(')');
  if (name_end == std::string::npos) return {};
  std::istringstream fields(line.substr(name_end + 1));
  ProcessState state;
  std::string field, boot;
  for (int number = 3; number <= 22 && fields >> field; ++number) {
    if (number == 3) state.is_over = field == "Z" || field == "X";
  }
  std::ifstream boots("/proc/sys/kernel/random/boot_id");
  std::getline(boots, boot);
  if (fields) state.start = field + "@" + boot;
  return state;
}

struct LockFile {
  LockHolder holder;
  std::string start;            // see ProcessState
  std::int64_t folder_inode{};  // of the folder that it locks; 0: not said
};

std::int64_t inode_of(const fs::path& folder) {
  struct stat status {};
  return ::stat(folder.c_str(), &status) == 0 ? static_cast<std::int64_t>(status.st_ino) : 0;
}

// Nothing when there is none. A broken one names nobody.
std::optional<LockFile> read_lock(const fs::path& file) {
  if (std::error_code error; !fs::exists(file, error)) return std::nullopt;
  try {
    const auto root = files::read_json(file, kLockFormat, kLockVersion);
    LockFile lock{{root.text("host"), root.text("user"), static_cast<long>(root.integer("process")),
                   root.text("since_utc")},
                  root.has("process_start") ? root.text("process_start") : "",
                  root.has("folder_inode") ? root.integer("folder_inode") : 0};
    return lock;
  } catch (const InvalidInput&) {
    return LockFile{};
  }
}

void write_lock(const fs::path& file, const LockFile& lock) {
  files::write_json(file, {{"format", kLockFormat},
                           {"version", kLockVersion},
                           {"host", lock.holder.host},
                           {"process", lock.holder.process},
                           {"process_start", lock.start},
                           {"folder_inode", lock.folder_inode},
                           {"user", lock.holder.user},
                           {"since_utc", lock.holder.since_utc}});
}

bool is_same(const LockFile& a, const LockFile& b) {
  return a.holder.host == b.holder.host && a.holder.process == b.holder.process && a.start == b.start &&
         a.holder.since_utc == b.holder.since_utc;
}

bool lives_here(const LockFile& lock) {
  if (!files::is_running(static_cast<pid_t>(lock.holder.process))) return false;
  const ProcessState now = state_of(lock.holder.process);
  const bool is_another = !lock.start.empty() && !now.start.empty() && lock.start != now.start;
  return !now.is_over && !is_another;
}

// A folder that is no case, opened by a slip, keeps its rights.
void make_case_private(const fs::path& folder) {
  if (std::error_code error; fs::exists(folder / "case.json", error)) files::make_private(folder);
}

// Ends what was cut off; why it cannot, as on a full disk: what was done in such a case would be lost to it
// later. A file that is broken is told by whoever reads it.
std::string cut_off_remains(const fs::path& folder) {
  try {
    (void)finish_side_change(folder);
  } catch (const InvalidInput&) {
  } catch (const std::runtime_error& error) {
    return std::string("a change of its side was cut off and cannot be ended: ") + error.what();
  }
  return "";
}

// A case that was copied while it was open brings the original's lock along. Another host may number the
// folders of a shared drive in its own way: there it tells nothing.
bool is_of_a_copy(const LockFile& lock, const fs::path& file) {
  return lock.folder_inode != 0 && lock.holder.host == host_name() &&
         lock.folder_inode != inode_of(file.parent_path());
}

// Why the lock on file stands in the way; empty when it does not.
std::string obstacle(const LockFile& lock, const fs::path& file, bool kernel_locks) {
  if (lock.holder.process == 0) return "";  // broken: nobody can be asked
  if (lock.holder.host != host_name()) {
    return "is open elsewhere: " + lock.holder.in_words() +
           ". If that program is gone, or this folder is a copy of its case, take it over: hold Ctrl+T in "
           "the window, or \"arthronaut cases --take-over '" +
           file.parent_path().string() + "'\"";
  }
  // Where the kernel locks no folders, as on some mounts, neither are the folders' numbers to be relied on.
  if (kernel_locks && is_of_a_copy(lock, file)) return "";
  return lives_here(lock) ? "is open elsewhere: " + lock.holder.in_words() : "";
}

// The kernel's lock on a folder.
struct FolderLock {
  int descriptor = -1;  // -1: somebody holds it, or the folder cannot be opened
  bool is_taken = false;
  bool is_known = true;  // false: the file system has no such locks
};

FolderLock lock_folder(const fs::path& folder) {
  FolderLock lock;
  lock.descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (lock.descriptor < 0 || ::flock(lock.descriptor, LOCK_EX | LOCK_NB) == 0) return lock;
  lock.is_taken = errno == EWOULDBLOCK;
  lock.is_known = lock.is_taken;
  if (lock.is_taken) ::close(std::exchange(lock.descriptor, -1));
  return lock;
}

// Where the kernel locks no folders: who has made this file alone looks at case.lock and writes it. Making it
// is one step on every file system, a look followed by a write is not.
class Turn {
 public:
  explicit Turn(fs::path file)
      : file_(std::move(file)), descriptor_(::open(file_.c_str(), O_CREAT | O_EXCL | O_CLOEXEC, 0600)) {
    if (descriptor_ >= 0) return;
    refusal_ = errno == EEXIST
                   ? "is being opened by another program. If there is none, delete " + file_.string()
                   : "cannot be opened for writing";
  }
  ~Turn() {
    if (descriptor_ < 0) return;
    ::close(descriptor_);
    ::unlink(file_.c_str());
  }
  Turn(const Turn&) = delete;
  Turn& operator=(const Turn&) = delete;
  [[nodiscard]] const std::string& refusal() const { return refusal_; }  // empty: it is ours

 private:
  fs::path file_;
  int descriptor_;
  std::string refusal_;
};

}  // namespace

std::string LockHolder::in_words() const {
  return user + " on " + host + " (process " + std::to_string(process) + ") since " +
         files::local_time_in_words(since_utc);
}

struct CaseLock::State {
  State(fs::path in, int with_descriptor, LockFile with_lock)
      : folder(std::move(in)), descriptor(with_descriptor), lock(std::move(with_lock)) {}
  ~State() {
    // A child of fork() has a copy of this, not the lock.
    if (lock.holder.process == ::getpid()) {
      try {
        // Somebody may have deleted the file by hand and taken the case since.
        const auto there = read_lock(lock_file(folder));
        std::error_code ignored;
        if (there && is_same(*there, lock)) fs::remove(lock_file(folder), ignored);
      } catch (const std::exception&) {
        // It stays, as after a crash, and is taken over.
      }
      make_case_private(folder);
    }
    ::close(descriptor);
  }
  State(const State&) = delete;
  State& operator=(const State&) = delete;

  fs::path folder;
  int descriptor;
  LockFile lock;
};

CaseLock::CaseLock(const fs::path& case_folder, LockTaking taking) {
  const fs::path file = lock_file(case_folder);
  const FolderLock kernel = lock_folder(case_folder);
  if (kernel.descriptor < 0) {
    // Between the kernel's lock and the file there is a moment in which the holder is not known.
    std::optional<LockFile> lock;
    try {
      lock = read_lock(file);
    } catch (const IoError&) {
    }
    refusal_ = !kernel.is_taken                   ? "cannot be opened for writing"
               : lock && lock->holder.process > 0 ? "is open elsewhere: " + lock->holder.in_words()
                                                  : "is open in another program";
    is_held_elsewhere_ = kernel.is_taken;
    return;
  }
  std::optional<Turn> turn;
  if (!kernel.is_known) turn.emplace(fs::path(file) += ".taking");
  try {
    const auto before = read_lock(file);
    is_of_other_host_ = before && before->holder.process != 0 && before->holder.host != host_name();
    const bool is_taken_over = is_of_other_host_ && taking == LockTaking::FromOtherHost;
    if (before && !is_taken_over) refusal_ = obstacle(*before, file, kernel.is_known);
    if (refusal_.empty() && turn) refusal_ = turn->refusal();
    if (refusal_.empty()) {
      make_case_private(case_folder);
      LockFile mine{{host_name(), user_name(), ::getpid(), files::utc_now()},
                    state_of(::getpid()).start,
                    inode_of(case_folder)};
      write_lock(file, mine);
      // Where the kernel's locks end at this machine another one may have come so far; the later file counts.
      const auto there = read_lock(file);
      if (there && is_same(*there, mine)) {
        auto state = std::make_unique<State>(case_folder, kernel.descriptor, std::move(mine));
        if (!(refusal_ = cut_off_remains(case_folder)).empty()) return;
        state_ = std::move(state);
        is_of_other_host_ = false;
        if (before && is_of_a_copy(*before, file) && lives_here(*before)) {
          notice_ = "A copy of a case that was open: " + before->holder.in_words();
        } else if (is_taken_over) {
          dead_since_utc_ = before->holder.since_utc;
          notice_ = "Taken over from " + before->holder.in_words() + ", as somebody said that it is gone";
        } else if (before) {
          dead_since_utc_ = before->holder.since_utc;
          notice_ = before->holder.process > 0
                        ? "Taken over from " + before->holder.in_words() + ", which ended without closing it"
                        : "Taken over from a program that ended without closing it";
        }
        return;
      }
      refusal_ = "is open in another program";
    }
    is_held_elsewhere_ = true;
  } catch (const std::runtime_error& error) {  // a folder that can only be read
    refusal_ = std::string("cannot be written: ") + error.what();
  }
  ::close(kernel.descriptor);
}

CaseLock::CaseLock() = default;
CaseLock::~CaseLock() = default;
CaseLock::CaseLock(CaseLock&&) noexcept = default;
CaseLock& CaseLock::operator=(CaseLock&&) noexcept = default;

CaseLock lock_or_refuse(const fs::path& case_folder) {
  if (!fs::is_directory(case_folder)) throw IoError(case_folder, "is not a case folder");
  CaseLock lock(case_folder);
  if (!lock.is_held()) throw InvalidInput(case_folder, "", lock.refusal());
  return lock;
}

fs::path lock_file(const fs::path& case_folder) { return case_folder / "case.lock"; }

}  // namespace arthronaut::cases
