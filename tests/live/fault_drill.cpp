#include "tests/live/fault_drill.h"

#include <unistd.h>

#include <chrono>
#include <stdexcept>
#include <thread>

#include "planning/geometry/error.h"
#include "tests/live/marker_scene.h"

namespace arthronaut::test {

namespace {

using theatre::LiveOperation;
using theatre::LiveState;
using theatre::SourceTrouble;

operation::PlannedTunnel plan() {
  operation::PlannedTunnel plan;
  plan.tunnel.entry_mm = {8, -5, 2};
  plan.tunnel.direction = {0, -1, 0};
  plan.length_mm = 30;
  return plan;
}

theatre::TheatreSource source_at(int port) {
  theatre::TheatreSource source;
  source.setup.kind = sources::SourceKind::Live;
  source.setup.pipeline.calibration = scene_camera();
  source.setup.pipeline.tools = scene_tools();
  source.setup.pipeline.follow_lens = false;
  source.setup.draws = false;
  source.patience_s = 20;
  source.open = [port] {
    return sources::open_stream("rtsp://127.0.0.1:" + std::to_string(port) + "/scope");
  };
  return source;
}

operation::GiveRegistration registration_of(const operation::OperationSetup& setup,
                                            const operation::SourceSetup& source) {
  operation::GiveRegistration give;
  give.registration.has_pose = give.registration.reliable = true;
  give.registration.reasons.clear();
  give.registration.covariance = geometry::Matrix6d::Identity() * 1e-4;
  give.registration.predicted_tre_mm = 0.3;
  give.of = operation::provenance_of(setup, source);
  return give;
}

SourceTrouble expected(Fault fault) {
  switch (fault) {
    case Fault::Black:
      return SourceTrouble::Plain;
    case Fault::Frozen:
      return SourceTrouble::Frozen;
    case Fault::Torn:
      return SourceTrouble::Torn;
    case Fault::Repeated:
      return SourceTrouble::Repeated;
    default:
      return SourceTrouble::NoPicture;
  }
}

}  // namespace

std::string to_text(Fault fault) {
  constexpr const char* kNames[kFaultCount] = {"killed and restarted",
                                               "hangs",
                                               "stalls",
                                               "other codec",
                                               "other size",
                                               "black",
                                               "frozen",
                                               "torn",
                                               "repeated"};
  return kNames[static_cast<int>(fault)];
}

FaultDrill::FaultDrill(const std::string& codec)
    : port_(20000 + ::getpid() % 40000),
      codec_(codec),
      sender_(std::make_unique<SenderProcess>(port_, codec)) {
  theatre::LiveOptions options;
  options.operation.plan = plan();
  options.bone = []() -> operation::SurfaceIndexPtr { throw InvalidInput("no bone is needed here"); };
  live_ = std::make_unique<LiveOperation>(options, [] {});
  const theatre::TheatreSource source = source_at(port_);
  live_->start(source);
  live_->apply(registration_of(options.operation, source.setup));
  live_->apply(operation::ConfirmTimeOut{});
  if (seconds_until(LiveOperation::now_s(), 60, [this] { return guides(); }) < 0)
    throw std::runtime_error("does not guide: " + live_->latest()->message + " " +
                             live_->latest()->trouble_words);
}

FaultDrill::~FaultDrill() = default;

bool FaultDrill::guides() const {
  const theatre::LiveStatePtr live = live_->latest();
  return live->phase == LiveState::Phase::Running && live->picture != nullptr &&
         live->age_s(LiveOperation::now_s()) <= live->stale_after_s &&
         live->operation->frame.guidance.is_valid();
}

template <typename Condition>
double FaultDrill::seconds_until(double from_s, double patience_s, const Condition& condition) const {
  while (!condition()) {
    if (LiveOperation::now_s() - from_s > patience_s) return -1;
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  return LiveOperation::now_s() - from_s;
}

void FaultDrill::begin(Fault fault) {
  switch (fault) {
    case Fault::Killed:
    case Fault::OtherCodec:
      return sender_.reset();
    case Fault::Hangs:
      return sender_->stop();
    case Fault::Stalled:
      return sender_->say("stalled");
    case Fault::OtherSize:
      return sender_->say("small");
    case Fault::Black:
      return sender_->say("black");
    case Fault::Frozen:
      return sender_->say("frozen");
    case Fault::Torn:
      return sender_->say("torn");
    case Fault::Repeated:
      return sender_->say("repeated");
  }
}

void FaultDrill::end(Fault fault) {
  switch (fault) {
    case Fault::Killed:
      sender_ = std::make_unique<SenderProcess>(port_, codec_);
      return;
    case Fault::OtherCodec:
      sender_ = std::make_unique<SenderProcess>(port_, "vp8");
      return;
    case Fault::Hangs:
      return sender_->go_on();
    default:
      return sender_->say("live");
  }
}

FaultOutcome FaultDrill::run(Fault fault, double lasts_s, double patience_s) {
  FaultOutcome outcome;
  outcome.fault = fault;
  const double began_s = LiveOperation::now_s();
  begin(fault);
  const bool takes_guidance = fault != Fault::Torn && fault != Fault::Repeated;
  if (takes_guidance) outcome.gone_s = seconds_until(began_s, patience_s, [this] { return !guides(); });
  outcome.told_s = seconds_until(began_s, patience_s, [&] {
    const theatre::LiveStatePtr live = live_->latest();
    if (live->trouble != expected(fault)) return false;
    outcome.words = live->trouble_words;
    return true;
  });
  (void)seconds_until(began_s, lasts_s, [] { return false; });
  end(fault);
  const double well_s = LiveOperation::now_s();
  outcome.back_s = seconds_until(well_s, patience_s, [this] { return guides(); });
  if (fault == Fault::OtherCodec) {  // what follows is of the first one again
    sender_.reset();
    end(Fault::Killed);
  }
  // The next one is told anew.
  (void)seconds_until(well_s, patience_s, [this] {
    const theatre::LiveStatePtr live = live_->latest();
    return live->trouble == SourceTrouble::None && guides();
  });
  return outcome;
}

}  // namespace arthronaut::test
