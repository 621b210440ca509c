#include "app/start/import_work.h"

#include <algorithm>
#include <chrono>
#include <mutex>
#include <utility>

#include "app/case/case_opening.h"
#include "planning/files/private_folder.h"
#include "planning/import/case_import.h"

namespace arthronaut::start {

namespace fs = std::filesystem;

struct ImportWork::Pictures {
  std::atomic<bool> stops{false};
  mutable std::mutex mutex;  // of the list; a picture that is there stays where it is
  std::vector<std::unique_ptr<images::Thumbnail>> made;
};

namespace {

struct Stopped {};

bool is_ready(const auto& future) {
  return future.valid() && future.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
}

}  // namespace

ImportWork::ImportWork(std::function<void()> wake, fs::path program)
    : wake_(std::move(wake)), program_(std::move(program)) {}

ImportWork::~ImportWork() { end_threads(); }

void ImportWork::end_threads() {
  stops_looking_ = true;
  if (pictures_ != nullptr) pictures_->stops = true;
  if (looking_.valid()) looking_.wait();
  if (painting_.valid()) painting_.wait();
  if (saving_.valid()) saving_.wait();
  looking_ = {};
  painting_ = {};
  saving_ = {};
  pictures_.reset();
  process_.reset();
}

void ImportWork::look_into(const fs::path& root) {
  end_threads();
  sources_ = {};
  result_ = {};
  failure_.clear();
  looked_ = 0;
  stops_looking_ = false;
  state_ = State::Looking;
  looking_ = std::async(std::launch::async, [this, root] {
    ImportSources found;
    found.root = root;
    try {
      found = find_import_sources(root, [this](double fraction) {
        if (stops_looking_) throw Stopped();
        looked_ = fraction;
      });
    } catch (const Stopped&) {
    } catch (const std::exception& error) {  // the top of a thread
      found.failure = error.what();
    }
    wake_();
    return found;
  });
}

void ImportWork::take_sources() {
  sources_ = looking_.get();
  failure_ = sources_.failure;
  state_ = State::Choosing;
  pictures_ = std::make_shared<Pictures>();
  pictures_->made.resize(sources_.sources.size());
  painting_ =
      std::async(std::launch::async, [pictures = pictures_, sources = sources_.sources, wake = wake_] {
        for (std::size_t i = 0; i < sources.size() && !pictures->stops; ++i) {
          if (!sources[i].series) continue;
          try {
            auto picture = std::make_unique<images::Thumbnail>(images::thumbnail_of(*sources[i].series));
            const std::lock_guard lock(pictures->mutex);
            pictures->made[i] = std::move(picture);
          } catch (const std::exception&) {  // a list without this picture says why by the series' refusal
            continue;
          }
          wake();
        }
      });
}

const images::Thumbnail* ImportWork::thumbnail(std::size_t source) const {
  if (pictures_ == nullptr || source >= sources_.sources.size()) return nullptr;
  const std::lock_guard lock(pictures_->mutex);
  return pictures_->made[source].get();
}

void ImportWork::start(const ImportWishes& wishes) {
  if (state_ != State::Choosing || wishes.sources.empty()) return;
  wishes_ = wishes;
  next_ = 0;
  result_ = {};
  failure_.clear();
  state_ = State::Running;
  start_next();
}

void ImportWork::start_next() {
  const ImportSource& source = sources_.sources.at(wishes_.sources[next_]);
  importing::BoneImportOptions options;
  options.side = wishes_.side;
  options.threshold = wishes_.threshold;
  if (source.series) options.series = source.series->uid;
  options.kind = source.bone;
  progress_ = {};
  try {
    process_ = std::make_unique<importing::ImportProcess>(
        importing::ImportRequest{.source = source.source, .options = options, .program = program_});
  } catch (
      const std::exception& error) {  // no process could be started: said as any other failure of the import
    failure_ = error.what();
    state_ = State::Choosing;
  }
}

void ImportWork::take_bones() {
  using Process = importing::ImportProcess;
  const Process::State state = process_->poll();
  progress_ = process_->progress();
  if (state == Process::State::Running) return;
  if (state != Process::State::Done) {
    failure_ = process_->message();
    state_ = State::Choosing;
    process_.reset();
    return;
  }
  importing::BoneImport made = process_->take_result();
  process_.reset();
  if (next_ == 0) {
    result_ = std::move(made);
  } else {  // another mesh of the same knee
    if (result_.side && made.side && *result_.side != *made.side) {
      failure_ = "the meshes are of different sides: " + sources_.sources.at(wishes_.sources[next_]).title;
      state_ = State::Choosing;
      return;
    }
    if (!result_.side) result_.side = made.side;
    result_.bones.insert(result_.bones.end(), made.bones.begin(), made.bones.end());
    result_.lines.insert(result_.lines.end(), made.lines.begin(), made.lines.end());
  }
  if (++next_ < wishes_.sources.size())
    start_next();
  else
    state_ = State::Asking;
}

void ImportWork::cancel() {
  if (state_ == State::Looking) {
    end_threads();
    state_ = State::Idle;
  } else if (state_ == State::Running || state_ == State::Asking) {
    process_.reset();  // ends the child
    failure_.clear();
    state_ = State::Choosing;
  }
}

void ImportWork::set_side(bones::Side side) {
  if (state_ == State::Asking) result_.side = side;
}

void ImportWork::save(const fs::path& folder, const std::string& name) {
  if (state_ != State::Asking || !result_.side) return;
  state_ = State::Saving;
  failure_.clear();
  folder_ = folder;
  importing::BoneImport import = result_;
  if (!wishes_.keeps_identity) import.identity = {};
  saving_ =
      std::async(std::launch::async, [this, folder, name, import = std::move(import), root = sources_.root] {
        const struct AtEnd {
          const std::function<void()>& call;
          ~AtEnd() { call(); }
        } at_end{wake_};
        files::create_private_folder(folder.parent_path());
        importing::add_to_case(folder, import, name, root);
      });
}

void ImportWork::poll() {
  if (state_ == State::Looking && is_ready(looking_)) take_sources();
  if (state_ == State::Running) take_bones();
  if (state_ == State::Saving && is_ready(saving_)) {
    try {  // the top of the saving thread
      saving_.get();
      state_ = State::Done;
    } catch (const std::exception& error) {
      failure_ = error.what();
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
    for (const std::string& doubt : bone.doubts)
      doubts.push_back("The " + std::string(bones::to_text(bone.bone.kind)) + ": " + doubt);
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
