#include "app/review/review_view.h"

#include <GLFW/glfw3.h>

#include <algorithm>
#include <utility>

#include "app/widgets/list_rows.h"
#include "navigation/recording/case_sessions.h"
#include "navigation/worker/freed_memory.h"
#include "planning/cases/case.h"
#include "planning/cases/plan_file.h"
#include "planning/geometry/error.h"

namespace arthronaut::review {

namespace {

const char* no_frames_words(const SessionReview& review) {
  return review.problems.empty()
             ? (review.moments.empty() ? "No frame was recorded in this session."
                                       : "No frame was recorded in this session. What happened stands on "
                                         "the left.")
             : "The frames of this session cannot be read. What is wrong stands on the left.";
}

// A video that is the source's own has a picture of every frame.
bool was_kept(const recording::SessionOverview& session, std::int64_t frame) {
  const auto& kept = session.pictures;
  return kept.empty() || std::any_of(kept.begin(), kept.end(),
                                     [frame](const auto& picture) { return picture.frame == frame; });
}

}  // namespace

void let_go(std::unique_ptr<OpenSession> session, worker::LettingGo& letting_go) {
  if (session != nullptr && session->today != nullptr) session->today->stop();
  letting_go.take(std::move(session));
}

ReviewView::ReviewView(std::function<void()> make_current, std::function<void()> wake,
                       std::function<void(bones::BoneKind)> to_theatre)
    : wake_(std::move(wake)),
      to_theatre_(std::move(to_theatre)),
      pane_(make_current),
      sessions_(wake_),
      postop_(make_current, wake_) {}

mode::ModeTitle ReviewView::title() const {
  return {"review", "mode.review", "Review", "What happened", GLFW_KEY_F3};
}

std::optional<sources::SourceKind> ReviewView::source_kind() const {
  // A CT is nobody's recording.
  return has_frames() && !shows_postop_ ? std::optional(sources::SourceKind::Recording) : std::nullopt;
}

void ReviewView::case_opened(const mode::OpenCase& opened) {
  model_ = opened.model;
  case_folder_ = opened.folder;
  read_only_ = opened.read_only;
  sessions_.open(case_folder_, model_->knee().side);
  chosen_.reset();
  let_go(std::move(open_), letting_go_);
  todays_.clear();
  letting_go_.take(std::move(report_));
  no_report_.clear();
  opens_for_another_case_ = opening_.is_busy();
  note_ = {};
  notice_.clear();
  shows_postop_ = false;
  postop_.open(model_, case_folder_, read_only_);
}

void ReviewView::enter() {
  worker::give_freed_memory_back();  // of what was shown before: here are two hours, and pictures
  sessions_.read();
  const auto& folders = sessions_.folders();
  if (folders.empty()) {
    shows_postop_ = shows_postop_ || !postop_.is_blank();  // all that there is to look at
    return;
  }
  // What was chosen keeps its place in the list as new sessions come.
  const auto same = open_ ? std::find(folders.begin(), folders.end(), open_->review.folder) : folders.end();
  if (same == folders.end()) return choose(0);
  chosen_ = static_cast<std::size_t>(same - folders.begin());
  open_->can_be_resumed = can_be_resumed();  // maybe it was declined just now, in Navigate
}

void ReviewView::choose(std::size_t session) {
  if (session >= sessions_.folders().size() || opening_.is_busy()) return;
  chosen_ = session;
  comes_back_to_.reset();
  no_report_.clear();
  // What was computed is there when one comes back; of a record that grew meanwhile it is not all.
  if (open_ && open_->today && open_->today->has_ended() && !open_->review.session->goes_on())
    todays_[open_->review.folder] = std::move(open_->today);
  let_go(std::move(open_), letting_go_);
  note_ = {};
  notice_.clear();
  opening_.start([folder = sessions_.folders()[session]] { return read_review(folder); }, wake_);
}

void ReviewView::look_at(std::size_t session) {
  shows_postop_ = false;
  if (!open_ || chosen_ != session) choose(session);
}

void ReviewView::take_opened() {
  if (!opening_.is_ready()) return;
  if (std::exchange(opens_for_another_case_, false)) {
    opening_.drop();  // a session of the case before says nothing here
    return choose(0);
  }
  try {  // the top of the job
    SessionReview review = opening_.take();
    open_ = std::make_unique<OpenSession>();
    open_->review = std::move(review);
  } catch (const std::exception& error) {
    notice_ = error.what();
    return;
  }
  worker::give_freed_memory_back();
  OpenSession& open = *open_;
  laid_.reset();
  open.marks = MarkBook(open.review.folder, read_only_);
  open.check = std::make_unique<CheckRun>(open.review.folder, wake_);
  open.can_be_resumed = can_be_resumed();
  if (auto kept = todays_.extract(open.review.folder); !kept.empty()) open.today = std::move(kept.mapped());
  find_score();
  if (!has_frames()) return;
  // Where the user most wants to look first: the last moment with guidance.
  const auto& frames = open.timeline().frames();
  open.playback.frame = frames.size() - 1;
  for (std::size_t i = frames.size(); i-- > 0;)
    if (frames[i].is_guided()) {
      open.playback.frame = i;
      break;
    }
  if (comes_back_to_) open.playback.frame = open.timeline().at_index(*comes_back_to_);
  if (!open.review.session->video().empty())
    open.pictures = std::make_unique<PictureFetcher>(open.review, wake_);
  look_at_tunnel();
}

void ReviewView::look_at_tunnel() {
  const bones::BoneKind bone = open_->review.session->header.bone;
  if (!model_->has_bone(bone)) return;
  if (shows_strokes_alone()) {
    const auto& curves = open_->review.session->curves;
    geometry::Bounds drawn{curves.front().position_mm, curves.front().position_mm};
    for (const strokes::CurvePoint& point : curves) {
      drawn.min_mm = drawn.min_mm.cwiseMin(point.position_mm);
      drawn.max_mm = drawn.max_mm.cwiseMax(point.position_mm);
    }
    return pane_.look(scene::look_along(Eigen::Vector3d(0.4, 0.5, -0.77).normalized(), drawn.center_mm(),
                                        std::max(3 * drawn.size_mm().norm(), 60.0), {0, 1, 0}));
  }
  // Of another surface's plan nobody knows where it lies in this one.
  const std::optional<tunnels::Tunnel> tunnel =
      is_of_another_surface() ? std::nullopt : open_->standing().plan.plan;
  const geometry::Bounds bounds = model_->bounds(bone);
  pane_.look(tunnel ? scene::orbited(
                          scene::look_along(tunnel->direction.normalized(), tunnel->entry_mm, 190, {0, 0, 1}),
                          {40, -30}, 600)
                    : scene::look_from(scene::ViewDirection::Anterior, model_->knee().side, bounds, 1));
}

bool ReviewView::has_frames() const { return open_ && !open_->timeline().frames().empty(); }

bool ReviewView::runs_today() const { return open_ && open_->today && !open_->today->has_ended(); }

bool ReviewView::is_busy() const {
  return opening_.is_busy() || sessions_.is_busy() || runs_today() || has_running_work() ||
         (open_ && open_->playback.plays);
}

ReviewScreen ReviewView::screen() const {
  return {open_->review,
          open_->marks.marks(),
          open_->playback,
          open_->today ? open_->today->progress().result.get() : nullptr,
          open_->score ? &*open_->score : nullptr,
          &postop_.comparisons()};
}

void ReviewView::draw(const widgets::Ui& ui, const widgets::Rect& area) {
  take_opened();
  follow_recording(ui.now_s);
  if (has_frames()) advance(open_->playback, open_->timeline(), ui.now_s);
  const float gap = ui.theme.px(12);
  widgets::Rect rest = area;
  draw_side(ui, rest.cut_left(ui.theme.px(380), gap));
  ui.log.note_state("session", open_                ? open_->review.folder.filename().string()
                               : opening_.is_busy() ? "opening"
                                                    : "none");
  ui.log.note_state("review_page", shows_postop_ ? "achieved" : "session");
  if (shows_postop_) return postop_.draw(ui, rest);
  if (!has_frames()) {
    const std::string text =
        sessions_.folders().empty()
            ? "No session yet. Record one in Navigate, compare a CT after the operation (P), or write the "
              "report of the plan (R)."
        : opening_.is_busy() ? "Opening the session"
        : !notice_.empty()   ? "This session cannot be read.\n" + sessions_.within(notice_)
        : open_              ? no_frames_words(open_->review)
                             : "Choose a session.";
    widgets::text_centered(ui, rest, ui.theme.title, widgets::kQuietText, text);
    return;
  }
  draw_origin(ui, rest.cut_top(ui.theme.px(58), gap), open_->review.session->header);
  // The numbers first: what was achieved stands below the moment's, and is to be read without scrolling.
  const widgets::Rect numbers = rest.cut_right(ui.theme.px(430), gap);
  const widgets::Rect line = rest.cut_bottom(ui.theme.px(300), gap);
  // What moves along the time line stands above it.
  widgets::draw_buttons(ui, rest.cut_bottom(ui.theme.px(48), ui.theme.px(8)),
                        {"review.play", "review.loop", "review.slower", "review.faster",
                         "review.event_before", "review.event_after"});
  const widgets::Rect picture = rest.cut_left((rest.width - gap) / 2, gap);
  draw_picture(ui, picture);
  draw_scene(ui, rest);
  draw_numbers(ui, numbers);
  if (const auto wanted = draw_time_line(ui, line, screen(), open_->zoom))
    go_to(open_->playback, open_->timeline(), *wanted);
  ui.log.note_state("frame", std::to_string(open_->playback.frame));
  ui.log.note_state("speed", speed_text(open_->playback));
  ui.log.note_state("loop", open_->playback.loops() ? "on" : open_->playback.from ? "begun" : "off");
  ui.log.note_state("marks", std::to_string(open_->marks.marks().size()));
}

void ReviewView::draw_numbers(const widgets::Ui& ui, widgets::Rect area) {
  const bones::BoneKind bone = open_->review.session->header.bone;
  if (model_->has_bone(bone)) {
    const widgets::Rect target = area.cut_top(ui.theme.px(210), ui.theme.px(8));
    if (is_of_another_surface())
      widgets::text_centered(ui, target, ui.theme.strong, widgets::kQuietText,
                             "The bone has another surface by now, and other axes.");
    else
      // Those of then: landmarks may have been moved since.
      draw_bullseye(ui, target, screen(), open_->review.session->options.axes.value_or(model_->axes(bone)));
  }
  draw_moment(ui, area, screen());
}

void ReviewView::draw_side(const widgets::Ui& ui, const widgets::Rect& area) {
  if (open_)
    if (const auto checked = open_->check->progress().result)
      sessions_.take_check(open_->review.folder, *checked);
  widgets::begin_panel(ui, "review.sessions", area, "Sessions of this case");
  if (const auto pressed = sessions_.draw(ui, chosen_)) look_at(*pressed);
  ImGui::Separator();
  draw_buttons(ui);
  if (open_) draw_end(ui);
  if (open_) draw_check(ui, *open_->check, sessions_);
  if (open_) draw_camera(ui, open_->review);
  if (open_ && !has_frames()) {
    for (const std::string& problem : open_->review.problems)
      widgets::status_row(ui, widgets::Severity::Caution, "Not whole", problem);
    ImGui::Separator();
    draw_moments_without_frames(ui, open_->review.moments);
  }
  if (has_frames()) {
    draw_note_field(ui);
    ImGui::Separator();
    if (const auto wanted = draw_moments(ui, screen())) {
      go_to(open_->playback, open_->timeline(), *wanted);
      shows_postop_ = false;
    }
  }
  widgets::end_panel();
}

bool ReviewView::is_report_of_now() const {
  return report_ != nullptr && report_->has_ended() && model_ != nullptr &&
         report_->plan_sha256() == cases::plan_sha256(cases::with_named_meshes(model_->knee()));
}

void ReviewView::draw_buttons(const widgets::Ui& ui) {
  const float width = (ImGui::GetContentRegionAvail().x - ImGui::GetStyle().ItemSpacing.x) / 2;
  const auto pair = [&](const char* left, const char* right) {
    widgets::action_button(ui, left, width);
    ImGui::SameLine();
    widgets::action_button(ui, right, width);
  };
  pair("review.newer", "review.older");
  pair("review.mark", "review.unmark");
  pair("review.today", "review.achieved");
  widgets::action_button(ui, "review.report", width);
  if (open_ && open_->can_be_resumed) {
    ImGui::SameLine();
    widgets::action_button(ui, "review.resume", width);
  }
  draw_report(ui, report_.get(), no_report_, is_report_of_now());
  if (!open_ || !open_->today) return ui.log.note_state("today", "none");
  const TodayProgress progress = open_->today->progress();
  const std::string error = open_->today->error();
  const bool is_stopping = open_->today->is_stopping();
  ui.log.note_state("today", !error.empty()    ? "failed"
                             : progress.result ? "done"
                             : is_stopping     ? "stopping"
                                               : "running");
  if (!error.empty()) return widgets::status_row(ui, widgets::Severity::Bad, "Not run again", error);
  if (progress.result) return;
  ImGui::ProgressBar(
      progress.total > 0 ? static_cast<float>(progress.done) / static_cast<float>(progress.total) : 0,
      {-1, 0},
      is_stopping          ? "Stopping ..."
      : progress.total > 0 ? nullptr
                           : "Making the bone ready");
}

void ReviewView::draw_picture(const widgets::Ui& ui, const widgets::Rect& area) {
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  draw.AddRectFilled(area.min(), area.max(), IM_COL32(0, 0, 0, 255), ui.theme.px(6));
  ui.log.note("review.picture", area.min(), area.max());
  if (open_->pictures == nullptr)
    return widgets::text_centered(ui, area, ui.theme.strong, widgets::kQuietText,
                                  recording::is_exercise(open_->review.session->header)
                                      ? "The pictures of this exercise were not kept; poses, strokes and "
                                        "what happened were"
                                      : "No video was kept with this session; Record (Ctrl+R) in Navigate "
                                        "keeps it");
  if (const std::string error = open_->pictures->error(); !error.empty())
    return widgets::text_centered(ui, area, ui.theme.strong, widgets::kBad, sessions_.within(error));
  const recording::FrameGlance& glance = open_->glance();
  const PictureWish wish{glance.index, glance.timestamp_ns};
  const auto fetched = open_->pictures->picture(wish);
  // Until it is there the nearest one, which says that it is another: the numbers beside it are not its.
  const camera::FramePtr picture = fetched ? fetched->picture : open_->pictures->nearest(wish);
  video_.upload(picture);
  const bool is_copy = fetched && fetched->is_copy;
  ui.log.note_state("review_picture", picture == nullptr ? (fetched ? "none" : "reading")
                                      : is_copy          ? "copy"
                                      : fetched          ? "shown"
                                                         : "another");
  if (fetched && picture == nullptr)
    return widgets::text_centered(
        ui, area, ui.theme.strong, widgets::kQuietText,
        was_kept(*open_->review.session, glance.index)
            ? "The picture of this frame was kept and cannot be read: the video is damaged, or ends before it"
            : "No picture of this frame was kept");
  if (picture == nullptr)
    return widgets::text_centered(ui, area, ui.theme.strong, widgets::kQuietText, "Reading the video");
  const float w = static_cast<float>(video_.width()), h = static_cast<float>(video_.height());
  // The square about the middle: the round view of the arthroscope.
  const float side = std::min(w, h);
  const widgets::Rect at = widgets::fitted(area, 1);
  const ImVec2 from{(w - side) / 2 / w, (h - side) / 2 / h}, to{(w + side) / 2 / w, (h + side) / 2 / h};
  draw.AddImage(reinterpret_cast<ImTextureID>(static_cast<std::uintptr_t>(video_.texture())), at.min(),
                at.max(), from, to, fetched ? IM_COL32_WHITE : IM_COL32(150, 150, 150, 255));
  if (is_copy) widgets::caption(ui, area, widgets::kQuietText, "Small copy: reading the picture itself");
  if (!fetched)
    widgets::caption(ui, area, widgets::kCaution,
                     "Reading. This picture: " + nearness_in_words(picture->timestamp_ns, wish.timestamp_ns));
}

}  // namespace arthronaut::review
