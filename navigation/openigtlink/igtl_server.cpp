#include "navigation/openigtlink/igtl_server.h"

#include <igtlServerSocket.h>
#include <igtlStatusMessage.h>
#include <igtlTimeStamp.h>
#include <igtlTransformMessage.h>

#include <algorithm>
#include <csignal>
#include <mutex>
#include <vector>

#include "navigation/openigtlink/named_transforms.h"
#include "navigation/worker/worker.h"
#include "planning/geometry/error.h"
#include "planning/log/log.h"

namespace arthronaut::openigtlink {

namespace {

constexpr int kPatience_ms = 2000;

struct Published {
  operation::OperationStatePtr state;
  double captured_utc_s = 0;
};
struct Nothing {};

bool send(igtl::Socket& socket, igtl::MessageBase& message, const std::string& name,
          igtl::TimeStamp::Pointer& time) {
  message.SetDeviceName(name.c_str());
  message.SetTimeStamp(time);
  message.Pack();
  return socket.Send(message.GetPackPointer(), message.GetPackSize()) != 0;
}

bool send_state(igtl::Socket& socket, const Published& published) {
  auto time = igtl::TimeStamp::New();
  time->SetTime(published.captured_utc_s);
  for (const NamedTransform& named : named_transforms(*published.state)) {
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
  const Status status = status_of(*published.state);
  const auto message = igtl::StatusMessage::New();
  message->SetCode(status.is_ok ? igtl::StatusMessage::STATUS_OK : igtl::StatusMessage::STATUS_NOT_READY);
  message->SetErrorName(status.is_ok ? "" : "NoGuidance");
  message->SetStatusString(status.reason.c_str());
  return send(socket, *message, "Arthronaut", time);
}

// Sends to one client until that fails; then the worker has ended. Letting it go waits for the message at
// hand, kPatience_ms at most.
class Client {
 public:
  explicit Client(igtl::ClientSocket::Pointer socket)
      : socket_(std::move(socket)), worker_(worker::Backlog::Lossless, [socket = socket_](auto& inbox) {
          socket->SetSendTimeout(kPatience_ms);
          while (const auto published = inbox.next())
            if (!send_state(*socket, *published)) return;
        }) {}
  void post(const Published& published) { worker_.post(published); }
  [[nodiscard]] bool has_ended() const { return worker_.has_ended(); }

 private:
  igtl::ClientSocket::Pointer socket_;
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
        std::remove_if(clients.begin(), clients.end(), [](const auto& c) { return c->has_ended(); });
    if (gone != clients.end()) log::info("OpenIGTLink: a client has gone");
    clients.erase(gone, clients.end());
  }

  igtl::ServerSocket::Pointer server = igtl::ServerSocket::New();
  std::mutex mutex;
  std::vector<std::unique_ptr<Client>> clients;
  std::unique_ptr<Acceptor> acceptor;  // last: ends before the rest goes
};

IgtlServer::IgtlServer(int port) : state_(std::make_unique<State>()) {
  // A client that leaves while something is sent is no reason to end.
  std::signal(SIGPIPE, SIG_IGN);
  if (state_->server->CreateServer(port) < 0)
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

void IgtlServer::publish(const operation::OperationStatePtr& state, double captured_utc_s) {
  const std::lock_guard lock(state_->mutex);
  state_->let_ended_go();
  for (const auto& client : state_->clients) client->post({state, captured_utc_s});
}

}  // namespace arthronaut::openigtlink
