// What goes out while Navigate runs, read by a client that knows the protocol's bytes and nothing of us.
#include "app/navigate/pose_sharing.h"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <string>
#include <thread>
#include <vector>

#include "app/navigate/navigate_display.h"
#include "planning/geometry/error.h"

namespace arthronaut::navigate {
namespace {

using Phase = theatre::LiveState::Phase;

// OpenIGTLink, version 1: 58 bytes of header (version, type, device, time, size, checksum), then the body.
class Listener {
 public:
  explicit Listener(int port) : socket_(socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    const timeval patience{5, 0};
    setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
    EXPECT_EQ(connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  }
  ~Listener() { close(socket_); }
  Listener(const Listener&) = delete;
  Listener& operator=(const Listener&) = delete;

  // The devices that were heard before the next STATUS of the operation, "NAME is none" where that is said,
  // and then "STATUS: ..." with its words.
  std::vector<std::string> until_status() {
    std::vector<std::string> heard;
    for (;;) {
      const std::string header = bytes(58);
      if (header.empty()) return {"nothing"};
      std::uint64_t size = 0;
      for (std::size_t i = 42; i < 50; ++i) size = size << 8U | static_cast<unsigned char>(header[i]);
      const std::string body = bytes(size);
      const std::string device = header.substr(14, 20).c_str();
      if (std::string(header.substr(2, 12).c_str()) == "STATUS") {
        if (device != "Arthronaut") {
          if (body[1] != 1) heard.push_back(device + " is none");
          continue;
        }
        heard.push_back("STATUS: " + std::string(body.substr(30).c_str()));
        return heard;
      }
      heard.push_back(device);
    }
  }

 private:
  std::string bytes(std::size_t count) const {
    std::string read(count, '\0');
    return recv(socket_, read.data(), count, MSG_WAITALL) == static_cast<ssize_t>(count) ? read : "";
  }
  int socket_;
};

theatre::LiveState running(bones::BoneKind bone) {
  operation::OperationState state;
  state.bone = bone;
  auto source = std::make_shared<operation::SourceSetup>();
  source->kind = sources::SourceKind::Live;
  state.source = source;
  state.has_source = true;
  state.frame_count = 1;
  state.frame.camera_from_world.is_valid = state.frame.intrinsics_are_known = true;
  state.frame.guidance.state = guidance::GuidanceState::GuideLost;
  theatre::LiveState live;
  live.phase = Phase::Running;
  live.operation = std::make_shared<const operation::OperationState>(state);
  live.picture = std::make_shared<const camera::Frame>();
  live.captured_s = theatre::LiveOperation::now_s();
  live.stale_after_s = 60;
  return live;
}

class PoseSharingTest : public ::testing::Test {
 protected:
  void SetUp() override {
    for (int i = 0; i < 500 && sharing_.words().find(", 1 listen") == std::string::npos; ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    ASSERT_EQ(sharing_.words(), "port " + std::to_string(sharing_.port()) + ", this machine, 1 listen");
  }
  PoseSharing sharing_{0};
  Listener listener_{sharing_.port()};
};

// A picture goes out once with its poses; what is done meanwhile is told without them.
TEST_F(PoseSharingTest, TellsEachPictureOnceAndEveryChange) {
  const theatre::LiveState live = running(bones::BoneKind::Femur);
  sharing_.tell(live);
  const std::vector<std::string> first = listener_.until_status();
  EXPECT_NE(std::find(first.begin(), first.end(), "WorldFemur"), first.end());
  EXPECT_EQ(first.back(), "STATUS: " + std::string(to_text(guidance::GuidanceState::GuideLost)));
  sharing_.tell(live);
  EXPECT_EQ(listener_.until_status(), std::vector{first.back()}) << "no pose is sent twice";
}

// What the screen hides is no pose for others: they are told why there is none.
TEST_F(PoseSharingTest, Hazard3ALatePictureIsNotSentAsLive) {
  theatre::LiveState live = running(bones::BoneKind::Femur);
  live.captured_s -= 100;
  sharing_.tell(live);
  const std::vector<std::string> heard = listener_.until_status();
  for (const std::string& words : heard) EXPECT_TRUE(words.ends_with(" is none") || words == heard.back());
  EXPECT_TRUE(heard.back().starts_with("STATUS: No new picture for 100 s")) << heard.back();
  live.phase = Phase::Ended;
  sharing_.tell(live);
  EXPECT_EQ(listener_.until_status(), std::vector<std::string>{"STATUS: The pictures have ended"});
}

// A client goes on showing what came last: it is told in which moment there is none any more.
TEST_F(PoseSharingTest, Hazard49APoseThatWasSentIsTakenBack) {
  theatre::LiveState live = running(bones::BoneKind::Femur);
  sharing_.tell(live);
  (void)listener_.until_status();
  sharing_.tell(live);  // no other picture yet
  EXPECT_EQ(listener_.until_status().size(), 1U);
  live.captured_s -= 100;
  sharing_.tell(live);
  EXPECT_EQ(listener_.until_status().front(), "WorldFemur is none");
}

// Of a source that is too slow the poses go out with their time, and STATUS says what the screen says.
TEST_F(PoseSharingTest, Hazard3StatusSaysThatASlowSourceDoesNotGuide) {
  theatre::LiveState live = running(bones::BoneKind::Femur);
  live.trouble = theatre::SourceTrouble::Slow;
  operation::OperationState state = *live.operation;
  state.timing = operation::PictureTiming::Slow;
  operation::RegistrationState registration;
  registration.in_force.standing = operation::Standing::Stands;
  state.registration = std::make_shared<const operation::RegistrationState>(registration);
  live.operation = std::make_shared<const operation::OperationState>(state);
  sharing_.tell(live);
  const std::vector<std::string> heard = listener_.until_status();
  EXPECT_NE(std::find(heard.begin(), heard.end(), "WorldFemur"), heard.end());
  const NavigateDisplay display = display_of(&live, theatre::LiveOperation::now_s());
  EXPECT_EQ(display.headline, "Pictures come too slowly");
  EXPECT_EQ(heard.back(), "STATUS: pictures come too slowly");
  sharing_.tell(live);  // no other picture yet
  EXPECT_EQ(listener_.until_status(), std::vector<std::string>{"STATUS: pictures come too slowly"});
}

// Of two operations the one that gives pictures is told: what becomes of the other one is no news.
TEST_F(PoseSharingTest, TheOtherBoneSaysNothing) {
  theatre::LiveState femur = running(bones::BoneKind::Femur);
  sharing_.tell(femur);
  (void)listener_.until_status();
  const theatre::LiveState tibia = running(bones::BoneKind::Tibia);
  sharing_.tell(tibia);
  (void)listener_.until_status();
  femur.phase = Phase::Ended;
  sharing_.tell(femur);
  sharing_.tell(running(bones::BoneKind::Tibia));
  const std::vector<std::string> heard = listener_.until_status();
  EXPECT_NE(std::find(heard.begin(), heard.end(), "WorldTibia"), heard.end());
}

// A port that somebody else has is told, and hinders nothing.
TEST_F(PoseSharingTest, APortThatIsTakenIsTold) {
  PoseSharing second(sharing_.port());
  EXPECT_EQ(second.port(), -1);
  EXPECT_NE(second.words().find(std::to_string(sharing_.port())), std::string::npos) << second.words();
  second.tell(running(bones::BoneKind::Femur));
  EXPECT_EQ(PoseSharing(-1).words(), "") << "nobody asked for it";
}

}  // namespace
}  // namespace arthronaut::navigate
