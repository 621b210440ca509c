#include "navigation/openigtlink/igtl_server.h"

#include <igtlImageMessage.h>
#include <igtlServerSocket.h>
#include <igtlTimeStamp.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <csignal>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string_view>
#include <vector>

#include "navigation/openigtlink/igtl_messages.h"
#include "navigation/openigtlink/igtl_reader.h"
#include "navigation/sources/background_end.h"
#include "navigation/worker/worker.h"
#include "planning/geometry/error.h"
#include "planning/log/log.h"

namespace arthronaut::openigtlink {

namespace {

constexpr int kPatience_ms = 2000;
constexpr int kMostWaiting = 600;  // ten seconds

struct Published {
  operation::OperationStatePtr state;  // null: no pose of before holds
  bool has_poses = false;              // of state, which are new; else what of them still holds
  camera::FramePtr picture;            // null: not asked for
  Status status;
  double utc_s = 0;
};
struct Nothing {};

// What a client has asked for: set by the thread that reads, taken by the one that sends.
struct Wishes {
  std::atomic<bool> one_picture = false, pictures = false, picture_waits = false, reads_version_2 = false;
  std::atomic<int> waiting = 0;  // states that it did not take yet
};

// The library's own listens on every interface.
class ListeningSocket : public igtl::ServerSocket {
 public:
  using Self = ListeningSocket;
  using Pointer = igtl::SmartPointer<ListeningSocket>;
  igtlTypeMacro(ListeningSocket, igtl::ServerSocket);
  igtlNewMacro(ListeningSocket);

  bool listen_on(int port, Reach reach) {
    m_SocketDescriptor = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    const int again = 1;  // also right after a run that ended
    ::setsockopt(m_SocketDescriptor, SOL_SOCKET, SO_REUSEADDR, &again, sizeof again);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    address.sin_addr.s_addr = htonl(reach == Reach::Network ? INADDR_ANY : INADDR_LOOPBACK);
    return ::bind(m_SocketDescriptor, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0 &&
           Listen(m_SocketDescriptor) == 0;
  }
};

bool send(igtl::Socket& socket, const Message& message) {
  return socket.Send(message.data(), static_cast<igtlUint64>(message.size())) != 0;
}

bool send_picture(igtl::Socket& socket, const camera::Frame& frame, double utc_s) {
  const auto message = igtl::ImageMessage::New();
  message->SetDimensions(frame.width, frame.height, 1);
  message->SetSpacing(1, 1, 1);
  message->SetScalarTypeToUint8();
  message->SetNumComponents(3);
  message->SetCoordinateSystem(igtl::ImageMessage::COORDINATE_RAS);
  // Columns go along the camera's x, rows along its y, both turned about as all that goes out: so it stands
  // upright in Slicer's axial view, and to the poses as it was taken.
  igtl::Matrix4x4 ras_from_picture;
  igtl::IdentityMatrix(ras_from_picture);
  ras_from_picture[0][0] = ras_from_picture[1][1] = -1;
  message->SetMatrix(ras_from_picture);
  message->AllocateScalars();
  std::vector<std::uint8_t> made;
  const std::vector<std::uint8_t>& bgr = camera::bgr_of(frame, made);
  auto* const rgb = static_cast<std::uint8_t*>(message->GetScalarPointer());
  for (std::size_t i = 0; i + 2 < bgr.size(); i += 3) {
    rgb[i] = bgr[i + 2];
    rgb[i + 1] = bgr[i + 1];
    rgb[i + 2] = bgr[i];
  }
  message->SetDeviceName("Arthroscope");
  auto time = igtl::TimeStamp::New();
  time->SetTime(utc_s);
  message->SetTimeStamp(time);
  message->Pack();
  return socket.Send(message->GetPackPointer(), message->GetPackSize()) != 0;
}

// What has gone out to one client.
class Outgoing {
 public:
  Outgoing(igtl::Socket& socket, Wishes& wishes) : socket_(socket), wishes_(wishes) {}

  // False: the client takes no more.
  bool send(const Published& published) {
    if (!send_plan_if_new(published) || !send_transforms(published) ||
        !openigtlink::send(socket_,
                           status_message("Arthronaut", published.status, "NoGuidance", published.utc_s)))
      return false;
    if (published.picture == nullptr) return true;
    const bool is_sent = send_picture(socket_, *published.picture, published.utc_s);
    wishes_.picture_waits = false;
    return is_sent;
  }

 private:
  // What the client holds under a name.
  struct Held {
    NamedTransform newest;
    std::optional<bool> is_valid;  // empty: it was told nothing of it
  };

  bool send_plan_if_new(const Published& published) {
    if (!published.has_poses || plan_ == published.state->plan) return true;
    plan_ = published.state->plan;
    return openigtlink::send(socket_, plan_message(*published.state, published.utc_s));
  }

  // What is valid; and of what is not any more, that it is not: at once, since a client goes on showing what
  // came last. One that comes again may have kept what it had, so that it is told of all of them.
  bool send_transforms(const Published& published) {
    const std::vector<NamedTransform> valid =
        published.state != nullptr ? named_transforms(*published.state) : std::vector<NamedTransform>();
    for (std::size_t i = 0; i < kTransformNames.size(); ++i) {
      const std::string name(kTransformNames[i]);
      const auto found =
          std::find_if(valid.begin(), valid.end(), [&](const auto& t) { return t.name == name; });
      Held& held = held_[i];
      if (found == valid.end()) {
        if (held.is_valid == false) continue;
        const bool is_declared =
            name != kSecondDrill || (published.state != nullptr && has_second_drill(*published.state));
        if (!held.is_valid && !is_declared) continue;
        held.is_valid = false;
        held.newest.name = name;
        const std::string why =
            published.state != nullptr ? why_without(*published.state, name) : published.status.reason;
        if (!take_back(held.newest, why, published.utc_s)) return false;
      } else if (published.has_poses) {
        held.newest = *found;
        if (held.is_valid == false &&
            !openigtlink::send(socket_, status_message(name, {true, "OK"}, "", published.utc_s)))
          return false;
        held.is_valid = true;
        const bool is_sent = openigtlink::send(
            socket_, wishes_.reads_version_2 ? transform_message_2(held.newest, true, published.utc_s)
                                             : transform_message(held.newest, published.utc_s));
        if (!is_sent) return false;
      }
    }
    return true;
  }

  bool take_back(const NamedTransform& named, const std::string& why, double utc_s) {
    if (wishes_.reads_version_2 && !openigtlink::send(socket_, transform_message_2(named, false, utc_s)))
      return false;
    return openigtlink::send(socket_, status_message(named.name, {false, why}, "NoPose", utc_s));
  }

  igtl::Socket& socket_;
  Wishes& wishes_;
  std::optional<operation::PlannedTunnel> plan_;  // that the client knows
  std::array<Held, kTransformNames.size()> held_;
};

// What a client says is heard for what it wants; its own poses are nobody's here.
class WishListener : public MessageListener {
 public:
  explicit WishListener(Wishes& wishes) : wishes_(wishes) {}
  void header(int version, std::string_view type) override {
    if (version > 1) wishes_.reads_version_2 = true;
    if (type == "GET_IMAGE") wishes_.one_picture = true;
    if (type == "STT_IMAGE") wishes_.pictures = true;
    if (type == "STP_IMAGE") wishes_.pictures = false;
  }
  void pose(std::string_view, const std::optional<geometry::RigidTransform>&, double) override {}
  void status(std::string_view, bool, std::string_view) override {}
  void refused(const std::string&) override {}

 private:
  Wishes& wishes_;
};

// Sends to one client until that fails; then the worker has ended. Letting it go waits for the message at
// hand, kPatience_ms at most.
class Client {
 public:
  explicit Client(const igtl::ClientSocket::Pointer& socket)
      : socket_(socket),
        wishes_(std::make_shared<Wishes>()),
        reader_(worker::Backlog::NewestWins,
                [socket, wishes = wishes_](auto& inbox) { read_wishes(*socket, *wishes, inbox); }),
        worker_(worker::Backlog::Lossless, [socket, wishes = wishes_](auto& inbox) {
          socket->SetSendTimeout(kPatience_ms);
          Outgoing outgoing(*socket, *wishes);
          while (const auto published = inbox.next()) {
            if (!outgoing.send(*published)) return;
            --wishes->waiting;
          }
        }) {}
  void post(Published published, const camera::FramePtr& picture) {
    if (picture != nullptr && (wishes_->pictures || wishes_->one_picture) && !wishes_->picture_waits) {
      wishes_->one_picture = false;
      wishes_->picture_waits = true;
      published.picture = picture;
    }
    ++wishes_->waiting;
    worker_.post(std::move(published));
  }
  // Gone, or so far behind that what it would get is of no use.
  [[nodiscard]] bool has_ended() const {
    return worker_.has_ended() || reader_.has_ended() || wishes_->waiting > kMostWaiting;
  }

 private:
  using Reader = worker::Worker<Nothing, Nothing>;

  // Ends with the connection. The library's own reading takes apart no header but that of its version, and
  // would not find where the next message begins.
  static void read_wishes(igtl::ClientSocket& socket, Wishes& wishes, const Reader::Inbox& inbox) {
    constexpr int kLook_ms = 200;
    socket.SetReceiveTimeout(kLook_ms);
    WishListener listener(wishes);
    IgtlReader reader(listener);
    std::array<std::uint8_t, 4096> bytes;
    while (!inbox.stops()) {
      const int count = socket.Receive(bytes.data(), static_cast<int>(bytes.size()), 0);
      if (count == 0 || (count > 0 && !reader.take({bytes.data(), static_cast<std::size_t>(count)}))) return;
    }
  }

  igtl::ClientSocket::Pointer socket_;
  std::shared_ptr<Wishes> wishes_;
  Reader reader_;
  worker::Worker<Published, Nothing> worker_;
};

}  // namespace

struct IgtlServer::State {
  using Acceptor = worker::Worker<Nothing, Nothing>;

  void accept(Acceptor::Inbox& inbox) {
    constexpr unsigned long kLook_ms = 100;
    while (!inbox.stops()) {
      const igtl::ClientSocket::Pointer socket = server->WaitForConnection(kLook_ms);
      if (socket.IsNull()) continue;
      const std::lock_guard lock(mutex);
      clients.push_back(std::make_unique<Client>(socket));
      log::info("OpenIGTLink: a client has come");
    }
  }

  // Under the lock.
  void let_ended_go() {
    const auto gone =
        std::partition(clients.begin(), clients.end(), [](const auto& c) { return !c->has_ended(); });
    if (gone != clients.end()) log::info("OpenIGTLink: a client has gone");
    // A client that is let go while it is sent to waits for that, and nobody waits for it.
    for (auto client = gone; client != clients.end(); ++client) ending.end(std::move(*client));
    clients.erase(gone, clients.end());
  }

  ListeningSocket::Pointer server = ListeningSocket::New();
  std::mutex mutex;
  std::vector<std::unique_ptr<Client>> clients;
  sources::BackgroundEnd ending;
  std::unique_ptr<Acceptor> acceptor;  // last: ends before the rest goes
};

IgtlServer::IgtlServer(int port, Reach reach) : state_(std::make_unique<State>()) {
  // A client that leaves while something is sent is no reason to end.
  std::signal(SIGPIPE, SIG_IGN);
  if (!state_->server->listen_on(port, reach))
    throw DeviceError("OpenIGTLink: port " + std::to_string(port) + " is taken or not allowed");
  state_->acceptor = std::make_unique<State::Acceptor>(
      worker::Backlog::NewestWins, [state = state_.get()](auto& inbox) { state->accept(inbox); });
}

IgtlServer::~IgtlServer() {
  state_->acceptor.reset();
  state_->server->CloseSocket();
}

int IgtlServer::port() const { return state_->server->GetServerPort(); }

std::size_t IgtlServer::client_count() const {
  const std::lock_guard lock(state_->mutex);
  state_->let_ended_go();
  return state_->clients.size();
}

void IgtlServer::publish(const operation::OperationStatePtr& state, double captured_utc_s,
                         const camera::FramePtr& picture) {
  const Status status = status_of(*state);
  const std::lock_guard lock(state_->mutex);
  state_->let_ended_go();
  for (const auto& client : state_->clients) {
    client->post({state, true, nullptr, status, captured_utc_s}, picture);
  }
}

void IgtlServer::tell(const Status& status, double utc_s, const operation::OperationStatePtr& still) {
  const std::lock_guard lock(state_->mutex);
  state_->let_ended_go();
  for (const auto& client : state_->clients) client->post({still, false, nullptr, status, utc_s}, nullptr);
}

}  // namespace arthronaut::openigtlink
