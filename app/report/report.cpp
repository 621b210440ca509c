#include "app/report/report.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <optional>
#include <vector>

#include "app/report/achieved_section.h"
#include "app/report/flowing_pages.h"
#include "app/report/other_sessions.h"
#include "app/report/pdf_document.h"
#include "app/report/plan_sheet.h"
#include "app/report/plans_in_force.h"
#include "app/report/postop_section.h"
#include "app/report/report_content.h"
#include "app/report/report_data.h"
#include "app/report/report_words.h"
#include "app/report/result_summary.h"
#include "app/report/session_rows.h"
#include "app/report/session_sections.h"
#include "app/report/settings_section.h"
#include "app/report/stills.h"
#include "app/report/versions.h"
#include "app/scene/plan_picture.h"
#include "navigation/camera/medium.h"
#include "navigation/operation/achieved_tunnel.h"
#include "navigation/recording/session.h"
#include "planning/cases/case.h"
#include "planning/cases/plan_file.h"
#include "planning/files/atomic_file.h"
#include "planning/files/utc_clock.h"
#include "planning/geometry/error.h"
#include "planning/tunnels/tunnel.h"

namespace arthronaut::report {

namespace {

constexpr double kWidthMm = FlowingPages::kWidthMm;
// A report is two to four pages. What does not fit is laid out anew, more closely each time; of numbers and
// warnings nothing is ever left out, of lists the middle is.
struct Layout {
  std::size_t most_rows;  // of a list
  double picture_share;   // of the plan's pictures, height to width; 0: they stand beside the result's
  bool is_flowing;        // theatre begins below the plan, and the sheets come last
};
constexpr int kMostPages = 4;
constexpr std::array<Layout, 4> kLayouts{
    {{1'000'000, 1, false}, {24, 0.72, false}, {8, 0.72, true}, {4, 0, true}}};

class Report {
 public:
  // `stills`: null for strangers, and where there is no session. Measured, it has no pictures, for its number
  // of pages.
  Report(const Content& content, const ReportOptions& options, const Stills* stills, const Layout& layout,
         bool is_measured)
      : content_(content),
        options_(options),
        stills_(stills),
        layout_(layout),
        is_measured_(is_measured),
        pdf_("Arthronaut report: " + content.knee.name, options.paper),
        pages_(pdf_, content.knee.name + ", " + cases::plan_in_words(content.knee)) {}

  // Whole.
  PdfDocument& drawn() {
    const auto grafts = planned_grafts(content_.knee.plan);
    parts_ = 2 + static_cast<double>(grafts.size());
    begin_part("Drawing the plan");
    plan_page();
    if (!layout_.is_flowing) sheets(grafts);
    navigate_page();
    result_pictures();
    draw_settings_section(pages_, content_);
    if (layout_.is_flowing) sheets(grafts);
    return pdf_;
  }
  [[nodiscard]] int page_count() const { return pages_.page_count(); }

 private:
  void sheets(const std::vector<norms::Bundle>& grafts) {
    for (const norms::Bundle graft : grafts) {
      begin_part("Drawing the plan on one sheet");
      const std::string of_graft = graft == norms::Bundle::Whole          ? ""
                                   : graft == norms::Bundle::Anteromedial ? ", AM graft"
                                                                          : ", PL graft";
      // It hangs on the wall by itself.
      pages_.begin_page("The plan on one sheet: " + std::string(bones::to_text(content_.knee.side)) +
                        " knee" + of_graft);
      if (is_measured_) continue;
      draw_plan_sheet(pdf_,
                      {.left_mm = pages_.left_mm(),
                       .top_mm = pages_.y_mm(),
                       .width_mm = kWidthMm,
                       .bottom_mm = pages_.bottom_mm(),
                       .picture_px_per_mm = options_.picture_px_per_mm},
                      content_, graft);
    }
  }
  void begin_part(const std::string& what) {
    if (is_measured_) return;
    options_.tell(what, kGatheredShare + (1 - kGatheredShare) * std::min(1.0, done_++ / parts_));
  }
  // What a picture shows beside the plan.
  struct Result {
    std::vector<tunnels::Tunnel> achieved;
    std::vector<Eigen::Vector3d> touched_points_mm;
  };

  struct Picture {
    scene::ViewDirection view = scene::ViewDirection::Anterior;
    std::string of = {};             // what the caption says beside the view
    const Result* result = nullptr;  // null: of the plan alone
  };

  // In a row, with their names.
  void pictures(const std::vector<Picture>& shown, double share) {
    constexpr double kGap_mm = 6;
    const auto count = static_cast<double>(shown.size());
    const double width = (kWidthMm - kGap_mm * (count - 1)) / count, needed = share * width;
    pages_.need(needed + 8);
    const double y = pages_.y_mm() + 3;
    double x = pages_.left_mm();
    for (const Picture& one : shown) {
      if (is_measured_) break;
      scene::PictureRequest request;
      request.knee = &content_.knee;
      request.view = one.view;
      request.width = static_cast<int>(options_.picture_px_per_mm * width);
      request.height = static_cast<int>(options_.picture_px_per_mm * needed);
      request.light_background = true;
      if (one.result != nullptr) {
        request.achieved = one.result->achieved;
        request.curve_points_in_bone = one.result->touched_points_mm;
      }
      const auto picture = scene::render_plan_picture(request);
      pdf_.image(x, y, width, picture.rgb, picture.width, picture.height);
      pdf_.text(x, y + needed + 3.5, std::string(scene::to_text(one.view)) + one.of,
                {.size_pt = 8, .ink = kGray});
      x += width + kGap_mm;
    }
    pages_.skip(needed + 8);
  }

  // From the joint, onto the bone that was navigated; a case may hold one bone alone.
  scene::ViewDirection joint_view() const {
    const auto& bones = content_.knee.bones;
    const bool is_tibia = content_.session ? content_.session->header().bone == bones::BoneKind::Tibia
                                           : !bones.contains(bones::BoneKind::Femur);
    return is_tibia ? scene::ViewDirection::Plateau : scene::ViewDirection::Notch;
  }

  std::vector<tunnels::Tunnel> navigated_tunnels() const {
    std::vector<tunnels::Tunnel> tunnels;
    const auto add = [&](const operation::AchievedTunnel& achieved) {
      tunnels.push_back(achieved.truth ? *achieved.truth : achieved.measured);
    };
    for (const operation::AchievedTunnel& achieved : content_.achieved) add(achieved);
    for (const Content::Earlier& earlier : content_.earlier) add(earlier.achieved);
    return tunnels;
  }

  std::vector<Eigen::Vector3d> touched_points() const {
    std::vector<Eigen::Vector3d> points;
    if (!content_.registration) return points;
    const auto bone_from_marker = content_.registration->marker_from_bone.inverse();
    for (const auto& p : content_.session->curves()) points.push_back(bone_from_marker * p.position_mm);
    return points;
  }

  void plan_page();
  void say_plan_fit(const tunnels::TunnelKey& key);
  void navigate_page();
  void result_pictures();

  const Content& content_;
  const ReportOptions options_;
  const Stills* stills_;
  const Layout layout_;
  const bool is_measured_;
  PdfDocument pdf_;
  FlowingPages pages_;
  double parts_ = 1, done_ = 0;
};

void Report::plan_page() {
  pages_.begin_page("ACL reconstruction: the plan");
  std::vector<std::vector<std::string>> about;
  if (content_.identity) about.push_back({"Patient", content_.identity->in_words()});
  about.insert(about.end(),
               {{"Name", content_.knee.name}, {"Side", std::string(bones::to_text(content_.knee.side))}});
  if (!content_.knee.plan.tunnels.empty())
    about.push_back({"Plan, SHA-256", cases::plan_sha256(cases::with_named_meshes(content_.knee))});
  if (!content_.knee.created_utc.empty())
    about.push_back({"Created", files::utc_in_words(content_.knee.created_utc)});
  if (!options_.made_utc.empty() && !options_.is_deidentified)
    about.push_back({"Report made", files::utc_in_words(options_.made_utc)});
  about.push_back({"Versions", versions_in_words()});
  pages_.pairs(about);
  draw_plan_verdicts(pages_, content_);
  pages_.sentence(kResearchSentence, {.size_pt = 8.5, .ink = kWarning});
  draw_result_summary(pages_, content_);
  pages_.heading("Planned tunnels");
  if (content_.knee.plan.tunnels.empty()) {
    pages_.sentence("No tunnel is planned.");
  } else {
    std::vector<std::vector<std::string>> rows = {{"Tunnel", "Entry, mm (LPS)", "Direction", "Diameter",
                                                   "Length in bone", "Least wall", "Exit, mm (LPS)"}};
    for (const auto& [key, tunnel] : content_.knee.plan.tunnels) {
      const auto measured = content_.review->tunnels().find(key);
      const tunnels::TunnelGeometry geometry = measured == content_.review->tunnels().end()
                                                   ? tunnels::TunnelGeometry{}
                                                   : measured->second.geometry;
      const bool in_bone = geometry.enters_bone;
      rows.push_back(
          {tunnels::name_of(key), point(tunnel.entry_mm), point(tunnel.direction, 2),
           number(tunnel.diameter_mm, " mm"), in_bone ? number(geometry.length_mm, " mm") : "misses the bone",
           in_bone ? number(geometry.wall_mm, " mm") : "–", in_bone ? point(geometry.exit_mm) : "–"});
    }
    pages_.table({16, 34, 30, 20, 20, 18, 32}, rows);
    for (const auto& [key, tunnel] : content_.knee.plan.tunnels) say_plan_fit(key);
  }
  if (layout_.picture_share > 0)
    pictures({{.view = scene::ViewDirection::Anterior}, {.view = scene::ViewDirection::Lateral}},
             layout_.picture_share);
}

// A plan is of the mesh that it was made on, and of no other.
void Report::say_plan_fit(const tunnels::TunnelKey& key) {
  const std::string name = tunnels::name_of(key);
  const cases::PlanFit fit = cases::plan_fit(content_.knee, key);
  if (!fit.is_valid()) {
    pages_.sentence("NOT VALID: " + fit.reason + ".", {.bold = true, .ink = kWarning});
  } else if (fit.outcome == cases::PlanFit::Outcome::Unknown) {
    pages_.sentence("The plan of the " + name + " does not say on which surface of the bone it was made.",
                    {.size_pt = 8.5, .ink = kGray});
  }
}

void Report::navigate_page() {
  if (layout_.is_flowing) {
    pages_.continue_as("In theatre");
    pages_.heading("In theatre");
  } else {
    pages_.begin_page("In theatre");
  }
  draw_missing_sessions(pages_, content_);
  if (!content_.session) {
    pages_.sentence("No session with a registration or a drilled tunnel is recorded in this case.");
    draw_postop_section(pages_, content_);
    return;
  }
  const auto& session = *content_.session;
  const auto& header = session.header();
  const SessionFigures figures = figures_of(session);
  if (content_.is_of_another_surface)
    pages_.sentence(
        "THE CASE HAS ANOTHER SURFACE OF THE " +
            std::string(header.bone == bones::BoneKind::Femur ? "FEMUR" : "TIBIA") +
            " than this session was of: where in the bone it was drilled is not told, and nothing of "
            "it is drawn on the bone.",
        {.bold = true, .ink = kWarning});
  if (content_.check.outcome == recording::SessionCheck::Outcome::Broken)
    pages_.sentence(
        "NOT AS RECORDED: something of this session was changed or lost since (see Record by its hashes).",
        {.bold = true, .ink = kWarning});
  std::vector<std::vector<std::string>> rows{
      {"Session", content_.session_name},
      {"Started", content_.started_utc.empty() ? kNotTold : files::utc_in_words(content_.started_utc)},
      {"Bone", bone_in_words(header, content_.knee.side)},
      {"Source", kind_in_words(header)},
      {"Video", content_.identity ? header.source : neutral_source(header)},
      {"Medium", camera::medium_to_text(header.refractive_index)},
      {"Frames", frames_in_words(figures)},
      {"World marker tracked", number(figures.world_percent, " % of the frames that came")},
      {"Lens mark found", number(figures.mark_percent, " % of the frames that came")},
      {"Recorded by", program_in_words(header.program_version, header.build)},
      {"Record by its hashes", recording::check_words(content_.check)},
      {"Last hash of the record", content_.last_hash.empty() ? "none" : in_groups(content_.last_hash)}};
  if (figures.other_medium_percent > 0)
    rows.push_back({"WRONG MEDIUM by the markers", number(figures.other_medium_percent, " % of the frames")});
  if (const std::string guided = guided_bundles(session); !guided.empty())
    rows.push_back({"Guided to the tunnel", guided});
  if (const std::string plan = plans_in_words(plans_in_force(session)); !plan.empty())
    rows.push_back({"Plan in force", plan});
  std::ranges::move(rows_of(content_.safety), std::back_inserter(rows));
  pages_.pairs(rows);
  if (content_.registration) draw_registration(pages_, *content_.registration);
  if (!content_.registration_problem.empty())
    pages_.sentence("NOT READABLE: the registration: " + content_.registration_problem,
                    {.bold = true, .ink = kWarning});
  draw_time_line(pages_, content_, layout_.most_rows);
  for (const operation::AchievedTunnel& achieved : content_.achieved)
    draw_achieved(pages_, content_, achieved, true);
  for (const Content::Earlier& earlier : content_.earlier) {
    draw_achieved(pages_, content_, earlier.achieved, false);
    pages_.sentence("Drilled in " +
                        (earlier.session.empty() ? "an earlier session" : "the session " + earlier.session) +
                        ".",
                    {.size_pt = 8.5, .ink = kGray});
  }
  draw_other_sessions(pages_, content_);
  for (const Content::ByWord& said : content_.by_word)
    pages_.sentence(in_words(said), {.bold = true, .ink = kWarning});
  draw_postop_section(pages_, content_);
}

// What navigation and the images show stands in one row.
void Report::result_pictures() {
  constexpr double kShare = 0.72;
  const Result imaged = {tunnels_in_the_images(content_), {}};
  Result navigated;
  std::vector<Picture> shown;
  std::string legend = "Blue: as planned.";
  const auto show = [&](const Result& result, const std::string& of) {
    for (const scene::ViewDirection view : {joint_view(), scene::ViewDirection::Lateral})
      shown.push_back({.view = view, .of = of, .result = &result});
  };
  if (content_.session) {
    pages_.continue_as("Result, camera and tools");
    if (stills_ != nullptr) draw_stills_section(pages_, *stills_);
    begin_part("Drawing what was achieved");
    if (!content_.is_of_another_surface) navigated = {navigated_tunnels(), touched_points()};
    show(navigated, imaged.achieved.empty() ? "" : ", by navigation");
    if (!navigated.achieved.empty())
      legend += " Banded: as drilled, measured by navigation or, of a simulation, as it truly lies.";
    if (!navigated.touched_points_mm.empty()) legend += " Dots: where the probe touched the bone.";
  }
  if (!imaged.achieved.empty()) {
    show(imaged, ", by the CT after");
    legend += content_.session ? " By the CT after, banded: as it shows the tunnel, where that is reliable."
                               : " Banded: as the CT after the operation shows it, where that is reliable.";
  }
  constexpr std::size_t kMostInARow = 4;
  if (layout_.picture_share == 0 && !shown.empty() && shown.size() + 2 <= kMostInARow)
    shown.insert(shown.begin(), {{.view = scene::ViewDirection::Anterior, .of = ", planned"},
                                 {.view = scene::ViewDirection::Lateral, .of = ", planned"}});
  if (shown.empty()) {
    pages_.heading("The plan from the joint and from its inner side", (kWidthMm - 6) / 2 + 8);
    return pictures({{.view = joint_view()}, {.view = scene::ViewDirection::Medial}}, 1);
  }
  pictures(shown, shown.size() > 2 ? 1 : kShare);
  pages_.sentence(legend, {.size_pt = 8, .ink = kGray});
}

// The bytes of the PDF, laid out as openly as four pages allow.
std::string pdf_of(const Content& content, const ReportOptions& options) {
  options.tell("Taking the session's pictures", kGatheredShare);
  std::optional<Stills> stills;
  if (content.session && !options.is_deidentified) stills = take_stills(content);
  const Stills* const shown = stills ? &*stills : nullptr;
  const auto fits = [&](const Layout& layout) {
    Report measured(content, options, shown, layout, true);
    (void)measured.drawn();
    return measured.page_count() <= kMostPages;
  };
  const auto layout = std::ranges::find_if(kLayouts, fits);
  return Report(content, options, shown, layout == kLayouts.end() ? kLayouts.back() : *layout, false)
      .drawn()
      .bytes();
}

Content reportable(const std::filesystem::path& case_folder, const ReportOptions& options) {
  Content content = gather(case_folder, options);
  if (content.knee.bones.empty()) throw InvalidInput(case_folder, "case.json", "holds no bone to report on");
  return content;
}

}  // namespace

std::string ending_of(const std::filesystem::path& output) {
  std::string ending = output.extension().string();
  std::ranges::transform(ending, ending.begin(), [](unsigned char c) { return std::tolower(c); });
  return ending;
}

std::vector<std::string> write_report(const std::filesystem::path& case_folder,
                                      const std::filesystem::path& output, const ReportOptions& options) {
  const Content content = reportable(case_folder, options);
  const std::string ending = ending_of(output);
  if (ending == ".json")
    files::write_atomically(output, report_json(content, options));
  else if (ending == ".csv")
    files::write_atomically(output, report_csv(content, options));
  else
    files::write_atomically(output, pdf_of(content, options));
  return shortcomings_of(content);
}

std::string make_report(const std::filesystem::path& case_folder, const ReportOptions& options) {
  const Content content = reportable(case_folder, options);
  return pdf_of(content, options);
}

}  // namespace arthronaut::report
