// Read back by the library's own client, as 3D Slicer does.
#include "navigation/openigtlink/igtl_server.h"

#include <gtest/gtest.h>
#include <igtlClientSocket.h>
#include <igtlImageMessage.h>
#include <igtlMessageHeader.h>
#include <igtlPointMessage.h>
#include <igtlStatusMessage.h>
#include <igtlTransformMessage.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <map>
#include <thread>
#include <vector>

#include "navigation/openigtlink/igtl_messages.h"
#include "navigation/openigtlink/igtl_reader.h"
#include "navigation/openigtlink/named_transforms.h"
#include "planning/geometry/error.h"
#include "tests/navigation/openigtlink/served_state.h"

namespace arthronaut::openigtlink {
namespace {

// STT_IMAGE, which the library does not have.
class StartImages : public igtl::HeaderOnlyMessageBase {
 public:
  using Self = StartImages;
  using Pointer = igtl::SmartPointer<Self>;
  igtlNewMacro(StartImages);

 protected:
  StartImages() { m_DefaultBodyType = "STT_IMAGE"; }
};

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
      if (message.GetPackBodySize() == 0) return true;  // a list without points
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
    if (type == "POINT") {
      const auto message = igtl::PointMessage::New();
      if (!read(*message)) return false;
      points.clear();
      for (int i = 0; i < message->GetNumberOfPointElement(); ++i) {
        auto element = igtl::PointElement::New();
        message->GetPointElement(i, element);
        Eigen::Vector3f& at = points[element->GetName()];
        element->GetPosition(at.x(), at.y(), at.z());
        radius_mm = element->GetRadius();
      }
      return true;
    }
    if (type == "IMAGE") {
      const auto message = igtl::ImageMessage::New();
      if (!read(*message)) return false;
      int size[3];
      message->GetDimensions(size);
      image_size = {size[0], size[1]};
      message->GetMatrix(matrix);
      const auto* const from = static_cast<const std::uint8_t*>(message->GetScalarPointer());
      rgb.assign(from, from + message->GetImageSize());
      return true;
    }
    const auto message = igtl::StatusMessage::New();
    if (type != "STATUS" || !read(*message)) return false;
    code = message->GetCode();
    reason = message->GetStatusString();
    return true;
  }
  template <typename Message>
  void ask() {
    const auto message = Message::New();
    message->SetDeviceName("Arthroscope");
    message->Pack();
    EXPECT_EQ(socket->Send(message->GetPackPointer(), message->GetPackSize()), 1);
  }
  igtl::ClientSocket::Pointer socket = igtl::ClientSocket::New();
  std::string name, reason;
  std::map<std::string, Eigen::Vector3f> points;
  float radius_mm = 0;
  std::array<int, 2> image_size{};
  std::vector<std::uint8_t> rgb;
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

// Everything until "Arthronaut": "name" of a transform, "name: why" of a status.
std::vector<std::string> next_state(Client& client) {
  std::vector<std::string> heard;
  for (;;) {
    client.reason.clear();
    client.code = 0;
    if (!client.receive()) return {"nothing"};
    if (client.name == "Arthronaut") return heard;
    heard.push_back(client.code == 0 ? client.name : client.name + ": " + client.reason);
  }
}

TEST(IgtlServer, SendsPosesAndStatusToEveryClient) {
  IgtlServer server(0);
  Client one(server.port()), two(server.port());
  wait_for_clients(server, 2);
  const auto state = std::make_shared<const operation::OperationState>(test::made_state());
  server.publish(state, 1'700'000'000.25);
  const auto named = named_transforms(*state);
  for (Client* client : {&one, &two}) {
    for (const NamedTransform& expected : named) {
      do ASSERT_TRUE(client->receive());
      while (client->name == "WorldTibia" || client->name == "Drill_World");  // told to be none
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
  const auto state = std::make_shared<const operation::OperationState>(test::made_state());
  const std::size_t messages_each = named_transforms(*state).size() + 1;
  server.publish(state, 0);
  next_state(eager);               // with what there is none of
  constexpr int kStates = 20'000;  // 10 MB: more than a socket holds
  std::atomic<int> received = 0;   // not more than a client may be behind
  std::thread publisher([&] {
    for (int i = 0; i < kStates; ++i) {
      while (i - received > 300) std::this_thread::yield();
      server.publish(state, i);
    }
  });
  for (std::size_t i = 0; i < kStates * messages_each; ++i) {
    ASSERT_TRUE(eager.receive()) << i;
    received = static_cast<int>(i / messages_each);
  }
  EXPECT_EQ(eager.time_s, kStates - 1);
  publisher.join();
  wait_for_clients(server, 1);
}

// The plan goes out once to each client, and again when it is another one.
TEST(IgtlServer, SendsThePlanWhenItIsNew) {
  IgtlServer server(0);
  Client client(server.port());
  wait_for_clients(server, 1);
  operation::OperationState state = test::made_state();
  state.plan.emplace();
  state.plan->tunnel.entry_mm = {10, 20, 30};
  state.plan->tunnel.direction = {0, 0, 2};
  state.plan->tunnel.diameter_mm = 8;
  state.plan->length_mm = 25;
  const auto publish = [&] {
    server.publish(std::make_shared<const operation::OperationState>(state), 1);
    std::vector<std::string> names;
    do {
      EXPECT_TRUE(client.receive());
      names.push_back(client.name);
    } while (client.name != "Arthronaut");
    return names;
  };
  EXPECT_EQ(publish().front(), "Plan");
  ASSERT_EQ(client.points.size(), 2U);
  EXPECT_EQ(client.points["entry"], Eigen::Vector3f(-10, -20, 30)) << "RAS";
  EXPECT_EQ(client.points["end"], Eigen::Vector3f(-10, -20, 55));
  EXPECT_EQ(client.radius_mm, 4);
  EXPECT_NE(publish().front(), "Plan");
  state.plan->tunnel.entry_mm.x() = 11;
  EXPECT_EQ(publish().front(), "Plan");
  state.plan.reset();
  EXPECT_EQ(publish().front(), "Plan");
  EXPECT_TRUE(client.points.empty()) << "there is none any more";
}

// Pictures go to who asks for them, one or as they come, in red, green, blue.
TEST(IgtlServer, SendsPicturesToWhoAsks) {
  IgtlServer server(0);
  Client asks(server.port()), does_not(server.port());
  wait_for_clients(server, 2);
  const auto state = std::make_shared<const operation::OperationState>(test::made_state());
  const auto frame = std::make_shared<camera::Frame>();
  frame->width = 4;
  frame->height = 2;
  for (std::uint8_t i = 0; i < 24; ++i) frame->bgr.push_back(i);
  const auto publish_until_picture = [&](int most) {
    for (int i = 0; i < most; ++i) {
      server.publish(state, i, frame);
      do {
        if (!asks.receive()) return false;
        if (asks.name == "Arthroscope") return true;
      } while (asks.name != "Arthronaut");
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    return false;
  };
  EXPECT_FALSE(publish_until_picture(5)) << "nobody has asked";
  asks.ask<igtl::GetImageMessage>();
  EXPECT_TRUE(publish_until_picture(2000));
  EXPECT_EQ(asks.image_size, (std::array<int, 2>{4, 2}));
  ASSERT_EQ(asks.rgb.size(), 24U);
  EXPECT_EQ(asks.rgb[0], 2);
  EXPECT_EQ(asks.rgb[2], 0);
  EXPECT_EQ(asks.rgb[23], 21);
  // The camera's x is a column's way, its y a row's; in RAS both are turned about, as the poses are. So a
  // picture that 3D Slicer reads from a file lies, too.
  const geometry::RigidTransform turned{Eigen::Quaterniond(Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitZ())),
                                        Eigen::Vector3d::Zero()};
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column)
      EXPECT_NEAR(asks.matrix[row][column], turned.matrix()(row, column), 1e-6) << row << column;
  EXPECT_EQ(asks.matrix[0][3], 0) << "its middle";
  EXPECT_FALSE(publish_until_picture(5)) << "one was asked for";
  asks.ask<StartImages>();
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(publish_until_picture(2000)) << i;
  server.publish(state, 5000);
  do {
    ASSERT_TRUE(does_not.receive());
    EXPECT_NE(does_not.name, "Arthroscope");
  } while (does_not.time_s != 5000);
}

// While no picture comes the clients are told so.
TEST(IgtlServer, TellsAStatusAlone) {
  IgtlServer server(0);
  Client client(server.port());
  wait_for_clients(server, 1);
  server.tell({false, "No picture comes: tower: broke off"}, 17);
  EXPECT_EQ(next_state(client).size(), kTransformNames.size() - 1)
      << "what it held of before is none; a second drill nobody has declared";
  EXPECT_EQ(client.code, igtl::StatusMessage::STATUS_NOT_READY);
  EXPECT_EQ(client.reason, "No picture comes: tower: broke off");
  EXPECT_EQ(client.time_s, 17);
}

// Hazard: a client goes on showing what came last. It is told in the same state that there is none any more,
// once, and that there is one again.
TEST(IgtlServer, Hazard49TakesBackWhatIsNotValidAnyMore) {
  IgtlServer server(0);
  Client client(server.port());
  wait_for_clients(server, 1);
  operation::OperationState state = test::made_state();
  using Words = std::vector<std::string>;
  const auto shared = [&] { return std::make_shared<const operation::OperationState>(state); };
  const auto publish = [&] {
    server.publish(shared(), 1);
    return next_state(client);
  };
  EXPECT_EQ(publish(), (Words{"WorldFemur", "WorldTibia: not seen", "ProbeTip_World", "Guide_World",
                              "Drill_World: not seen", "Bone_World"}));
  EXPECT_EQ(publish(), (Words{"WorldFemur", "ProbeTip_World", "Guide_World", "Bone_World"}));
  state.frame.tools[1].world_from_tool.is_valid = false;  // the guide
  EXPECT_EQ(publish(), (Words{"WorldFemur", "ProbeTip_World", "Guide_World: not seen", "Bone_World"}));
  EXPECT_EQ(publish(), (Words{"WorldFemur", "ProbeTip_World", "Bone_World"}));
  state.frame.tools[1].world_from_tool.is_valid = true;
  EXPECT_EQ(publish(),
            (Words{"WorldFemur", "ProbeTip_World", "Guide_World: OK", "Guide_World", "Bone_World"}));
  // Between two pictures.
  auto is_void = std::make_shared<operation::RegistrationState>(*state.registration);
  is_void->in_force.standing = operation::Standing::Void;
  state.registration = is_void;
  server.tell({false, "Void"}, 2, shared());
  EXPECT_EQ(next_state(client), Words{"Bone_World: registration: void"});
  server.tell({false, "Void"}, 2, shared());
  EXPECT_EQ(next_state(client), Words{});
  // Nothing comes any more.
  server.tell({false, "No picture"}, 3);
  EXPECT_EQ(next_state(client),
            (Words{"WorldFemur: No picture", "ProbeTip_World: No picture", "Guide_World: No picture"}));
}

// The same for a client that reads version 2, in the pose's own message, by this program's own reader.
TEST(IgtlServer, Hazard49SaysInThePosesMessageThatItIsNone) {
  struct Told : MessageListener {
    void pose(std::string_view device, const std::optional<geometry::RigidTransform>& pose, double) override {
      words.emplace_back(std::string(device) + (pose ? "" : ": no pose"));
    }
    void status(std::string_view device, bool is_ok, std::string_view said) override {
      words.emplace_back(std::string(device) + (is_ok ? ": OK: " : ": not OK: ") + std::string(said));
    }
    void refused(const std::string& why) override { words.push_back("refused: " + why); }
    std::vector<std::string> words;
  } told;
  IgtlServer server(0);
  Client client(server.port());
  wait_for_clients(server, 1);
  auto ask = Message(IgtlReader::kHeaderSize + 12, 0);  // GET_STATUS of version 2: an extended header alone
  ask[1] = 2;
  ask[49] = ask[59] = 12;
  const std::string_view type = "GET_STATUS";
  std::copy(type.begin(), type.end(), ask.begin() + 2);
  ASSERT_EQ(client.socket->Send(ask.data(), ask.size()), 1);
  operation::OperationState state = test::made_state();
  IgtlReader reader(told);
  const auto heard = [&](const std::string& what) {
    return std::find(told.words.begin(), told.words.end(), what) != told.words.end();
  };
  const auto run_until = [&](const std::string& what) {
    for (int i = 0; i < 500 && !heard(what); ++i) {
      server.publish(std::make_shared<const operation::OperationState>(state), i);
      std::array<std::uint8_t, 4096> bytes;
      const int count = client.socket->Receive(bytes.data(), static_cast<int>(bytes.size()), 0);
      ASSERT_GT(count, 0);
      ASSERT_TRUE(reader.take(std::span(bytes).first(static_cast<std::size_t>(count))));
    }
  };
  run_until("Guide_World");
  std::this_thread::sleep_for(std::chrono::milliseconds(300));  // by now it was read what the client speaks
  state.frame.tools[1].world_from_tool.is_valid = false;
  run_until("Guide_World: not OK: INVALID");
  EXPECT_TRUE(heard("Guide_World: not OK: INVALID"));
  run_until("Guide_World: not OK: not seen");
  for (const std::string& words : told.words) EXPECT_FALSE(words.starts_with("refused")) << words;
}

TEST(IgtlServer, APortThatIsTakenIsSaid) {
  const IgtlServer server(0);
  EXPECT_THROW(IgtlServer(server.port()), DeviceError);
}

// 127.0.0.2 is another address of this machine: who listens on 127.0.0.1 alone is not there, who listens on
// every interface is.
TEST(IgtlServer, ServesOtherAddressesOnlyWhereAsked) {
  const auto answers_at = [](const char* address, int port) {
    const auto socket = igtl::ClientSocket::New();
    const bool is_there = socket->ConnectToServer(address, port) == 0;
    socket->CloseSocket();
    return is_there;
  };
  const IgtlServer alone(0);
  EXPECT_TRUE(answers_at("127.0.0.1", alone.port()));
  EXPECT_FALSE(answers_at("127.0.0.2", alone.port()));
  const IgtlServer network(0, Reach::Network);
  EXPECT_TRUE(answers_at("127.0.0.1", network.port()));
  EXPECT_TRUE(answers_at("127.0.0.2", network.port()));
}

TEST(IgtlServer, AClientMayGoAtAnyTime) {
  IgtlServer server(0);
  {
    Client client(server.port());
    wait_for_clients(server, 1);
  }
  const auto state = std::make_shared<const operation::OperationState>(test::made_state());
  for (int i = 0; i < 100; ++i) {
    server.publish(state, i);
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  wait_for_clients(server, 0);
}

}  // namespace
}  // namespace arthronaut::openigtlink
