#include "app/review/review_view.h"

#include <GLFW/glfw3.h>

#include <algorithm>

#include "app/widgets/source_banner.h"
#include "planning/cases/case.h"
#include "planning/geometry/error.h"

namespace arthronaut::review {

namespace {

// "0007-20261121-122356" as "7:  2026-11-21  12:23:56 UTC"; of older sessions, without a number, the date;
// other names as they are.
std::string date_text(const std::string& name) {
  const std::int64_t number = cases::session_number(name);
  const std::string date = number > 0 ? name.substr(name.find('-') + 1) : name;
  const bool is_date =
      date.size() >= 15 && date[8] == '-' && date.find_first_not_of("0123456789-") == std::string::npos;
  if (!is_date) return name;
  return (number > 0 ? std::to_string(number) + ":  " : "") + date.substr(0, 4) + "-" + date.substr(4, 2) +
         "-" + date.substr(6, 2) + "  " + date.substr(9, 2) + ":" + date.substr(11, 2) + ":" +
         date.substr(13) + " UTC";
}

}  // namespace

ReviewView::ReviewView(std::function<void()> make_current, std::function<void()> wake)
    : wake_(std::move(wake)), pane_(std::move(make_current)) {}

mode::ModeTitle ReviewView::title() const {
  return {"review", "mode.review", "Review", "What happened", GLFW_KEY_F3};
}

std::optional<sources::SourceKind> ReviewView::source_kind() const {
  return has_frames() ? std::optional(sources::SourceKind::Recording) : std::nullopt;
}

void ReviewView::case_opened(const mode::OpenCase& opened) {
  model_ = opened.model;
  case_folder_ = opened.folder;
  sessions_.clear();
  chosen_.reset();
  review_.reset();
  pictures_.reset();
  notice_.clear();
}

void ReviewView::enter() {
  sessions_ = cases::session_folders(case_folder_);
  std::reverse(sessions_.begin(), sessions_.end());  // newest first
  if (sessions_.empty()) return;
  // What was chosen keeps its place in the list as new sessions come.
  const auto same =
      review_ ? std::find(sessions_.begin(), sessions_.end(), review_->folder) : sessions_.end();
  if (same != sessions_.end())
    chosen_ = static_cast<std::size_t>(same - sessions_.begin());
  else
    choose(0);
}

void ReviewView::choose(std::size_t session) {
  if (session >= sessions_.size() || opening_.valid()) return;
  chosen_ = session;
  review_.reset();
  pictures_.reset();
  notice_.clear();
  cursor_ = {};
  opening_ = std::async(std::launch::async, [folder = sessions_[session], wake = wake_] {
    const struct Waker {
      const std::function<void()>& wake;
      ~Waker() { wake(); }
    } waker{wake};
    return read_review(folder);
  });
}

void ReviewView::take_opened() {
  if (!opening_.valid() || opening_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return;
  try {  // the top of the job
    review_ = opening_.get();
  } catch (const std::exception& error) {
    notice_ = error.what();
    return;
  }
  shown_frame_.reset();
  if (!has_frames()) return;
  // Where the user most wants to look first: the last moment with guidance.
  const auto& frames = review_->session->frames();
  cursor_.frame = frames.size() - 1;
  for (std::size_t i = frames.size(); i-- > 0;)
    if (frames[i].guidance.is_valid()) {
      cursor_.frame = i;
      break;
    }
  if (!review_->session->video().empty())
    pictures_ = std::make_unique<PictureFetcher>(review_->folder, wake_);
  const bones::BoneKind bone = review_->session->header().bone;
  if (model_->has_bone(bone)) {
    const std::optional<tunnels::Tunnel>& tunnel = review_->plan.plan;
    const geometry::Bounds bounds = model_->bounds(bone);
    pane_.look(tunnel ? scene::orbited(scene::look_along(tunnel->direction.normalized(), tunnel->entry_mm,
                                                         190, {0, 0, 1}),
                                       {40, -30}, 600)
                      : scene::look_from(scene::ViewDirection::Anterior, model_->knee().side, bounds, 1));
  }
}

bool ReviewView::has_frames() const { return review_ && !review_->session->frames().empty(); }

bool ReviewView::is_busy() const { return opening_.valid() || cursor_.plays; }

void ReviewView::play(double now_s) {
  if (!cursor_.plays || !has_frames()) return;
  const double at = cursor_.play_from_s + now_s - cursor_.play_started_s;
  cursor_.frame = frame_at(*review_->session, at);
  if (cursor_.frame + 1 >= review_->session->frames().size()) cursor_.plays = false;
}

void ReviewView::step(long frames) {
  if (!has_frames()) return;
  cursor_.plays = false;
  const long last = static_cast<long>(review_->session->frames().size()) - 1;
  cursor_.frame = static_cast<std::size_t>(std::clamp(static_cast<long>(cursor_.frame) + frames, 0L, last));
}

void ReviewView::add_actions(widgets::Actions& actions) {
  const auto has = [this] { return has_frames(); };
  actions.add({"review.play", "Play", "From here at the pace it happened", GLFW_KEY_SPACE, 0, false, has,
               [this] { return cursor_.plays; },
               [this] {
                 cursor_.plays = !cursor_.plays;
                 if (cursor_.frame + 1 >= review_->session->frames().size()) cursor_.frame = 0;
                 cursor_.play_from_s = time_s(*review_->session, cursor_.frame);
                 cursor_.play_started_s = widgets::GraphicsWindow::now_s();
               }});
  const auto jump = [&](const char* id, const char* label, int key, int mods, long frames) {
    actions.add(
        {id, label, std::string(label) + " on the time line", key, mods, true, has, {}, [this, frames] {
           step(frames);
         }});
  };
  jump("review.back", "1 back", GLFW_KEY_LEFT, 0, -1);
  jump("review.forward", "1 forward", GLFW_KEY_RIGHT, 0, 1);
  jump("review.back_far", "60 back", GLFW_KEY_LEFT, GLFW_MOD_SHIFT, -60);
  jump("review.forward_far", "60 forward", GLFW_KEY_RIGHT, GLFW_MOD_SHIFT, 60);
  jump("review.first", "First", GLFW_KEY_HOME, 0, -1'000'000'000);
  jump("review.last", "Last", GLFW_KEY_END, 0, 1'000'000'000);
  actions.add({"review.newer",
               "Newer session",
               "The session after this one",
               GLFW_KEY_UP,
               0,
               false,
               [this] { return chosen_ && *chosen_ > 0; },
               {},
               [this] { choose(*chosen_ - 1); }});
  actions.add({"review.older",
               "Older session",
               "The session before this one",
               GLFW_KEY_DOWN,
               0,
               false,
               [this] { return chosen_ && *chosen_ + 1 < sessions_.size(); },
               {},
               [this] { choose(*chosen_ + 1); }});
}

void ReviewView::draw(const widgets::Ui& ui, const widgets::Rect& area) {
  take_opened();
  play(ui.now_s);
  const float gap = ui.theme.px(12);
  widgets::Rect rest = area;
  draw_sessions(ui, rest.cut_left(ui.theme.px(380), gap));
  ui.log.note_state("session", review_            ? review_->folder.filename().string()
                               : opening_.valid() ? "opening"
                                                  : "none");
  if (!has_frames()) {
    const char* text = sessions_.empty()  ? "No session yet. Record one in Navigate."
                       : opening_.valid() ? "Opening the session"
                       : !notice_.empty() ? "This session cannot be read. The reason stands below."
                       : review_          ? "This session has no pictures."
                                          : "Choose a session.";
    widgets::text_centered(ui, rest, ui.theme.title, widgets::kQuietText, text);
    return;
  }
  draw_origin(ui, rest.cut_top(ui.theme.px(58), gap));
  const widgets::Rect line = rest.cut_bottom(ui.theme.px(300), gap);
  const widgets::Rect moment = rest.cut_right(ui.theme.px(430), gap);
  const widgets::Rect picture = rest.cut_left((rest.width - gap) / 2, gap);
  draw_picture(ui, picture);
  draw_scene(ui, rest);
  draw_moment(ui, moment, *review_, cursor_.frame);
  if (const auto wanted = draw_time_line(ui, line, *review_, cursor_)) {
    cursor_.plays = false;
    cursor_.frame = *wanted;
  }
  ui.log.note_state("frame", std::to_string(cursor_.frame));
}

void ReviewView::draw_sessions(const widgets::Ui& ui, const widgets::Rect& area) {
  widgets::begin_panel(ui, "review.sessions", area, "Sessions of this case");
  for (std::size_t i = 0; i < sessions_.size(); ++i) {
    const std::string name = sessions_[i].filename().string();
    if (ImGui::Selectable(date_text(name).c_str(), chosen_ && *chosen_ == i)) choose(i);
    ui.log.note("review.session." + name, ImGui::GetItemRectMin(), ImGui::GetItemRectMax());
  }
  if (sessions_.empty()) widgets::text_in(ui.theme.body, widgets::kQuietText, "None yet");
  ImGui::Separator();
  const float width = ImGui::GetContentRegionAvail().x;
  widgets::action_button(ui, "review.newer", width);
  widgets::action_button(ui, "review.older", width);
  widgets::action_button(ui, "review.play", width);
  if (review_ && !review_->session->was_finished())
    widgets::status_row(ui, widgets::Severity::Caution, "Cut off",
                        "the program ended before the session did");
  widgets::end_panel();
}

// As large as the word in the bar above, and in its colour: what a recording is of changes nothing of what it
// is.
void ReviewView::draw_origin(const widgets::Ui& ui, const widgets::Rect& area) const {
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  ImFont* const font = ui.theme.afar;
  const std::string words = origin_in_words(review_->session->header());
  const ImVec2 size = font->CalcTextSizeA(font->FontSize, 1e9F, 0, words.c_str());
  const float margin = ui.theme.px(14);
  const widgets::Rect plate{area.x, area.y, size.x + 2 * margin, area.height};
  draw.AddRectFilled(plate.min(), plate.max(), widgets::banner_color(sources::SourceKind::Recording),
                     ui.theme.px(6));
  draw.AddText(font, font->FontSize, {plate.x + margin, plate.center().y - size.y / 2}, widgets::kBackground,
               words.c_str());
  ui.log.note("review.origin", plate.min(), plate.max());
  ui.log.note_state("origin", words);
}

void ReviewView::draw_picture(const widgets::Ui& ui, const widgets::Rect& area) {
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  draw.AddRectFilled(area.min(), area.max(), IM_COL32(0, 0, 0, 255), ui.theme.px(6));
  ui.log.note("review.picture", area.min(), area.max());
  if (pictures_ == nullptr)
    return widgets::text_centered(ui, area, ui.theme.strong, widgets::kQuietText,
                                  "No video was kept with this session");
  if (const std::string error = pictures_->error(); !error.empty())
    return widgets::text_centered(ui, area, ui.theme.strong, widgets::kBad, error);
  const camera::FramePtr picture = pictures_->picture(review_->session->frames()[cursor_.frame].index);
  video_.upload(picture);
  ui.log.note_state("review_picture", picture != nullptr ? "shown" : "reading");
  if (video_.texture() == 0)
    return widgets::text_centered(ui, area, ui.theme.strong, widgets::kQuietText, "Reading the video");
  const float w = static_cast<float>(video_.width()), h = static_cast<float>(video_.height());
  // The square about the middle: the round view of the arthroscope.
  const float side = std::min(w, h);
  const widgets::Rect at = widgets::fitted(area, 1);
  const ImVec2 from{(w - side) / 2 / w, (h - side) / 2 / h}, to{(w + side) / 2 / w, (h + side) / 2 / h};
  draw.AddImage(reinterpret_cast<ImTextureID>(static_cast<std::uintptr_t>(video_.texture())), at.min(),
                at.max(), from, to, picture != nullptr ? IM_COL32_WHITE : IM_COL32(90, 90, 90, 255));
  if (picture == nullptr && !cursor_.plays)
    widgets::text_centered(ui, area, ui.theme.strong, widgets::kText, "Reading the video");
}

void ReviewView::draw_scene(const widgets::Ui& ui, const widgets::Rect& area) {
  if (!model_->has_bone(review_->session->header().bone)) return;
  if (shown_frame_ != cursor_.frame) {
    show_scene();
    shown_frame_ = cursor_.frame;
  }
  pane_.draw(ui, "review.view", area);
  const bool is_femur = review_->session->header().bone == bones::BoneKind::Femur;
  const auto& plan = review_->plan.plan;
  const std::string planned = !plan ? ""
                              : plan->bundle == norms::Bundle::Whole
                                  ? ". Blue: planned"
                                  : ". Blue: planned " + tunnels::name_of(plan->key());
  widgets::caption(ui, area, widgets::kText,
                   std::string(is_femur ? "Femur" : "Tibia") + planned +
                       (!review_->achieved.empty() ? ". Banded: achieved" : ""));
}

void ReviewView::show_scene() {
  const recording::RecordedSession& session = *review_->session;
  const recording::RecordedFrame& frame = session.frames()[cursor_.frame];
  const bones::BoneKind bone = session.header().bone;
  scene::SceneContent content;
  content.bones.push_back({model_->drawn_mesh(bone), scene::kBoneColor, 1.0});
  const recording::RecordedSession::PlanChange& plan = review_->plan;
  if (plan.plan) scene::add_planned_tunnel(content, *plan.plan, plan.planned_length_mm);
  for (const operation::AchievedTunnel& achieved : review_->achieved) {
    // Of a depth that nobody knows, in older records nought, the tunnel is drawn as long as planned.
    const double depth_mm = achieved.depth_mm.value_or(0);
    scene::add_achieved_tunnel(content, achieved.measured, depth_mm > 1 ? depth_mm : plan.planned_length_mm);
  }
  if (session.registration() && session.registration()->has_pose) {
    const geometry::RigidTransform bone_from_marker = session.registration()->marker_from_bone.inverse();
    std::vector<Eigen::Vector3d> touched;
    for (const strokes::CurvePoint& point : session.curves())
      touched.push_back(bone_from_marker * point.position_mm);
    scene::add_curve_points(content, touched);
    if (frame.tip_is_valid)
      content.balls.push_back({bone_from_marker * frame.tip_in_world_mm, 2.5, scene::kGuideColor, false});
  }
  if (frame.guidance.is_valid())
    scene::add_guide(content, frame.guidance.guide_point_mm, frame.guidance.guide_direction,
                     frame.guidance.drill ? std::max(frame.guidance.drill->remaining_mm, 5.0)
                                          : std::max(plan.planned_length_mm, 5.0));
  pane_.show(content);
}

}  // namespace arthronaut::review
