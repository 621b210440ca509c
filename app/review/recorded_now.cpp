// Review of a session that is being recorded, by this program or another one: it is not taken for one that
// was cut off, and is read again once it has ended.
#include <algorithm>

#include "app/review/review_view.h"
#include "app/widgets/list_rows.h"
#include "navigation/recording/cut_short.h"
#include "navigation/recording/recording_lock.h"

namespace arthronaut::review {

namespace {

constexpr double kLook_s = 0.5;

// New sessions come before it.
std::optional<std::size_t> place_of(const std::filesystem::path& folder,
                                    const std::vector<std::filesystem::path>& folders) {
  const auto found = std::find(folders.begin(), folders.end(), folder);
  if (found == folders.end()) return std::nullopt;
  return static_cast<std::size_t>(found - folders.begin());
}

}  // namespace

void ReviewView::follow_recording(double now_s) {
  if (now_s < looked_at_end_s_ + kLook_s) return;
  looked_at_end_s_ = now_s;
  if (!sessions_.is_busy() && sessions_.has_one_ended()) {
    sessions_.read();
    if (open_) chosen_ = place_of(open_->review.folder, sessions_.folders());
  }
  // What somebody is writing is not taken away.
  if (!open_ || !chosen_ || !open_->review.session->goes_on() || note_.is_open) return;
  if (recording::is_being_recorded(open_->review.folder)) return;
  const std::optional<std::int64_t> at = has_frames() ? std::optional(open_->glance().index) : std::nullopt;
  choose(*chosen_);
  comes_back_to_ = at;
}

void ReviewView::draw_end(const widgets::Ui& ui) const {
  const recording::SessionOverview& session = *open_->review.session;
  const bool has_end = session.was_finished || !session.end_was_read || session.goes_on();
  const std::string cut = recording::cut_short_in_words(has_end, session.events);
  if (session.goes_on())
    widgets::status_row(ui, widgets::Severity::Quiet, "Being recorded",
                        "shown up to when it was opened; read again when it ends");
  if (!cut.empty()) widgets::status_row(ui, widgets::Severity::Caution, "Cut short", cut);
  ui.log.note_state("cut_short", cut);
  ui.log.note_state("being_recorded", session.goes_on() ? "yes" : "no");
}

}  // namespace arthronaut::review
