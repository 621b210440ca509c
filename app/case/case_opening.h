// From a folder to what the workstation works on.
#pragma once

#include <atomic>
#include <chrono>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>

#include "app/case/plan_model.h"
#include "navigation/worker/awaited.h"
#include "planning/cases/case_lock.h"
#include "planning/cases/identity.h"

namespace arthronaut::open_case {

struct OpenedCase {
  std::filesystem::path folder;
  cases::CaseLock lock;  // not held: the case is read-only, for the reason that the lock says
  std::unique_ptr<PlanModel> model;
  // Instead of a model: a case of images alone, whose bones are still to be painted.
  std::optional<cases::Case> unpainted;
  std::optional<cases::Identity> identity;
};

// Where the built-in case lives: $XDG_DATA_HOME/arthronaut/Phantom.arthro, else ~/.local/share/..., so that
// what a user changes in it stays.
[[nodiscard]] std::filesystem::path built_in_case_folder();

// Takes the case (cases::CaseLock), loads it and makes its bones ready, which takes seconds: for a job. A
// case that another program has open, or that cannot be written, is loaded all the same. An empty path is the
// built-in case, made anew when it is not there. Throws IoError or InvalidInput, also once `stop` asks for
// it. tell: from any thread, which share is done, 0 to 1.
[[nodiscard]] OpenedCase open_folder(const std::filesystem::path& folder, const std::stop_token& stop = {},
                                     const std::function<void(double done)>& tell = nullptr);

// The one case of a window: being opened on a thread of its own, then open for good, or refused with a
// reason. While it is open it is this program's to write, or read-only. It is read-only no longer once it is
// opened anew after take_when_free(): the other program may have changed what was read here.
class CaseOpening {
 public:
  using Clock = std::chrono::steady_clock;
  // Opens the folder, see open_folder(). on_end is called from the other thread when that is done, well or
  // not; it is asked to end early when this goes, and waited for.
  CaseOpening(const std::filesystem::path& folder, std::function<void()> on_end);
  // The same case once more, since its bones are others now, or another was looked at meanwhile: the lock
  // that `before` has goes over, and back again by keep_lock() when it cannot be opened.
  CaseOpening(CaseOpening& before, std::function<void()> on_end);
  void keep_lock(CaseOpening& from) { open_.lock = std::move(from.open_.lock); }
  ~CaseOpening() { stop_.request_stop(); }
  CaseOpening(const CaseOpening&) = delete;
  CaseOpening& operator=(const CaseOpening&) = delete;

  // Of a case that is read-only because another program has it: whether that one is gone, however it ended.
  // The lock is taken then, and whoever asks opens the case anew with it. Asks the disk.
  [[nodiscard]] bool take_when_free();

  // Of a case that is read-only because a program of another machine has it: somebody says that that one is
  // gone. As take_when_free(); false where it is not to be had after all, and read_only_reason() says why.
  [[nodiscard]] bool take_over();
  [[nodiscard]] bool is_of_other_host() const { return open_.lock.is_of_other_host(); }

  // Nothing is written any more: whoever opens the case next has it, though this one takes a while to go.
  void release_lock() { open_.lock = {}; }

  // Takes over what the thread has made, without waiting; true once, when the case has become open just now.
  bool take();
  [[nodiscard]] bool is_busy() const { return opening_.is_busy(); }
  // 0 to 1, and never back.
  [[nodiscard]] double done_fraction() const { return done_; }
  // Busy: it ends as soon as it can, and no case becomes open, nor is there a failure. The lock of a case
  // that was open before goes back by keep_lock().
  void cancel() { stop_.request_stop(); }
  [[nodiscard]] bool is_cancelled() const { return stop_.stop_requested(); }
  // Null until it is open, and in a case whose bones are still to be painted.
  [[nodiscard]] PlanModel* model() const { return open_.model.get(); }
  // That case; null where there are bones.
  [[nodiscard]] const cases::Case* unpainted() const { return open_.unpainted ? &*open_.unpainted : nullptr; }
  [[nodiscard]] const std::filesystem::path& folder() const { return open_.folder; }  // empty until then
  [[nodiscard]] const std::string& failure() const { return failure_; }  // why it can't be opened; empty else

  // These are of the open case. Nothing may be written into a case that is read-only: no plan, no set-up, no
  // session.
  [[nodiscard]] bool is_read_only() const { return !read_only_reason().empty(); }
  // "is open elsewhere: anna on theatre-2 (process 4711) since ..."; empty when it may be written.
  [[nodiscard]] const std::string& read_only_reason() const { return open_.lock.refusal(); }
  // Since when the program had it that ended last without closing it, in UTC; empty: none did.
  [[nodiscard]] const std::string& left_by_crash_since() const { return open_.lock.dead_since_utc(); }
  // That it was taken over from a program that had died: news for a minute after it was opened; else empty.
  [[nodiscard]] std::string notice(Clock::time_point now = Clock::now()) const {
    return now - locked_at_ < std::chrono::minutes(1) ? open_.lock.notice() : "";
  }
  // Whose knee it is; nothing where that is not known.
  [[nodiscard]] const std::optional<cases::Identity>& identity() const { return open_.identity; }

 private:
  void note_done(double done);  // any thread

  OpenedCase open_;
  std::atomic<double> done_ = 0;
  Clock::time_point locked_at_;
  std::string failure_;
  std::stop_source stop_;
  worker::Awaited<OpenedCase> opening_;  // last: ends first
};

}  // namespace arthronaut::open_case
