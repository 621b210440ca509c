// Who works on a case: one program at a time. What a second one writes would be lost, or would lose the
// first one's.
//
// A lock is two things. case.lock in the case's folder says who: host, process, user and since when, for
// people and for other hosts. A lock of the kernel on the folder (flock) says whether that program lives: it
// goes with its process, however that ended. So
//
//   nobody holds the kernel's lock, no case.lock                       -> taken
//   ..., case.lock names a process that is gone from this host         -> taken over, and that is said
//   ..., case.lock is of another folder of this host: this is a copy   -> taken, and that is said
//   ..., case.lock names a living process of this host, or another host -> refused
//   somebody holds the kernel's lock                                   -> refused
//
// That the process is gone is told by its number and the time of its start, since numbers come again. A lock
// of another host is taken over only where somebody says that its program is gone
// (LockTaking::FromOtherHost): nobody here can know. A living process of this host never loses its case so,
// nor one that holds the kernel's lock, wherever it runs.
//
// Where the kernel cannot lock folders (some network file systems) case.lock alone counts, and who wants to
// look at it and write it makes case.lock.taking first, which one of several can: the others are refused. It
// is gone a moment later; one that a crash in that moment has left is named in the refusal, to be deleted by
// hand.
//
// Threads: each lock is one thread's at a time. A process that forks keeps the lock in the parent.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

namespace arthronaut::cases {

struct LockHolder {
  std::string host, user;
  long process = 0;
  std::string since_utc;  // ISO 8601
  // "anna on theatre-2 (process 4711) since 2026-01-31 12:00:00", by the clock on the wall
  [[nodiscard]] std::string in_words() const;
};

enum class LockTaking { Free, FromOtherHost };

class CaseLock {
 public:
  CaseLock();  // holds nothing, of no case
  // Takes the case, or says why not: look at is_held(). The folder exists. Mends the folder's privacy
  // (files/private_folder.h) when it is taken and when it is let go, and ends a change of side that was cut
  // off (case_sides.h) when it is taken. Does not throw for what it finds there.
  explicit CaseLock(const std::filesystem::path& case_folder, LockTaking taking = LockTaking::Free);
  ~CaseLock();  // lets go
  CaseLock(CaseLock&&) noexcept;
  CaseLock& operator=(CaseLock&&) noexcept;

  [[nodiscard]] bool is_held() const { return state_ != nullptr; }
  // Why it is not held, as a sentence for the user; empty when it is.
  [[nodiscard]] const std::string& refusal() const { return refusal_; }
  // It is not held for a program of another host, of which nobody here can know whether it lives: it may be
  // taken over.
  [[nodiscard]] bool is_of_other_host() const { return is_of_other_host_; }
  // It is not held, and another program is why: it may become free.
  [[nodiscard]] bool is_held_elsewhere() const { return is_held_elsewhere_; }
  // What the user should know although it is held: that it was taken over, and from whom, or that it is a
  // copy of what was open. Else empty.
  [[nodiscard]] const std::string& notice() const { return notice_; }
  // Since when, in UTC, that other program had it; empty: it was not taken over, or nobody knows.
  [[nodiscard]] const std::string& dead_since_utc() const { return dead_since_utc_; }

 private:
  struct State;
  std::unique_ptr<State> state_;
  std::string refusal_, notice_, dead_since_utc_;
  bool is_held_elsewhere_ = false, is_of_other_host_ = false;
};

// For a program that must write or do nothing. Throws InvalidInput with the refusal.
[[nodiscard]] CaseLock lock_or_refuse(const std::filesystem::path& case_folder);

[[nodiscard]] std::filesystem::path lock_file(const std::filesystem::path& case_folder);

}  // namespace arthronaut::cases
