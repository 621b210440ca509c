// From a folder to what the workstation works on.
#pragma once

#include <filesystem>
#include <functional>
#include <future>
#include <memory>
#include <string>

#include "app/case/plan_model.h"

namespace arthronaut::open_case {

struct OpenedCase {
  std::filesystem::path folder;
  std::unique_ptr<PlanModel> model;
};

// Where the built-in case lives: $XDG_DATA_HOME/arthronaut/Phantom.arthro, else ~/.local/share/..., so that
// what a user changes in it stays.
[[nodiscard]] std::filesystem::path built_in_case_folder();

// Loads the case and makes its bones ready, which takes seconds: for a job. An empty path is the built-in
// case, made anew when it is not there. Throws IoError or InvalidInput.
[[nodiscard]] OpenedCase open_folder(const std::filesystem::path& folder);

// The one case of a window: being opened on a thread of its own, then open for good, or refused with a
// reason.
class CaseOpening {
 public:
  // Opens the folder, see open_case(). on_end is called from the other thread when that is done, well or not.
  CaseOpening(const std::filesystem::path& folder, std::function<void()> on_end);
  ~CaseOpening();  // waits for the end

  // Takes over what the thread has made, without waiting; true once, when the case has become open just now.
  bool take();
  [[nodiscard]] bool is_busy() const { return opening_.valid(); }
  // Null until it is open.
  [[nodiscard]] PlanModel* model() const { return open_.model.get(); }
  [[nodiscard]] const std::filesystem::path& folder() const { return open_.folder; }  // empty until then
  [[nodiscard]] const std::string& failure() const { return failure_; }  // why it can't be opened; empty else

 private:
  std::future<OpenedCase> opening_;
  OpenedCase open_;
  std::string failure_;
};

}  // namespace arthronaut::open_case
