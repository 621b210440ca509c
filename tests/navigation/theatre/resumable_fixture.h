// A case's records of scripted operations, and what find_resumable() says of them.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>

#include "navigation/recording/operation_record.h"
#include "navigation/recording/resumable.h"
#include "planning/cases/case.h"
#include "tests/navigation/operation/phantom_operation.h"
#include "tests/temporary_folder.h"

namespace arthronaut::recording {

using namespace operation;
using arthronaut::registration::phantom_bone;
using sources::SourceKind;
using test::PhantomOperation;

class ResumableTest : public ::testing::Test {
 protected:
  // A source of the operation from here on, in a record of its own.
  void begin(PhantomOperation& run, const SourceSetup& source) {
    end(run);
    const std::filesystem::path folder = cases::create_session_folder(folder_.path());
    sources::SourceInfo info;
    info.name = source_name_;
    record_ = std::make_unique<OperationRecord>(folder, run.operation().setup(), source, info, continues_);
    continues_ = folder.filename().string();
    if (!early_.empty()) record_->add(std::exchange(early_, {}));
    run.on_journal = [this](const auto& entries) { record_->add(entries); };
    run.on_frame = [this](const OperationState& state) { record_->add_frame(nullptr, state, false); };
    run.start(source);
  }
  void end(PhantomOperation& run) {
    if (record_ == nullptr) return;
    run.operation().end_source();
    record_->add(run.operation().take_journal());
    record_->finish(run.operation().strokes_in_use());
    record_.reset();
    run.on_frame = {};
  }
  // Another program: what is given before its first source goes to the record of that one.
  void resume(PhantomOperation& run, const ResumeOperation& left) {
    run.on_journal = [this](const auto& entries) {
      early_.insert(early_.end(), entries.begin(), entries.end());
    };
    run.apply(left);
    continues_ = left.session;
  }
  [[nodiscard]] std::optional<Resumable> found(const std::string& mesh = "the phantom's") const {
    return search(mesh).left;
  }
  [[nodiscard]] ResumeSearch search(const std::string& mesh = "the phantom's") const {
    return find_resumable(folder_.path(), bones::BoneKind::Femur, mesh, planned_);
  }
  [[nodiscard]] GiveRegistration given(PhantomOperation& run, const SourceSetup& source) const {
    return test::true_registration(trial_, provenance_of(run.operation().setup(), source));
  }
  [[nodiscard]] strokes::Curves part(std::ptrdiff_t from, std::ptrdiff_t to) const {
    return {trial_.curves.begin() + from, trial_.curves.begin() + to};
  }
  // Strokes, a registration, two touches and a control point.
  void operate(PhantomOperation& run, const SourceSetup& source) {
    begin(run, source);
    run.draw(part(0, 150));
    run.apply(Draw{false});
    run.apply(given(run, source));
    run.touch(test::on_bone(trial_, 0));
    run.touch(test::on_bone(trial_, 5));
    run.touch(test::on_bone(trial_, 2), TouchControlPoint{});
  }

  const test::TemporaryFolder folder_;
  experiments::Trial trial_ = phantom_bone().trial(experiments::TrialNoise::Dry, 1);
  std::unique_ptr<OperationRecord> record_;
  std::vector<JournalEntry> early_;
  std::string continues_, source_name_ = "script";
  std::vector<tunnels::TunnelKey> planned_{bones::BoneKind::Femur};
};

}  // namespace arthronaut::recording
