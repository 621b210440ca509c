#include "navigation/simulator/fault.h"

#include <algorithm>

#include "navigation/simulator/picture_faults.h"

namespace arthronaut::simulator {

namespace {

constexpr double kGrows_s = 1.5;

bool is_push(FaultKind kind) { return kind == FaultKind::BumpedMarker || kind == FaultKind::SlippedBoard; }

}  // namespace

std::string_view to_text(FaultKind kind) {
  switch (kind) {
    case FaultKind::Bleeding:
      return "bleeding";
    case FaultKind::Glare:
      return "glare";
    case FaultKind::BumpedMarker:
      return "bumped marker";
    case FaultKind::LostSource:
      return "lost source";
    case FaultKind::FoggedLens:
      return "fogged lens";
    case FaultKind::SlippedBoard:
      return "slipped board";
  }
  return "";
}

FaultPlay::FaultPlay(std::vector<Fault> faults, std::uint64_t seed) : seed_(seed) {
  for (const Fault& fault : faults) faults_.push_back({fault, std::nullopt});
}

bool FaultPlay::acts(const One& one) const {
  return one.began_s && (is_push(one.fault.kind) || time_s_ < *one.began_s + one.fault.duration_s);
}

unsigned FaultPlay::advance(double time_s, const std::function<bool(const Fault&)>& is_due,
                            const std::function<void(const Fault&)>& begins) {
  time_s_ = time_s;
  unsigned acting = 0;
  for (One& one : faults_) {
    if (!one.began_s) {
      const bool comes =
          one.fault.trigger == Fault::Trigger::AtTime ? time_s >= one.fault.after : is_due(one.fault);
      if (!comes) continue;
      one.began_s = time_s;
      begins(one.fault);
    }
    if (acts(one)) acting |= 1U << static_cast<unsigned>(one.fault.kind);
  }
  return acting;
}

void FaultPlay::spoil(camera::Frame& frame, std::uint64_t noise_seed) const {
  for (const One& one : faults_) {
    if (!acts(one)) continue;
    const double since_s = time_s_ - *one.began_s, left_s = one.fault.duration_s - since_s;
    const double grown = std::min({1.0, since_s / kGrows_s, left_s / kGrows_s});
    switch (one.fault.kind) {
      case FaultKind::Bleeding:
        add_bleeding(frame, seed_, since_s, grown * one.fault.strength);
        break;
      case FaultKind::Glare:
        add_glare(frame, seed_, since_s, one.fault.strength);
        break;
      case FaultKind::LostSource:
        black_out(frame, noise_seed);
        break;
      case FaultKind::FoggedLens:
        add_fog(frame, grown * one.fault.strength);
        break;
      case FaultKind::BumpedMarker:
      case FaultKind::SlippedBoard:
        break;
    }
  }
}

}  // namespace arthronaut::simulator
