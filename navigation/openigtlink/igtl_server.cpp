#include "navigation/openigtlink/igtl_server.h"

#include <igtlImageMessage.h>
#include <igtlPointMessage.h>
#include <igtlServerSocket.h>
#include <igtlStatusMessage.h>
#include <igtlTimeStamp.h>
#include <igtlTransformMessage.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <algorithm>
#include <atomic>
#include <csignal>
#include <cstdint>
#include <mutex>
#include <vector>

#include "navigation/sources/background_end.h"
#include "navigation/worker/worker.h"
#include "planning/geometry/error.h"
#include "planning/log/log.h"

namespace arthronaut::openigtlink {

namespace {

constexpr int kPatience_ms = 2000;
constexpr int kMostWaiting = 600;  // ten seconds

struct Published {
  operation::OperationStatePtr state;  // null: a status alone
  camera::FramePtr picture;            // null: not asked for
  Status status;
  double utc_s = 0;
};
struct Nothing {};

// What a client has asked for: set by the thread that reads, taken by the one that sends.
struct Wishes {
  std::atomic<bool> one_picture = false, pictures = false, picture_waits = false;
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

bool send(igtl::Socket& socket, igtl::MessageBase& message, const std::string& name,
          igtl::TimeStamp::Pointer& time) {
  message.SetDeviceName(name.c_str());
  message.SetTimeStamp(time);
  message.Pack();
  return socket.Send(message.GetPackPointer(), message.GetPackSize()) != 0;
}

bool send_status(igtl::Socket& socket, const Status& status, igtl::TimeStamp::Pointer& time) {
  const auto message = igtl::StatusMessage::New();
  message->SetCode(status.is_ok ? igtl::StatusMessage::STATUS_OK : igtl::StatusMessage::STATUS_NOT_READY);
  message->SetErrorName(status.is_ok ? "" : "NoGuidance");
  message->SetStatusString(status.reason.c_str());
  return send(socket, *message, "Arthronaut", time);
}

bool send_transforms(igtl::Socket& socket, const operation::OperationState& state,
                     igtl::TimeStamp::Pointer& time) {
  for (const NamedTransform& named : named_transforms(state)) {
    igtl::Matrix4x4 matrix;
    igtl::IdentityMatrix(matrix);
    const Eigen::Matrix3d rotation = named.target_from_source.matrix();
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 3; ++column)
        matrix[row][column] = static_cast<float>(rotation(row, column));
      matrix[row][3] = static_cast<float>(named.target_from_source.translation_mm[row]);
    }
    const auto message = igtl::TransformMessage::New();
    message->SetMatrix(matrix);
    if (!send(socket, *message, named.name, time)) return false;
  }
  return true;
}

bool send_plan(igtl::Socket& socket, const operation::OperationState& state, igtl::TimeStamp::Pointer& time) {
  const auto message = igtl::PointMessage::New();
  for (const NamedPoint& point : plan_points(state)) {
    auto element = igtl::PointElement::New();
    element->SetName(point.name.c_str());
    element->SetGroupName("Plan");
    element->SetRGBA(255, 200, 0, 255);
    const Eigen::Vector3f at = point.position_mm.cast<float>();
    element->SetPosition(at.x(), at.y(), at.z());
    element->SetRadius(static_cast<float>(point.radius_mm));
    message->AddPointElement(element);
  }
  return send(socket, *message, "Plan", time);
}

bool send_picture(igtl::Socket& socket, const camera::Frame& frame, igtl::TimeStamp::Pointer& time) {
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
  return send(socket, *message, "Arthroscope", time);
}

// What has gone out to one client.
class Outgoing {
 public:
  Outgoing(igtl::Socket& socket, Wishes& wishes) : socket_(socket), wishes_(wishes) {}

  // False: the client takes no more.
  bool send(const Published& published) {
    auto time = igtl::TimeStamp::New();
    time->SetTime(published.utc_s);
    if (published.state == nullptr) return send_status(socket_, published.status, time);
    if (!send_plan_if_new(*published.state, time) || !send_transforms(socket_, *published.state, time) ||
        !send_status(socket_, published.status, time))
      return false;
    if (published.picture == nullptr) return true;
    const bool is_sent = send_picture(socket_, *published.picture, time);
    wishes_.picture_waits = false;
    return is_sent;
  }

 private:
  bool send_plan_if_new(const operation::OperationState& state, igtl::TimeStamp::Pointer& time) {
    if (plan_ == state.plan) return true;
    plan_ = state.plan;
    return send_plan(socket_, state, time);
  }

  igtl::Socket& socket_;
  Wishes& wishes_;
  std::optional<operation::PlannedTunnel> plan_;  // that the client knows
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

  // Ends with the connection.
  static void read_wishes(igtl::ClientSocket& socket, Wishes& wishes, Reader::Inbox& inbox) {
    constexpr int kLook_ms = 200;
    socket.SetReceiveTimeout(kLook_ms);
    while (!inbox.stops()) {
      const auto header = igtl::MessageHeader::New();
      header->InitPack();
      auto* const to = static_cast<std::uint8_t*>(header->GetPackPointer());
      const int size = header->GetPackSize();
      for (int received = 0; received < size;) {  // which may come in pieces, or not at all
        const int more = socket.Receive(to + received, size - received, 0);
        if (more == 0 || inbox.stops()) return;
        received += std::max(more, 0);
      }
      if (header->Unpack() == 0) return;
      const std::string type = header->GetDeviceType();
      if (type == "GET_IMAGE") wishes.one_picture = true;
      if (type == "STT_IMAGE") wishes.pictures = true;
      if (type == "STP_IMAGE") wishes.pictures = false;
      if (header->GetBodySizeToRead() > 0) socket.Skip(static_cast<int>(header->GetBodySizeToRead()), 0);
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
                         const camera::FramePtr& picture, const std::string& withheld) {
  const Status status = withheld.empty() ? status_of(*state) : Status{false, withheld};
  const std::lock_guard lock(state_->mutex);
  state_->let_ended_go();
  for (const auto& client : state_->clients) client->post({state, nullptr, status, captured_utc_s}, picture);
}

void IgtlServer::tell(const Status& status, double utc_s) {
  const std::lock_guard lock(state_->mutex);
  state_->let_ended_go();
  for (const auto& client : state_->clients) client->post({nullptr, nullptr, status, utc_s}, nullptr);
}

}  // namespace arthronaut::openigtlink
