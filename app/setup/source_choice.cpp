#include "app/setup/source_choice.h"

#include <algorithm>
#include <utility>

#include "app/setup/setup_sources.h"

namespace arthronaut::setup {

namespace {

constexpr const char* kNoneOffered = "No source: connect a camera, or type a path (P)";

bool is_same(const FeedSource& a, const FeedSource& b) {
  return a.name == b.name && a.path == b.path && a.is_simulated == b.is_simulated && a.is_live == b.is_live;
}

}  // namespace

void SourceChoice::offer(std::vector<FeedSource> sources) {
  const std::optional<FeedSource> before =
      chosen_ ? std::optional(std::move(sources_[*chosen_])) : std::nullopt;
  sources_ = std::move(sources);
  const bool is_first = !std::exchange(was_offered_, true);
  if (before) {
    const auto again = std::find_if(sources_.begin(), sources_.end(),
                                    [&](const FeedSource& source) { return is_same(source, *before); });
    if (again == sources_.end()) return refuse("No longer there: " + before->name);
    return choose(static_cast<std::size_t>(again - sources_.begin()));
  }
  if (!is_first) return;
  sources_.empty() ? refuse(kNoneOffered) : choose(0);
}

void SourceChoice::choose_next() {
  if (sources_.empty()) return refuse(kNoneOffered);
  choose(chosen_ ? (*chosen_ + 1) % sources_.size() : 0);
}

bool SourceChoice::choose_path(const std::filesystem::path& path) {
  const std::optional<std::size_t> found = index_of(sources_, path);
  found ? choose(*found) : refuse("No source there: " + path.string());
  return found.has_value();
}

const FeedSource* SourceChoice::chosen() const { return chosen_ ? &sources_[*chosen_] : nullptr; }

std::string SourceChoice::text() const {
  if (!chosen_) return problem_;
  return sources_[*chosen_].name + "  (" + std::to_string(*chosen_ + 1) + " of " +
         std::to_string(sources_.size()) + ")";
}

void SourceChoice::choose(std::size_t index) {
  chosen_ = index;
  problem_.clear();
}

void SourceChoice::refuse(const std::string& problem) {
  chosen_.reset();
  problem_ = problem;
}

}  // namespace arthronaut::setup
