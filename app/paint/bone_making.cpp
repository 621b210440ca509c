#include "app/paint/bone_making.h"

#include <algorithm>
#include <utility>

#include "planning/cases/study.h"
#include "planning/import/case_import.h"
#include "planning/painting/label_edits.h"
#include "planning/painting/painting_file.h"

namespace arthronaut::paint {

namespace {

using bones::BoneKind;
using painting::Layer;

constexpr std::pair<BoneKind, std::uint8_t> kBones[] = {{BoneKind::Femur, painting::kFemur},
                                                        {BoneKind::Tibia, painting::kTibia}};

}  // namespace

BoneMaking::BoneMaking(std::function<void()> wake, std::filesystem::path program)
    : wake_(std::move(wake)), program_(std::move(program)) {}

std::string BoneMaking::refusal(const cases::Case& knee, const painting::Painting& painting,
                                const std::vector<BoneKind>& unchanged) {
  if (!painting.holds(Layer::Bones)) return "Nothing is painted as bone yet: grow it, or paint it on Bones";
  const auto is_made = [&](BoneKind kind, std::uint8_t label) {
    return painting.holds(Layer::Bones, label) && std::ranges::find(unchanged, kind) == unchanged.end();
  };
  if (std::ranges::none_of(kBones, [&](const auto& bone) { return is_made(bone.first, bone.second); }))
    return "These are the bones of the case: correct them first";
  for (const auto& [kind, label] : kBones)
    if (is_made(kind, label) && !knee.plan.of(kind).empty())
      return "The " + std::string(bones::to_text(kind)) +
             " is planned on, and another surface would make its tunnel wrong: in Plan keep a version (K), "
             "then remove the tunnel (Delete)";
  return "";
}

void BoneMaking::start(const cases::Case& knee, const std::filesystem::path& case_folder,
                       const cases::CaseImage& image, const painting::Painting& painting,
                       const std::vector<BoneKind>& unchanged) {
  if (state_ == State::Saving) return;
  failure_.clear();
  qualities_.clear();
  progress_ = {};
  done_fraction_ = 0;
  result_ = {};
  folder_ = case_folder;
  image_file_ = image.file;
  side_ = knee.side;
  images_ = painting.shared_volume();
  constexpr double kMemory_gib = 4;  // the labels and a CT of 512 x 512 x 800
  importing::ImportRequest request;
  request.source = painting::bones_file(case_folder);
  request.options.side = knee.side;
  request.memory_limit_gib = kMemory_gib;
  request.program = program_;
  for (const auto& [kind, label] : kBones) {
    if (!painting.holds(Layer::Bones, label) || std::ranges::find(unchanged, kind) != unchanged.end())
      continue;
    request.options.labels[kind] = label;
    importing::BoneQuality& quality = qualities_.emplace_back();
    quality.kind = kind;
    quality.labelled_ml = painting::volume_ml(painting.labels(Layer::Bones), painting.volume(), label);
  }
  request.options.edges_in = case_folder / image.file;
  try {
    process_ = std::make_unique<importing::ImportProcess>(std::move(request));
    state_ = State::Making;
  } catch (const std::exception& error) {  // no process could be started: said as any other failure
    failure_ = error.what();
    state_ = State::Idle;
  }
}

void BoneMaking::cancel() {
  if (state_ != State::Making && state_ != State::Judging) return;
  process_.reset();  // ends the child
  state_ = State::Idle;
}

void BoneMaking::forget() {
  if (state_ != State::Done) return;
  state_ = State::Idle;
  result_ = {};
}

void BoneMaking::judge() {
  for (importing::BoneQuality& quality : qualities_)
    for (importing::ImportedBone& made : result_.bones) {
      if (made.bone.kind != quality.kind) continue;
      quality = importing::quality_of(result_, made, quality.labelled_ml, *images_);
      // After the lines are made of it, which say it by themselves: it stays with the bone, for Plan to say.
      for (std::string& doubt : importing::surface_doubts(quality)) made.doubts.push_back(std::move(doubt));
    }
}

void BoneMaking::save() {
  if (state_ != State::Judging) return;
  state_ = State::Saving;
  failure_.clear();
  saving_.start(
      [import = result_, folder = folder_, side = side_, image_file = image_file_]() mutable {
        import.side = side;
        import.side_source = importing::SideSource::None;  // what the case's side rests on, the case says
        import.image.reset();                              // the labels stay where they are painted
        // Bones that are painted in an image are of its study, whatever other images the case has.
        import.origin = cases::study_of_image(folder, image_file);
        importing::add_to_case(folder, import, "", painting::bones_file(folder));
      },
      wake_);
}

void BoneMaking::poll() {
  using Process = importing::ImportProcess;
  if (state_ == State::Making) {
    const Process::State state = process_->poll();
    progress_ = process_->progress();
    done_fraction_ = process_->done_fraction();
    if (state == Process::State::Running) return;
    if (state == Process::State::Done) {
      result_ = process_->take_result();
      judge();
      state_ = State::Judging;
    } else {
      failure_ = process_->message();
      state_ = State::Idle;
    }
    process_.reset();
  }
  if (state_ == State::Saving && saving_.is_ready()) {
    try {  // the top of the saving thread
      saving_.take();
      state_ = State::Done;
    } catch (const std::exception& error) {
      failure_ = error.what();
      state_ = State::Judging;
    }
  }
}

}  // namespace arthronaut::paint
