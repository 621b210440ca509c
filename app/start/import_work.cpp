#include "app/start/import_work.h"

#include <algorithm>
#include <utility>

#include "app/case/case_opening.h"
#include "planning/files/private_folder.h"
#include "planning/import/case_import.h"
#include "planning/import/import_side.h"

namespace arthronaut::start {

namespace fs = std::filesystem;

ImportWork::ImportWork(std::function<void()> wake, fs::path program)
    : wake_(std::move(wake)), program_(std::move(program)) {}

ImportWork::~ImportWork() { end_work(); }

void ImportWork::end_work() {
  saving_.drop();
  series_.reset();
  process_.reset();
}

void ImportWork::look_into(const fs::path& root) {
  end_work();
  sources_ = {};
  sources_.root = root;
  result_ = {};
  said_side_.reset();
  wishes_ = {};
  spaces_.clear();
  failure_ = {};
  noted_ = 0;
  wanted_uid_.clear();
  state_ = State::Looking;  // until poll(), whatever it is: the window sees every step
  if (!may_hold_series(root)) return;
  try {
    series_ = std::make_unique<importing::SeriesProcess>(
        importing::SeriesRequest{.source = root, .with_pictures = true, .program = program_});
  } catch (
      const std::exception& error) {  // no process could be started: said as any other failure of looking
    failure_ = {.words = error.what()};
  }
}

void ImportWork::take_sources() {
  images::SeriesList list;
  if (series_ != nullptr) {
    if (series_->list()) {
      list = *series_->list();
    } else if (series_->state() == importing::SeriesProcess::State::Running) {
      return;
    } else {
      failure_ = {.words = series_->message()};
    }
  }
  // A slice alone can't be imported, and of a folder of slices a person chooses one.
  if (const std::string uid = series_of_one_slice(sources_.root, list); !uid.empty()) {
    look_into(fs::absolute(sources_.root).parent_path());
    wanted_uid_ = uid;
    return;
  }
  // Without a list there may be meshes all the same.
  sources_ = import_sources(sources_.root, list);
  sources_.wanted_uid = wanted_uid_;
  state_ = State::Choosing;
}

// A series whose middle slice cannot be read is better known before the import than by it.
void ImportWork::note_pictures() {
  const auto& pictures = series_->pictures();
  const auto note = [this](const std::string& reason) {  // before thick slices and the like
    auto& warnings = sources_.sources.at(noted_).warnings;
    warnings.insert(warnings.begin(), "No picture: " + reason);
  };
  for (; noted_ < pictures.size(); ++noted_)
    if (!pictures[noted_].is_there()) note(pictures[noted_].refusal);
  const std::size_t count = series_->list() ? series_->list()->series.size() : 0;
  if (series_->state() != importing::SeriesProcess::State::Failed || noted_ >= count) return;
  note(series_->message());
  sources_.left_out.push_back("the pictures from \"" + sources_.sources.at(noted_).title +
                              "\" on: " + series_->message());
  noted_ = count;
}

const images::Thumbnail* ImportWork::thumbnail(std::size_t source) const {
  if (series_ == nullptr || source >= series_->pictures().size()) return nullptr;
  const importing::SeriesPicture& picture = series_->pictures()[source];
  return picture.is_there() ? &picture.thumbnail : nullptr;
}

bool ImportWork::makes_pictures() const {
  return state_ != State::Looking && series_ != nullptr &&
         series_->state() == importing::SeriesProcess::State::Running;
}

double ImportWork::looked_fraction() const { return series_ != nullptr ? series_->looked_fraction() : 0; }

void ImportWork::start(const ImportWishes& wishes) {
  if (state_ != State::Choosing || wishes.sources.empty()) return;
  wishes_ = wishes;
  spaces_.clear();
  begin();
}

void ImportWork::begin() {
  next_ = 0;
  result_ = {};
  said_side_.reset();
  failure_ = {};
  state_ = State::Running;
  done_fraction_ = 0;
  start_next();
}

bool ImportWork::can_swap_axes() const {
  return state_ == State::Asking &&
         std::ranges::any_of(result_.bones, [](const auto& bone) { return bone.likelier_in().has_value(); });
}

// Of meshes each source has made one bone, in their order.
void ImportWork::swap_axes() {
  if (!can_swap_axes()) return;
  for (std::size_t i = 0; i < result_.bones.size(); ++i)
    if (const auto space = result_.bones[i].likelier_in()) spaces_[wishes_.sources[i]] = *space;
  begin();
}

void ImportWork::start_next(std::optional<bones::LengthUnit> unit) {
  const ImportSource& source = sources_.sources.at(wishes_.sources[next_]);
  importing::BoneImportOptions options;
  options.side = wishes_.side;
  if (source.series) options.series = source.series->uid;
  options.kind = source.bone;
  options.images_only = wishes_.images_only;
  if (source.series) options.labels = wishes_.labels;
  options.unit = unit;
  if (const auto space = spaces_.find(wishes_.sources[next_]); space != spaces_.end())
    options.space = space->second;
  progress_ = {};
  try {
    process_ = std::make_unique<importing::ImportProcess>(
        importing::ImportRequest{.source = source.source, .options = options, .program = program_});
  } catch (
      const std::exception& error) {  // no process could be started: said as any other failure of the import
    failure_ = {.words = error.what()};
    state_ = State::Choosing;
  }
}

// The unit that a person has said is for those meshes that need one: another beside them may be in mm.
void ImportWork::take_refusal() {
  failure_ = process_->failure();
  process_.reset();
  const auto& fitting = failure_.units;
  if (wishes_.unit && std::find(fitting.begin(), fitting.end(), *wishes_.unit) != fitting.end()) {
    failure_ = {};
    start_next(wishes_.unit);
    return;
  }
  state_ = State::Choosing;
}

const ImportSource* ImportWork::refused_source() const {
  const bool is_refused = state_ == State::Choosing && !failure_.words.empty();
  return is_refused && next_ < wishes_.sources.size() ? &sources_.sources.at(wishes_.sources[next_])
                                                      : nullptr;
}

void ImportWork::set_bone(std::size_t source, bones::BoneKind bone) {
  if (state_ != State::Choosing || sources_.sources.at(source).series) return;
  sources_.sources[source].bone = bone;
  sources_.sources[source].refusal.clear();
}

void ImportWork::take_bones() {
  using Process = importing::ImportProcess;
  const Process::State state = process_->poll();
  progress_ = process_->progress();
  done_fraction_ = std::max(done_fraction_, (static_cast<double>(next_) + process_->done_fraction()) /
                                                static_cast<double>(wishes_.sources.size()));
  if (state == Process::State::Running) return;
  if (state != Process::State::Done) return take_refusal();
  importing::BoneImport made = process_->take_result();
  process_.reset();
  if (next_ == 0) {
    result_ = std::move(made);
  } else {  // another mesh of the same knee
    if (!importing::add_bones(result_, std::move(made))) {
      failure_ = {.words = "the meshes are of different sides: " +
                           sources_.sources.at(wishes_.sources[next_]).title};
      state_ = State::Choosing;
      return;
    }
  }
  if (++next_ < wishes_.sources.size())
    start_next();
  else
    state_ = State::Asking;
}

void ImportWork::cancel() {
  if (state_ == State::Looking) {
    end_work();
    state_ = State::Idle;
  } else if (state_ == State::Choosing) {
    if (series_ != nullptr) series_->cancel();
  } else if (state_ == State::Running || state_ == State::Asking) {
    process_.reset();  // ends the child
    failure_ = {};
    state_ = State::Choosing;
  }
}

void ImportWork::set_side(bones::Side side) {
  if (state_ == State::Asking) said_side_ = side;
}

void ImportWork::save(const fs::path& folder, const std::string& name) {
  if (state_ != State::Asking) return;
  importing::BoneImport import = result_;
  if (said_side_) importing::say_side(import, *said_side_);
  if (!import.side) return;
  state_ = State::Saving;
  failure_ = {};
  folder_ = folder;
  saving_.start(
      [folder, name, import = std::move(import), root = sources_.root] {
        files::create_private_folder(folder.parent_path());
        importing::add_to_case(folder, import, name, root);
      },
      wake_);
}

void ImportWork::poll() {
  if (series_ != nullptr) series_->poll();
  if (state_ == State::Looking) take_sources();
  if (state_ != State::Looking && series_ != nullptr) note_pictures();
  if (state_ == State::Running) take_bones();
  if (state_ == State::Saving && saving_.is_ready()) {
    try {  // the top of the saving thread
      saving_.take();
      state_ = State::Done;
    } catch (const std::exception& error) {
      failure_ = {.words = error.what()};
      state_ = State::Asking;
    }
  }
}

bool ImportWork::is_busy() const {
  return state_ == State::Looking || state_ == State::Running || state_ == State::Saving;
}

std::vector<std::string> ImportWork::doubts() const {
  std::vector<std::string> doubts;
  for (const importing::ImportedBone& bone : result_.bones)
    for (const cases::BoneDoubt& doubt : importing::doubts_with(
             result_, bone, said_side_ ? said_side_ : result_.side, said_side_.has_value()))
      doubts.push_back("The " + std::string(bones::to_text(bone.bone.kind)) + ": " + cases::words_of(doubt));
  return doubts;
}

fs::path new_case_folder(const fs::path& folder, const std::string& name) {
  std::string safe = name.empty() ? "Knee" : name;
  std::replace_if(
      safe.begin(), safe.end(), [](unsigned char c) { return c < 0x20 || c == '/' || c == '\\' || c == ':'; },
      '-');
  if (safe.front() == '.') safe.front() = '-';
  fs::path path = folder / (safe + ".arthro");
  std::error_code error;
  for (int i = 2; fs::exists(path, error); ++i) path = folder / (safe + " " + std::to_string(i) + ".arthro");
  return path;
}

fs::path cases_folder() { return open_case::built_in_case_folder().parent_path() / "cases"; }

}  // namespace arthronaut::start
