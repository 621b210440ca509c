// Which of the offered sources a step of Set up works on. A source is known by what it is and not by its
// place in the list: when it is gone, or a path leads to none, nothing is chosen and the problem says why.
// Another source, least of all the simulator, never takes its place unasked.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/setup/frame_feed.h"

namespace arthronaut::setup {

class SourceChoice {
 public:
  // What there is now. The first time the first one is chosen; later what was chosen stays.
  void offer(std::vector<FeedSource> sources);
  void choose_next();  // in turn; the first one when nothing is chosen
  // The one made from this path; false: there is none, and nothing is chosen.
  bool choose_path(const std::filesystem::path& path);

  void choose(std::size_t index);  // of offered()
  // Nothing is chosen, and why.
  void refuse(const std::string& problem);

  [[nodiscard]] const std::vector<FeedSource>& offered() const { return sources_; }
  [[nodiscard]] const FeedSource* chosen() const;  // null: nothing
  // Why nothing is chosen; empty else.
  [[nodiscard]] const std::string& problem() const { return problem_; }
  // "Simulated arthroscope  (1 of 3)", or the problem.
  [[nodiscard]] std::string text() const;

 private:
  std::vector<FeedSource> sources_;
  std::optional<std::size_t> chosen_;
  bool was_offered_ = false;
  std::string problem_;
};

}  // namespace arthronaut::setup
