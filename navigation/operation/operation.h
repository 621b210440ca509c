// The operation on one bone: everything between a frame and what may be shown.
//
// State and an input (a source, a frame, a command, an outcome of the registration) give the next state and
// effects. There is no thread, no clock and no file in here: the same inputs in the same order give the same
// states to the last bit, which is what replay, resuming after a crash and the tests rest on. The window, the
// command line, the demo and replay run this class and nothing beside it.
//
//   Operation operation(setup);
//   operation.start_source(source);
//   for each frame:  operation.take_outcome(newest);  operation.apply(command)...;  operation.process(frame);
//                    work.post(operation.take_requests());  record(operation.take_journal());
//                    show(operation.state());
// Second looks at the medium go the same way: take_look_request() after a frame, take_look() before another.
//
// Strokes, registrations and touches outlive the source: one that ends takes nothing of it away, and another
// one is judged by what it is of (registration/provenance.h).
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "navigation/camera/frame.h"
#include "navigation/operation/journal_entry.h"
#include "navigation/operation/medium_look.h"
#include "navigation/operation/operation_state.h"
#include "navigation/operation/picture_timing.h"
#include "navigation/operation/registration_work.h"
#include "navigation/operation/seen_drift.h"

namespace arthronaut::operation {

struct OperationSetup {
  bones::BoneKind bone = bones::BoneKind::Femur;
  std::string mesh_sha256;                           // of the bone's mesh; empty: not known
  std::shared_ptr<const geometry::Surface> surface;  // null: touches are not judged
  std::optional<registration::CartilageRegion> cartilage;
  std::optional<PlannedTunnel> plan;
  std::uint64_t seed = 1;
  TouchLimits limits;
  // Nobody is at the pedal: while the guide is seen and no registration of all strokes stands, one is asked
  // for whenever the probe has drawn this much more.
  std::optional<double> registers_after_mm;
  // A run from a record: that the bone has moved, or looks otherwise, and that what was measured was measured
  // through the wrong medium, is told by tell_bone_moved(), tell_bone_looks() and tell_medium_wrong() alone,
  // whatever pictures show.
  bool hears_of_drifts = false;
};
// What a registration found with this source is of.
[[nodiscard]] registration::Provenance provenance_of(const OperationSetup& setup, const SourceSetup& source,
                                                     int placement = 0);
// What the registration of such an operation works with.
[[nodiscard]] RegistrationWorkOptions work_options(const OperationSetup& setup);

class Operation {
 public:
  explicit Operation(OperationSetup setup);
  ~Operation();
  Operation(const Operation&) = delete;
  Operation& operator=(const Operation&) = delete;

  // From now on frames are of this source. What was found with another camera, probe, medium, marker or kind
  // of source is void at once; strokes drawn there are set aside. Throws InvalidInput when the options break
  // their contract (no world marker for the bone, unusable calibration); the state is then as before.
  void start_source(const SourceSetup& source);
  // No more frames: nothing of the last one is valid any more. No effect without a source.
  void end_source();
  // Frames in order of time. Throws InvalidInput when the frame's size is not the camera's.
  // Precondition: a source was started. outside: as NavigationPipeline::process() takes it. timing: empty: in
  // time, as what is not live always is.
  void process(const camera::Frame& frame, const tracker::TrackerPoses* outside = nullptr,
               const AskTiming& timing = {});
  // Never throws: what can't be done now changes nothing, or says so in the state.
  void apply(const Command& command);
  // The newest one that the registration has published; one that was taken in already changes nothing. Null
  // is ignored.
  void take_outcome(const OutcomePtr& outcome);

  // What the pictures so far have shown takes effect: that the bone has moved, or the medium is wrong. The
  // next frame or command does so, too; who records calls it before, since it belongs after the picture that
  // showed it.
  void heed_pictures();

  // A frame of a record instead of a picture: for resuming and for replay where no picture was kept.
  // `result` as process() made it.
  void process_recorded(const pipeline::FrameResult& result);

  // What was seen of the picture that take_look_request() asked for; anything else, and null, is ignored.
  void take_look(const MediumLookPtr& look);

  // That the picture showed the bone so far from where it lay, as the journal of another run says: for frames
  // of a record. Nothing without a registration that stands, or where a picture has just told it.
  void tell_bone_moved(const SeenDrift& drift);
  // The same of a bone that does not look as it did, or does again.
  void tell_bone_looks(const SeenLooks& looks);
  // And that the medium was wrong: what was measured since is gone.
  void tell_medium_wrong(const SeenMedium& medium);

  // The picture of the newest frame is to be seen in the other medium; once for each.
  [[nodiscard]] std::optional<MediumLookRequest> take_look_request();
  // Since the last call, in order.
  [[nodiscard]] std::vector<RegistrationRequest> take_requests();
  [[nodiscard]] std::vector<JournalEntry> take_journal();

  // The state as it is now, whole. Never null.
  [[nodiscard]] OperationStatePtr state();
  [[nodiscard]] const pipeline::FrameResult& frame() const;  // the newest, without a copy
  [[nodiscard]] const strokes::Curves& points() const;  // all that was drawn, in the world marker's frame
  [[nodiscard]] strokes::Curves strokes_in_use() const;
  [[nodiscard]] const OperationSetup& setup() const;
  [[nodiscard]] const OutcomePtr& outcome() const;  // the newest that was taken in; null before the first
  [[nodiscard]] const registration::Provenance& now() const;  // what the pictures are of

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace arthronaut::operation
