// Looks through the sessions of a case for what was done before, beside the screen: which tunnels are
// drilled, and an operation that was left in the middle, which it keeps until the surgeon has answered. A
// program that was killed lets go of its record no sooner than of its memory, on a busy machine many seconds
// later: what is found as being recorded is looked at again once it is not.
//
// One thread, the window's; nothing here waits but the destructor, for the search at hand.
#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "app/case/plan_model.h"
#include "navigation/recording/drilled_before.h"
#include "navigation/recording/resumable.h"
#include "navigation/worker/worker.h"

namespace arthronaut::navigate {

struct LeftBehind {
  recording::Resumable found;
  std::vector<std::string> passed_over;  // newer sessions that cannot be read, with the reason each
  // What it was navigated with is what the case has now.
  bool has_same_camera = false, has_same_tools = false;
};

class ResumeOffer {
 public:
  // wake: called from another thread when there is news.
  explicit ResumeOffer(std::function<void()> wake);

  // Another case. Nothing is offered in one that is read-only: what is left there may be going on elsewhere.
  // crashed_since: since when the program had it that ended last without closing it, in UTC; empty: none did.
  void open(const open_case::PlanModel& model, const std::filesystem::path& case_folder, bool is_read_only,
            const std::string& crashed_since);
  // Which tunnels its records say are drilled, also of a case that is read-only; once for every search that
  // has ended, null else.
  [[nodiscard]] std::shared_ptr<const recording::DrilledBefore> take_drilled();
  // Null: there is none, it is still looked for, or it was answered.
  [[nodiscard]] const LeftBehind* of(bones::BoneKind bone);
  [[nodiscard]] bool is_looking();
  // The bone whose operation was cut off last, by a crash that is so short ago that the patient may still lie
  // there, and that is on offer; empty: none. What was left by closing the window is no crash.
  [[nodiscard]] std::optional<bones::BoneKind> cut_off(std::chrono::system_clock::time_point now);
  // Resumed, or begun without it: it is not offered again while this case is open.
  void answer(bones::BoneKind bone) { answered_.insert(bone); }
  // That is kept with the session: no later opening offers it, until it is taken back there. Throws IoError
  // where it cannot be kept; it is not offered again while this case is open all the same.
  void decline(bones::BoneKind bone);
  // Offers what was declined, and is not any more by what is kept.
  void look_again();

 private:
  struct Search {
    int number = 0;
    std::filesystem::path case_folder;
    bool is_read_only = false;
    std::map<bones::BoneKind, geometry::TriangleMesh> meshes;
    cases::Plan plan;
  };
  struct Found {
    int number = 0;
    std::map<bones::BoneKind, LeftBehind> left;
    std::shared_ptr<const recording::DrilledBefore> drilled;  // null: the case's folder cannot be read
  };
  using Worker = worker::Worker<Search, Found>;
  static void work(Worker::Inbox& inbox);
  static Found search(const Search& search);
  static std::shared_ptr<const recording::DrilledBefore> search_drilled(const Search& search);
  static std::optional<LeftBehind> search_bone(const Search& search, bones::BoneKind kind,
                                               const geometry::TriangleMesh& mesh);
  // Of what is not being recorded any more since, as it was left.
  static Found look_at_ended(const Search& search, Found found);
  void follow();

  int number_ = 0;  // of the newest search
  bool is_looking_ = false;
  std::string crashed_since_;
  std::shared_ptr<const Found> followed_;
  std::shared_ptr<const recording::DrilledBefore> drilled_;  // null: taken, or not found yet
  std::map<bones::BoneKind, LeftBehind> left_;
  std::set<bones::BoneKind> answered_;
  Worker worker_;
};

}  // namespace arthronaut::navigate
