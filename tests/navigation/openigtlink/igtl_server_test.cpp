// Read back by the library's own client, as 3D Slicer does.
#include "navigation/openigtlink/igtl_server.h"

#include <gtest/gtest.h>
#include <igtlClientSocket.h>
#include <igtlMessageHeader.h>
#include <igtlStatusMessage.h>
#include <igtlTransformMessage.h>

#include <chrono>
#include <map>
#include <thread>

#include "navigation/openigtlink/named_transforms.h"
#include "planning/geometry/error.h"

namespace arthronaut::openigtlink {
namespace {

geometry::RigidTransform made_pose(double seed) {
  const Eigen::Vector3d axis = Eigen::Vector3d(1, seed, -0.5).normalized();
  return {Eigen::Quaterniond(Eigen::AngleAxisd(0.3 + 0.1 * seed, axis)), {10 * seed, -20, 35 + seed}};
}

// Probe and guide are seen, the drill is not; a registration stands.
operation::OperationState made_state() {
  operation::OperationState state;
  auto source = std::make_shared<operation::SourceSetup>();
  tools::Tool probe, guide, drill;
  probe.name = "probe";
  probe.marker_id = 2;
  guide.name = "femoral guide";
  guide.marker_id = 3;
  drill.name = "drill";
  drill.marker_id = 9;
  probe.tip_mm = Eigen::Vector3d(0, -38, -6);
  drill.kind = tools::ToolKind::Drill;
  source->pipeline.tools.tools = {probe, guide, drill};
  state.source = source;
  state.has_source = true;
  state.frame_count = 1;
  state.frame.camera_from_world = {made_pose(1), 0, true};
  state.frame.tools = {
      {2, {made_pose(2), 0, true}}, {3, {made_pose(3), 0, true}}, {9, {made_pose(4), 0, false}}};
  auto registered = std::make_shared<operation::RegistrationState>();
  auto found = std::make_shared<registration::RegistrationSummary>();
  found->marker_from_bone = made_pose(5);
  registered->in_force.registration = found;
  registered->in_force.standing = operation::Standing::Stands;
  state.registration = registered;
  state.frame.guidance.state = guidance::GuidanceState::GuideLost;
  return state;
}

struct Client {
  explicit Client(int port) {
    EXPECT_EQ(socket->ConnectToServer("127.0.0.1", port), 0);
    socket->SetReceiveTimeout(5000);
  }
  // The next message; false when the connection has ended.
  bool receive() {
    const auto header = igtl::MessageHeader::New();
    header->InitPack();
    if (socket->Receive(header->GetPackPointer(), header->GetPackSize()) != header->GetPackSize())
      return false;
    header->Unpack();
    name = header->GetDeviceName();
    const std::string type = header->GetDeviceType();
    const auto read = [&](igtl::MessageBase& message) {
      message.SetMessageHeader(header);
      message.AllocatePack();
      socket->Receive(message.GetPackBodyPointer(), message.GetPackBodySize());
      return (message.Unpack(1) & igtl::MessageHeader::UNPACK_BODY) != 0;  // with its checksum
    };
    auto time = igtl::TimeStamp::New();
    header->GetTimeStamp(time);
    time_s = time->GetTimeStamp();
    if (type == "TRANSFORM") {
      const auto message = igtl::TransformMessage::New();
      if (!read(*message)) return false;
      message->GetMatrix(matrix);
      return true;
    }
    const auto message = igtl::StatusMessage::New();
    if (type != "STATUS" || !read(*message)) return false;
    code = message->GetCode();
    reason = message->GetStatusString();
    return true;
  }
  igtl::ClientSocket::Pointer socket = igtl::ClientSocket::New();
  std::string name, reason;
  igtl::Matrix4x4 matrix = {};
  int code = 0;
  double time_s = 0;
};

void wait_for_clients(const IgtlServer& server, std::size_t count) {
  const auto until = std::chrono::steady_clock::now() + std::chrono::seconds(10);
  while (server.client_count() != count && std::chrono::steady_clock::now() < until)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  ASSERT_EQ(server.client_count(), count);
}

// A point of the bone goes the same way by Slicer's coordinates as by ours.
TEST(RasFromLps, IsTheSameMotionInTheOtherAxes) {
  const Eigen::Vector3d flip(-1, -1, 1), point(3, -7, 11);
  const geometry::RigidTransform lps = made_pose(2), ras = ras_from_lps(lps);
  const Eigen::Vector3d in_ras = ras * point.cwiseProduct(flip);
  EXPECT_LT((in_ras - (lps * point).cwiseProduct(flip)).norm(), 1e-12);
}

TEST(NamedTransforms, HoldWhatIsValidAndNothingElse) {
  operation::OperationState state = made_state();
  std::map<std::string, geometry::RigidTransform> named;
  for (const NamedTransform& t : named_transforms(state)) named[t.name] = t.target_from_source;
  ASSERT_EQ(named.size(), 4U);
  EXPECT_TRUE(named.contains("WorldFemur") && named.contains("Guide_World") && named.contains("Bone_World"));
  const Eigen::Vector3d tip_in_world = made_pose(2) * Eigen::Vector3d(0, -38, -6);
  EXPECT_LT(
      (named.at("ProbeTip_World").translation_mm - tip_in_world.cwiseProduct(Eigen::Vector3d(-1, -1, 1)))
          .norm(),
      1e-12);
  auto doubted = std::make_shared<operation::RegistrationState>(*state.registration);
  doubted->in_force.standing = operation::Standing::Void;
  state.registration = doubted;
  state.frame.camera_from_world.is_valid = false;
  for (const NamedTransform& t : named_transforms(state)) {
    EXPECT_NE(t.name, "Bone_World");
    EXPECT_NE(t.name, "WorldFemur");
  }
  state.has_source = false;
  EXPECT_TRUE(named_transforms(state).empty());
}

TEST(IgtlServer, SendsPosesAndStatusToEveryClient) {
  IgtlServer server(0);
  Client one(server.port()), two(server.port());
  wait_for_clients(server, 2);
  const auto state = std::make_shared<const operation::OperationState>(made_state());
  server.publish(state, 1'700'000'000.25);
  const auto named = named_transforms(*state);
  for (Client* client : {&one, &two}) {
    for (const NamedTransform& expected : named) {
      ASSERT_TRUE(client->receive());
      EXPECT_EQ(client->name, expected.name);
      EXPECT_NEAR(client->time_s, 1'700'000'000.25, 1e-3);
      const Eigen::Matrix3d rotation = expected.target_from_source.matrix();
      // The protocol's numbers are single precision.
      for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 3; ++column)
          EXPECT_NEAR(client->matrix[row][column], rotation(row, column), 1e-6);
        EXPECT_NEAR(client->matrix[row][3], expected.target_from_source.translation_mm[row], 1e-4);
      }
    }
    ASSERT_TRUE(client->receive());
    EXPECT_EQ(client->name, "Arthronaut");
    EXPECT_EQ(client->code, igtl::StatusMessage::STATUS_NOT_READY);
    EXPECT_EQ(client->reason, guidance::to_text(guidance::GuidanceState::GuideLost));
  }
}

// One of two never reads. The other one gets everything, and the lazy one is let go.
TEST(IgtlServer, AClientThatStallsDelaysNobody) {
  IgtlServer server(0);
  Client lazy(server.port()), eager(server.port());
  wait_for_clients(server, 2);
  const auto state = std::make_shared<const operation::OperationState>(made_state());
  const std::size_t messages_each = named_transforms(*state).size() + 1;
  constexpr int kStates = 20'000;  // 10 MB: more than a socket holds
  std::thread publisher([&] {
    for (int i = 0; i < kStates; ++i) server.publish(state, i);
  });
  for (std::size_t i = 0; i < kStates * messages_each; ++i) ASSERT_TRUE(eager.receive()) << i;
  EXPECT_EQ(eager.time_s, kStates - 1);
  publisher.join();
  wait_for_clients(server, 1);
}

TEST(IgtlServer, APortThatIsTakenIsSaid) {
  const IgtlServer server(0);
  EXPECT_THROW(IgtlServer(server.port()), DeviceError);
}

TEST(IgtlServer, AClientMayGoAtAnyTime) {
  IgtlServer server(0);
  {
    Client client(server.port());
    wait_for_clients(server, 1);
  }
  const auto state = std::make_shared<const operation::OperationState>(made_state());
  for (int i = 0; i < 100; ++i) {
    server.publish(state, i);
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  wait_for_clients(server, 0);
}

}  // namespace
}  // namespace arthronaut::openigtlink
