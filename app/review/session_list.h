// The sessions of the case, newest first, each with what it was: its source and bone, how far it came, how
// long it took and what is doubtful of it. The names stand at once; the rest is read beside the screen.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "app/widgets/controls.h"
#include "navigation/recording/session_check.h"
#include "navigation/worker/awaited.h"
#include "planning/library/case_record.h"

namespace arthronaut::review {

// "0007-20261121-122356" as "7:  2026-11-21  12:23:56", by the clock on the wall; of older sessions, without
// a number, the date; other names as they are.
[[nodiscard]] std::string session_title(const std::string& folder_name);
// What it was: "simulation, femur, 5.2 min; drilled, 1.2 mm and 0.8° from the plan; not verified".
struct SessionLine {
  widgets::Severity severity = widgets::Severity::Quiet;  // Caution: in doubt; Bad: it cannot be read
  std::string words;
  bool is_being_recorded = false;  // when it was read
};
// A session that was recorded as of the other side than the case's says so; no side: not known.
[[nodiscard]] SessionLine session_line(const library::SessionFacts& facts,
                                       std::optional<bones::Side> case_side = {});
// Of one that was looked through by its hashes: what is no longer what was recorded comes first.
[[nodiscard]] SessionLine with_check(SessionLine line, const recording::SessionCheck& check);

class SessionList {
 public:
  explicit SessionList(std::function<void()> wake) : wake_(std::move(wake)) {}

  // Of another case, of that side: nothing is listed yet.
  void open(const std::filesystem::path& case_folder, bones::Side case_side);
  // As the folders are now. Throws std::filesystem::filesystem_error.
  void read();
  [[nodiscard]] const std::vector<std::filesystem::path>& folders() const { return folders_; }
  // A reason that names files of these sessions, with their names alone: the folder stands in the list.
  [[nodiscard]] std::string within(std::string reason) const;
  // What looking through one of them by its hashes has found.
  void take_check(const std::filesystem::path& session_folder, const recording::SessionCheck& check);
  [[nodiscard]] bool is_busy() const { return reading_.is_busy(); }
  // One that was being recorded when it was read is not any more: its line is of before.
  [[nodiscard]] bool has_one_ended() const;
  // The one that was pressed.
  [[nodiscard]] std::optional<std::size_t> draw(const widgets::Ui& ui, std::optional<std::size_t> chosen);

 private:
  using Lines = std::map<std::filesystem::path, SessionLine>;
  void take_read();
  [[nodiscard]] SessionLine line_of(std::size_t session) const;

  std::function<void()> wake_;
  std::filesystem::path case_folder_;
  std::optional<bones::Side> case_side_;
  std::vector<std::filesystem::path> folders_;
  worker::Awaited<Lines> reading_;
  bool reads_again_ = false;  // what is being read is of before
  Lines lines_;
  std::map<std::filesystem::path, recording::SessionCheck> broken_;
  std::optional<std::size_t> in_view_;  // the chosen one that was last brought into view
};

}  // namespace arthronaut::review
