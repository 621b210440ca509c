#include "app/review/session_list.h"

#include <imgui.h>

#include <algorithm>
#include <utility>

#include "app/widgets/list_rows.h"
#include "navigation/recording/recording_lock.h"
#include "navigation/recording/session_facts.h"
#include "navigation/worker/freed_memory.h"
#include "planning/cases/case.h"
#include "planning/files/local_time.h"
#include "planning/files/within_folder.h"

namespace arthronaut::review {

std::string session_title(const std::string& folder_name) {
  const std::int64_t number = cases::session_number(folder_name);
  const std::string date = number > 0 ? folder_name.substr(folder_name.find('-') + 1) : folder_name;
  const bool is_date =
      date.size() >= 15 && date[8] == '-' && date.find_first_not_of("0123456789-") == std::string::npos;
  if (!is_date) return folder_name;
  const std::string utc = date.substr(0, 4) + "-" + date.substr(4, 2) + "-" + date.substr(6, 2) + "T" +
                          date.substr(9, 2) + ":" + date.substr(11, 2) + ":" + date.substr(13, 2) + "Z";
  const std::string local = files::local_time_in_words(utc);
  return (number > 0 ? std::to_string(number) + ":  " : "") + local.substr(0, 10) + " " + local.substr(10) +
         date.substr(15);
}

SessionLine session_line(const library::SessionFacts& facts, std::optional<bones::Side> case_side) {
  SessionLine line;
  std::vector<std::string> doubts = facts.doubts();
  if (facts.side && case_side && facts.side != case_side)
    doubts.push_back("recorded as of a " + library::word_of(facts.side) + " knee, the case is a " +
                     library::word_of(case_side) + " one");
  // What cannot be read comes first: the row shows the beginning of its words.
  if (const std::string damage = facts.damage(); std::erase(doubts, damage) > 0) line.words = damage + "; ";
  line.words += facts.what();
  line.words += (facts.what().empty() ? "" : "; ") + facts.outcome();
  for (const std::string& doubt : doubts) line.words += "; " + doubt;
  line.is_being_recorded = facts.is_being_recorded && !facts.was_finished;
  line.severity = !facts.problem.empty()                   ? widgets::Severity::Bad
                  : facts.is_in_doubt() || !doubts.empty() ? widgets::Severity::Caution
                  : facts.is_drilled()                     ? widgets::Severity::Good
                                                           : widgets::Severity::Quiet;
  return line;
}

SessionLine with_check(SessionLine line, const recording::SessionCheck& check) {
  if (check.outcome != recording::SessionCheck::Outcome::Broken) return line;
  line.severity = widgets::Severity::Bad;
  line.words =
      "NOT AS RECORDED: " + recording::check_words(check) + (line.words.empty() ? "" : "; ") + line.words;
  return line;
}

void SessionList::open(const std::filesystem::path& case_folder, bones::Side case_side) {
  case_folder_ = case_folder;
  case_side_ = case_side;
  folders_.clear();
  lines_.clear();
  broken_.clear();
  reads_again_ = reading_.is_busy();
}

std::string SessionList::within(std::string reason) const {
  for (const std::filesystem::path& folder : folders_)
    reason = files::within_folder(folder, std::move(reason));
  return reason;
}

void SessionList::read() {
  folders_ = cases::session_folders(case_folder_);
  std::reverse(folders_.begin(), folders_.end());
  if ((reads_again_ = reading_.is_busy())) return;
  if (folders_.empty()) return;
  reading_.start(
      [folders = folders_, side = case_side_] {
        Lines lines;  // read_session_facts() throws nothing for what it finds
        for (const auto& folder : folders) {
          SessionLine line = session_line(recording::read_session_facts(folder), side);
          line.words = files::within_folder(folder, std::move(line.words));
          lines.emplace(folder, std::move(line));
        }
        worker::give_freed_memory_back();
        return lines;
      },
      wake_);
}

void SessionList::take_check(const std::filesystem::path& session_folder,
                             const recording::SessionCheck& check) {
  if (check.outcome == recording::SessionCheck::Outcome::Broken)
    broken_[session_folder] = check;
  else
    broken_.erase(session_folder);
}

SessionLine SessionList::line_of(std::size_t session) const {
  const std::filesystem::path& folder = folders_[session];
  const auto read = lines_.find(folder);
  const SessionLine line = read != lines_.end() ? read->second : SessionLine{};
  const auto broken = broken_.find(folder);
  if (broken == broken_.end()) return line;
  SessionLine checked = with_check(line, broken->second);
  checked.words = files::within_folder(folder, std::move(checked.words));
  return checked;
}

bool SessionList::has_one_ended() const {
  return std::ranges::any_of(lines_, [](const auto& of) {
    return of.second.is_being_recorded && !recording::is_being_recorded(of.first);
  });
}

void SessionList::take_read() {
  if (!reading_.is_ready()) return;
  Lines lines = reading_.take();
  if (std::exchange(reads_again_, false)) return read();
  lines_ = std::move(lines);
}

std::optional<std::size_t> SessionList::draw(const widgets::Ui& ui, std::optional<std::size_t> chosen) {
  take_read();
  if (folders_.empty()) {
    widgets::text_in(ui.theme.body, widgets::kQuietText, "None yet");
    return std::nullopt;
  }
  std::optional<std::size_t> pressed;
  const bool is_chosen_anew = std::exchange(in_view_, chosen) != chosen;
  ImFont* const font = ui.theme.body;
  const float sign = ui.theme.px(26), gap = ui.theme.px(8);
  const auto color_of = [](const SessionLine& line) {
    const bool is_calm =
        line.severity == widgets::Severity::Good || line.severity == widgets::Severity::Quiet;
    return is_calm ? widgets::kQuietText : widgets::color_of(line.severity);
  };
  // Of each the beginning of its words, so that the rows stand still when another one is chosen; of the
  // chosen one all of them below. As high as the rows are, up to where the buttons need the room.
  const float row = 2 * font->FontSize + gap;
  const float all = gap + static_cast<float>(folders_.size()) * (row + ImGui::GetStyle().ItemSpacing.y);
  constexpr float kMostOfPanel = 0.46F;
  const float most = std::max(ui.theme.px(250), kMostOfPanel * ImGui::GetContentRegionAvail().y);
  ImGui::BeginChild("review.list", {0, std::min(most, all)});
  for (std::size_t i = 0; i < folders_.size(); ++i) {
    const std::string name = folders_[i].filename().string();
    const SessionLine line = line_of(i);
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float room = ImGui::GetContentRegionAvail().x - sign;
    ImGui::PushID(static_cast<int>(i));
    if (ImGui::Selectable("##session", chosen == i, 0, {0, row})) pressed = i;
    ImGui::PopID();
    if (is_chosen_anew && chosen == i) ImGui::SetScrollHereY(0.5F);
    // What of it can be pressed: the rest lies under the buttons below.
    const ImVec2 list_from = ImGui::GetWindowPos(), list_size = ImGui::GetWindowSize();
    const ImVec2 from{ImGui::GetItemRectMin().x, std::max(ImGui::GetItemRectMin().y, list_from.y)};
    const ImVec2 to{ImGui::GetItemRectMax().x,
                    std::min(ImGui::GetItemRectMax().y, list_from.y + list_size.y)};
    if (from.y < to.y) ui.log.note("review.session." + name, from, to);
    ui.log.note_state("session_line." + name, line.words);
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    draw.AddText(font, font->FontSize, at, widgets::kText, session_title(name).c_str());
    if (line.words.empty()) continue;
    widgets::draw_sign(draw, {at.x + ui.theme.px(9), at.y + font->FontSize * 1.5F}, ui.theme.px(7),
                       line.severity);
    widgets::draw_text(draw, font, at.x + sign, at.y + font->FontSize, color_of(line),
                       widgets::fitting(font, line.words, room));
  }
  ImGui::EndChild();
  if (chosen && *chosen < folders_.size()) {
    const SessionLine line = line_of(*chosen);
    if (!line.words.empty()) widgets::text_in(font, color_of(line), line.words);
  }
  return pressed;
}

}  // namespace arthronaut::review
