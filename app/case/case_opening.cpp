#include "app/case/case_opening.h"

#include <cstdlib>
#include <optional>
#include <stdexcept>
#include <utility>

#include "planning/cases/bone_doubts.h"
#include "planning/cases/case.h"
#include "planning/files/private_folder.h"
#include "planning/geometry/error.h"
#include "planning/phantom/phantom_case.h"

namespace arthronaut::open_case {

std::filesystem::path built_in_case_folder() {
  const char* data = std::getenv("XDG_DATA_HOME");
  const char* home = std::getenv("HOME");
  std::filesystem::path base = std::filesystem::temp_directory_path();
  if (data != nullptr && *data != '\0')
    base = data;
  else if (home != nullptr && *home != '\0')
    base = std::filesystem::path(home) / ".local" / "share";
  return base / "arthronaut" / "Phantom.arthro";
}

namespace {

// What cannot be read Plan and Navigate tell: then nobody knows where the bones are unseen.
std::optional<cases::BoneDoubts> doubts_there(const std::filesystem::path& folder) {
  try {
    return cases::load_bone_doubts(folder);
  } catch (const std::runtime_error&) {
    return std::nullopt;
  }
}

using Tell = std::function<void(double)>;

// Meshes from the disk are about a fifth of it.
constexpr double kReadingShare = 0.2;

void load(OpenedCase& opened, const std::stop_token& stop, const Tell& tell) {
  cases::Case knee = cases::load_case(opened.folder);
  if (tell) tell(kReadingShare);
  if (knee.bones.empty() && knee.images.empty())
    throw InvalidInput(opened.folder, "case.json", "holds neither a bone to show nor images to paint one in");
  if (knee.bones.empty()) {
    opened.unpainted = std::move(knee);
  } else {
    opened.model = std::make_unique<PlanModel>(std::move(knee), stop, [&tell](double done) {
      if (tell) tell(kReadingShare + (1 - kReadingShare) * done);
    });
    const auto doubts = doubts_there(opened.folder);
    for (const bones::BoneKind kind : {bones::BoneKind::Femur, bones::BoneKind::Tibia})
      if (opened.model->has_bone(kind))
        opened.model->set_unseen(kind,
                                 doubts ? cases::unseen_parts_of(*doubts, opened.model->knee().bones.at(kind))
                                        : bones::UnseenParts{.was_looked_for = false});
    opened.model->set_measurements(cases::load_measurements(opened.folder));
  }
  opened.identity = cases::load_identity(opened.folder);
}

}  // namespace

OpenedCase open_folder(const std::filesystem::path& folder, const std::stop_token& stop, const Tell& tell) {
  OpenedCase opened;
  opened.folder = folder.empty() ? built_in_case_folder() : folder;
  if (folder.empty()) files::create_private_folder(opened.folder);
  if (folder.empty() || std::filesystem::exists(opened.folder / "case.json"))
    opened.lock = cases::CaseLock(opened.folder);
  if (folder.empty() && opened.lock.is_held() && !std::filesystem::exists(opened.folder / "case.json"))
    cases::save_case(opened.folder, phantom::case_of(phantom::make_phantom_knee(), "Phantom knee"));
  load(opened, stop, tell);
  return opened;
}

CaseOpening::CaseOpening(const std::filesystem::path& folder, std::function<void()> on_end) {
  opening_.start(
      [this, folder, stop = stop_.get_token()] {
        return open_folder(folder, stop, [this](double done) { note_done(done); });
      },
      std::move(on_end));
}

void CaseOpening::note_done(double done) {
  for (double before = done_; before < done && !done_.compare_exchange_weak(before, done);) {
  }
}

bool CaseOpening::take_when_free() {
  if (!open_.lock.is_held_elsewhere()) return false;
  cases::CaseLock lock(open_.folder);
  if (!lock.is_held()) return false;
  open_.lock = std::move(lock);
  locked_at_ = Clock::now();
  return true;
}

bool CaseOpening::take_over() {
  cases::CaseLock lock(open_.folder, cases::LockTaking::FromOtherHost);
  open_.lock = std::move(lock);
  locked_at_ = Clock::now();
  return open_.lock.is_held();
}

CaseOpening::CaseOpening(CaseOpening& before, std::function<void()> on_end) {
  open_.lock = std::move(before.open_.lock);
  locked_at_ = before.locked_at_;
  const bool is_ours = open_.lock.is_held();
  opening_.start(
      [this, folder = before.folder(), is_ours, stop = stop_.get_token()] {
        OpenedCase opened;
        opened.folder = folder;
        if (!is_ours) opened.lock = cases::CaseLock(folder);  // read-only, unless it has become free
        load(opened, stop, [this](double done) { note_done(done); });
        return opened;
      },
      std::move(on_end));
}

bool CaseOpening::take() {
  if (!opening_.is_ready()) return false;
  try {  // the top of the opening thread: a case that cannot be read is said on the screen
    OpenedCase opened = opening_.take();
    if (is_cancelled()) return false;  // it was ready in the same moment
    if (open_.lock.is_held())
      opened.lock = std::move(open_.lock);
    else
      locked_at_ = Clock::now();
    open_ = std::move(opened);
  } catch (const std::exception& error) {
    if (!is_cancelled()) failure_ = error.what();
    return false;
  }
  return true;
}

}  // namespace arthronaut::open_case
