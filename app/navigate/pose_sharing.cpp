#include "app/navigate/pose_sharing.h"

#include <mutex>

#include "app/navigate/navigate_display.h"
#include "planning/files/utc_clock.h"
#include "planning/geometry/error.h"

namespace arthronaut::navigate {

struct PoseSharing::State {
  std::optional<openigtlink::IgtlServer> server;
  openigtlink::Reach reach{};
  std::string trouble;
  std::mutex mutex;        // of what follows
  bones::BoneKind bone{};  // whose operation gave pictures last
  camera::FramePtr last;   // that was sent: held, so that no other one comes to lie where it lay
};

PoseSharing::PoseSharing(int port, openigtlink::Reach reach) : state_(std::make_unique<State>()) {
  state_->reach = reach;
  if (port < 0) return;
  try {  // a port that is taken hinders nobody's operation
    state_->server.emplace(port, reach);
  } catch (const DeviceError& error) {
    state_->trouble = error.what();
  }
}
PoseSharing::~PoseSharing() = default;

void PoseSharing::tell(const theatre::LiveState& live) {
  if (!state_->server || live.phase == theatre::LiveState::Phase::NoSource) return;
  const std::lock_guard lock(state_->mutex);
  if (is_under_way(live)) state_->bone = live.operation->bone;
  if (state_->bone != live.operation->bone) return;
  const double now_s = theatre::LiveOperation::now_s();
  const NavigateDisplay display = display_of(&live, now_s);
  const bool is_new = live.picture != nullptr && live.picture != state_->last;
  if (display.is_live && is_new) {
    state_->server->publish(live.operation, files::utc_now_s() - live.age_s(now_s), live.picture);
  } else if (!display.is_live) {
    state_->server->tell({false, display.headline}, files::utc_now_s());
  } else {  // between its pictures
    state_->server->tell(openigtlink::status_of(*live.operation), files::utc_now_s(), live.operation);
  }
  state_->last = live.picture;
}

int PoseSharing::port() const { return state_->server ? state_->server->port() : -1; }

std::string PoseSharing::words() const {
  if (!state_->server) return state_->trouble;
  const bool is_network = state_->reach == openigtlink::Reach::Network;
  return "port " + std::to_string(port()) + (is_network ? ", whole network, " : ", this machine, ") +
         std::to_string(state_->server->client_count()) + " listen";
}

}  // namespace arthronaut::navigate
