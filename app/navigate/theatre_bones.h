// The operations of an open case, one a bone: each made when its bone is first looked at, kept while sources
// come and go, and told when the plan was edited.
//
// One thread, the window's; nothing here waits.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>

#include "app/case/plan_model.h"
#include "app/scene/plan_overlay.h"
#include "navigation/sources/background_end.h"
#include "navigation/theatre/live_operation.h"

namespace arthronaut::navigate {

// The plan's lines and the strokes, over the very picture that they were projected for. Apart: they may be
// shown as long as different things are true.
struct PictureLines : theatre::Decoration {
  scene::PlanOverlay plan, touched;
};

class TheatreBones {
 public:
  using Tell = std::function<void(const theatre::LiveState&)>;

  // wake: called from other threads whenever an operation has news; tell: with everything that it publishes.
  TheatreBones(std::function<void()> wake, Tell tell) : wake_(std::move(wake)), tell_(std::move(tell)) {}

  // Another case: ends what runs, in threads behind the screen. The model outlives this object's use of it.
  // read_only: why nothing may be written into the case; empty when it may.
  void open(const open_case::PlanModel* model, const std::filesystem::path& case_folder,
            const std::string& read_only);
  // Made when it is first asked for; made anew while nothing hangs on it and its plan has changed, or its
  // bone could not be made ready. Precondition: the model has the bone.
  theatre::LiveOperation& operation(bones::BoneKind bone);
  // The same, for whoever posts to it: before the operation has heard of that, it is not made anew any more.
  theatre::LiveOperation& used(bones::BoneKind bone);
  // Null when it was not asked for yet.
  [[nodiscard]] theatre::LiveOperation* known(bones::BoneKind bone) const;
  // What is known where no bone was looked at yet.
  [[nodiscard]] static theatre::LiveStatePtr nothing();
  // Which of the bone's planned tunnels is drilled: the one that was chosen, else the one that guides while a
  // source runs, else the only one. nullopt where none is planned, and where two are and nobody has chosen:
  // it is never guessed.
  [[nodiscard]] std::optional<tunnels::TunnelKey> guided(bones::BoneKind bone) const;
  [[nodiscard]] bool must_choose(bones::BoneKind bone) const;
  // From now on that one: an operation that runs is offered it at once, before anything that is posted to it
  // later, and guides by the one in force until the surgeon takes the other one over. Precondition: it is
  // planned.
  void choose(const tunnels::TunnelKey& key);
  // The case's plan for the tunnel that is drilled, where it is of this mesh: what an operation that begins
  // now guides by.
  [[nodiscard]] std::optional<operation::PlannedTunnel> plan_of(bones::BoneKind bone) const;
  // The same of any tunnel.
  [[nodiscard]] std::optional<operation::PlannedTunnel> planned(const tunnels::TunnelKey& key) const;
  // A plan that was edited is offered to the operation of its bone; it guides by the one in force until the
  // surgeon takes the other one over.
  void offer_plans();
  // The records that other programs left of each bone, now and for operations that are made later; see
  // theatre::OperationRun. Of a case that is read-only, no effect.
  void go_on_after(const std::map<bones::BoneKind, std::filesystem::path>& left);
  // Of all operations, from now on; see theatre::OperationRun.
  void keep_video(bool on);
  [[nodiscard]] bool keeps_video() const { return keeps_video_; }  // as it was asked for
  // Of all operations, from the next source of each on.
  void keep_pictures_as(recording::PicturesAs as);
  [[nodiscard]] recording::PicturesAs pictures_as() const { return pictures_as_; }

 private:
  struct Bone {
    std::unique_ptr<theatre::LiveOperation> operation;
    bool is_used = false;                    // something was posted to it
    std::uint64_t plan_revision = 0;         // of the model, when the plan was handed over last
    std::optional<tunnels::TunnelKey> told;  // which tunnel's that was
  };
  // By which a source that runs guides. It stays the one that is drilled when a second one is planned, as
  // long as that source runs; for the next one somebody has to choose.
  [[nodiscard]] std::optional<tunnels::TunnelKey> in_force_of_source(bones::BoneKind bone) const;
  void offer_plan(bones::BoneKind kind, Bone& bone);
  [[nodiscard]] bool is_told(bones::BoneKind kind, const Bone& bone) const;
  void note_told(bones::BoneKind kind, Bone& bone) const;
  [[nodiscard]] std::unique_ptr<theatre::LiveOperation> made(bones::BoneKind bone) const;
  [[nodiscard]] static bool is_worth_keeping(const theatre::LiveState& state);

  std::function<void()> wake_;
  Tell tell_;
  const open_case::PlanModel* model_ = nullptr;
  std::filesystem::path case_folder_;
  std::string read_only_;
  bool keeps_video_ = false;
  recording::PicturesAs pictures_as_ = recording::PicturesAs::AsTheyCame;
  std::map<bones::BoneKind, Bone> bones_;
  std::map<bones::BoneKind, tunnels::TunnelKey> chosen_;
  std::map<bones::BoneKind, std::filesystem::path> left_;  // records, by other programs
  sources::BackgroundEnd ending_;
};

}  // namespace arthronaut::navigate
