#include "app/review/postop_run.h"

#include <algorithm>

#include "planning/files/whole_folder.h"
#include "planning/geometry/error.h"
#include "planning/images/volume_decoder.h"
#include "planning/images/volume_file.h"
#include "planning/import/import_process.h"
#include "planning/import/series_process.h"
#include "planning/postop/achieved_file.h"
#include "planning/postop/postop_source.h"

namespace arthronaut::review {

namespace {

bool has_a_bone(const Comparisons& comparisons) {
  return std::ranges::any_of(comparisons, [](const auto& one) { return one.second.bone.reliable; });
}

// Why none of the plan's bones is known to be in the images.
std::string lacking_in_words(const Comparisons& comparisons) {
  for (const auto& [key, comparison] : comparisons)
    if (!comparison.bone.reasons.empty())
      return std::string(bones::to_text(key.bone)) + ": " + comparison.bone.reasons.front();
  return "nothing was compared";
}

Comparisons kept_in(const std::filesystem::path& file) {
  try {
    if (std::filesystem::exists(file)) return postop::read_achieved_file(file);
  } catch (const InvalidInput&) {  // broken: it tells nobody anything
  }
  return {};
}

}  // namespace

bool keep(const open_case::PostopAnswer& answer, const std::filesystem::path& case_folder) {
  const std::filesystem::path file = achieved_file(case_folder);
  if (!answer.other_patient.empty()) return false;
  if (!has_a_bone(answer.comparisons) && has_a_bone(kept_in(file))) return false;
  return open_case::keep_tunnel_by_tunnel(file, case_folder, answer).size() < answer.comparisons.size();
}

std::string better_kept(const open_case::PostopAnswer& answer, const std::filesystem::path& case_folder) {
  std::string names, reasons;
  for (const auto& [key, why_not_now] : open_case::better_kept_in(achieved_file(case_folder), answer)) {
    names += (names.empty() ? "" : ", ") + tunnels::name_of(key);
    if (!why_not_now.empty())
      reasons += (reasons.empty() ? ": " : "; ") + tunnels::name_of(key) + ": " + why_not_now;
  }
  return names.empty()
             ? ""
             : "the case keeps a comparison that is reliable for " + names + ", as this is not" + reasons;
}

bool take_answer(std::shared_ptr<const open_case::PostopAnswer> answer, PostopShown& shown) {
  shown.other_patient = answer->other_patient;
  shown.not_its_bones.clear();
  if (!shown.other_patient.empty()) return false;
  if (!has_a_bone(answer->comparisons) && has_a_bone(shown.comparisons)) {
    shown.not_its_bones = lacking_in_words(answer->comparisons);
    return false;
  }
  shown.answer = std::move(answer);
  shown.comparisons = shown.answer->comparisons;
  return true;
}

PostopStanding standing_of(const PostopShown& shown, bool is_running, bool asked_in_vain) {
  if (shown.comparisons.empty()) return PostopStanding::OfTheseImages;
  if (is_running) return PostopStanding::BeforeThese;
  if (asked_in_vain || !shown.other_patient.empty() || !shown.not_its_bones.empty())
    return PostopStanding::BeforeFailed;
  return shown.answer == nullptr ? PostopStanding::Kept : PostopStanding::OfTheseImages;
}

bool is_of_earlier_images(PostopStanding standing) {
  return standing == PostopStanding::BeforeThese || standing == PostopStanding::BeforeFailed;
}

std::string in_words(PostopStanding standing) {
  switch (standing) {
    case PostopStanding::OfTheseImages:
      return "";
    case PostopStanding::Kept:
      return "As kept in the case: a comparison (C) reads its images again";
    case PostopStanding::BeforeThese:
      return "EARLIER COMPARISON: not of the images that are being compared";
    case PostopStanding::BeforeFailed:
      return "EARLIER COMPARISON: not of the images that were asked for last";
  }
  return "";
}

std::string no_picture_words(const PostopShown& shown, const postop::Comparison& comparison) {
  if (shown.answer == nullptr)
    return "No picture: the case keeps the comparison and not its images. Compare again (C) to see them.";
  if (!comparison.bone.is_found) return "No picture: the bone was not found in the images.";
  return "";
}

std::filesystem::path achieved_file(const std::filesystem::path& case_folder) {
  return case_folder / "achieved.json";
}

namespace {

constexpr double kAsks_s = 0.1;
// What reading may take, and room to hand it over.
constexpr double kMemory_gib = 4;

// Until the process has ended; false: it was stopped. Throws InvalidInput, why it failed.
template <typename Process, typename Follow>
bool wait_for(Process& process, const Follow& follow, const std::function<bool()>& stops) {
  using State = importing::ChildProcess::State;
  while (process.wait_for(kAsks_s) == State::Running) {
    follow();
    if (stops()) return false;
  }
  if (process.state() != State::Done) throw InvalidInput(process.message());
  return true;
}

// What may be compared; none where that is no folder or disc of series, or it was stopped.
std::vector<images::ImageSeries> series_in(const std::filesystem::path& source,
                                           const std::filesystem::path& program,
                                           const std::function<void(double)>& tell,
                                           const std::function<bool()>& stops) {
  if (!images::is_volume_source(source)) return {};
  importing::SeriesProcess process({.source = source, .program = program});
  if (!wait_for(
          process, [&] { tell(process.looked_fraction()); }, stops))
    return {};
  return postop::comparable_series(process.list()->series);
}

// Empty when it was stopped.
images::Volume read_beside(const std::filesystem::path& source, const std::filesystem::path& program,
                           const postop::PostopSourceOptions& options, const std::function<bool()>& stops) {
  importing::ImportRequest request{.source = source,
                                   .options = {},
                                   .memory_limit_gib = kMemory_gib,
                                   .is_postop = true,
                                   .program = program};
  request.options.series = options.series;
  importing::ImportProcess process(std::move(request));
  const auto tell = [&] {
    if (process.progress().fraction >= 0) options.on_progress(process.progress().fraction);
  };
  if (!wait_for(process, tell, stops)) return {};
  const importing::BoneImport read = process.take_result();
  if (!read.image) throw InvalidInput(source, "", "could not be handed over by the process that read it");
  images::Volume volume = images::volume_of(read.image->volume);
  volume.patient = {read.identity.patient_name, read.identity.patient_id, read.identity.birth_date};
  volume.side = read.side_in_images;
  return volume;
}

}  // namespace

PostopRun::PostopRun(const std::filesystem::path& case_folder, const std::filesystem::path& source,
                     const std::string& series, bool writes, std::function<void()> on_news,
                     const std::filesystem::path& program)
    : worker_(
          worker::Backlog::Lossless,
          [case_folder, source, series, writes, program](auto& inbox) {
            // Before the work: a folder that cannot be written to, a disk that is full.
            if (writes) files::refuse_unwritable(case_folder, achieved_file(case_folder));
            PostopProgress progress;
            open_case::PostopQuestion question{
                .case_folder = case_folder, .source = source, .series = series};
            question.on_progress = [&](const std::string& what, double share) {
              progress.what = what;
              progress.share = share;
              inbox.publish(progress);
            };
            question.stops = [&] { return inbox.stops(); };
            question.refuses_another_patient = true;
            question.read = [&](const postop::PostopSourceOptions& options) {
              return read_beside(source, program, options, question.stops);
            };
            if (series.empty()) {
              auto which = series_in(
                  source, program, [&](double share) { question.on_progress("Looking for CTs", share); },
                  question.stops);
              if (inbox.stops()) return;
              if (which.size() == 1) question.series = which.front().uid;
              if (which.size() > 1) {
                progress.which = std::move(which);
                return inbox.publish(progress);
              }
            }
            auto answer = open_case::compare_with_postop(question);
            if (answer.was_stopped || inbox.stops()) return;
            if (writes) progress.better_kept = better_kept(answer, case_folder);
            if (writes) keep(answer, case_folder);
            progress.answer = std::make_shared<const open_case::PostopAnswer>(std::move(answer));
            inbox.publish(progress);
          },
          std::move(on_news)) {}

PostopProgress PostopRun::progress() const {
  const auto latest = worker_.latest();
  return latest != nullptr ? *latest : PostopProgress{};
}

}  // namespace arthronaut::review
