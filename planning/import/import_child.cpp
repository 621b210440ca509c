#include "planning/import/import_child.h"

#include <poll.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <unistd.h>

#include <new>
#include <thread>

#include "planning/files/format.h"
#include "planning/geometry/error.h"
#include "planning/import/import_messages.h"
#include "planning/import/shared_voxels.h"

namespace arthronaut::importing {

namespace {

constexpr std::uint64_t kLongestRequest_bytes = 1 << 20;

std::optional<ChildRequest> received_request(int socket) {
  std::string buffer;
  for (;;) {
    char chunk[4096];
    const ssize_t count = ::recv(socket, chunk, sizeof(chunk), 0);
    if (count <= 0) return std::nullopt;  // no socket at all, or nobody there
    buffer.append(chunk, static_cast<std::size_t>(count));
    if (const auto message = take_message(buffer, kLongestRequest_bytes))
      return request_from(message->contents);
  }
}

void send_all(int socket, std::string_view message) {
  while (!message.empty()) {
    const ssize_t count = ::send(socket, message.data(), message.size(), MSG_NOSIGNAL);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) ::_exit(1);  // nobody listens any more
    message.remove_prefix(static_cast<std::size_t>(count));
  }
}

void limit(decltype(RLIMIT_DATA) resource, std::uint64_t bytes) {
  rlimit limit{};
  ::getrlimit(resource, &limit);
  limit.rlim_cur = limit.rlim_max = std::min<rlim_t>(limit.rlim_max, bytes);
  ::setrlimit(resource, &limit);
}

// Memory that is written to, not addresses: the libraries of the program take a GiB of those by themselves.
void give_up_rights(std::uint64_t memory_limit_bytes) {
  limit(RLIMIT_DATA, memory_limit_bytes);
  limit(RLIMIT_FSIZE, 0);
  limit(RLIMIT_CORE, 0);
}

// Nothing is sent after the request: whatever happens on the socket is its end.
void end_with(int socket) {
  std::thread([socket] {
    pollfd watched{socket, POLLIN | POLLRDHUP, 0};
    while (::poll(&watched, 1, -1) < 0 && errno == EINTR) {
    }
    ::_exit(1);
  }).detach();
}

std::string answer(int socket, const ChildRequest& request) {
  const auto tell = [&](std::string_view stage, double fraction) {
    send_all(socket, message_of(ImportProgress{std::string(stage), fraction}));
  };
  try {
    BoneImport import = import_bones(request.source, request.options, tell);
    if (import.image && !put_voxels(kSharedDescriptor, import.image->volume.voxels)) import.image.reset();
    return message_of(import);
  } catch (const std::bad_alloc&) {
    constexpr double kGib = 1024.0 * 1024 * 1024;
    return failure_message(request.source.string() + ": " +
                           files::format("needs more than the %.3g GiB of memory that an import may take",
                                         static_cast<double>(request.memory_limit_bytes) / kGib) +
                           ": --memory-limit-gib allows more");
  } catch (const std::exception& error) {
    return failure_message(error.what());
  }
}

}  // namespace

int run_import_child(int socket) {
  const auto request = received_request(socket);
  if (!request) return 2;
  end_with(socket);
  give_up_rights(request->memory_limit_bytes);
  send_all(socket, answer(socket, *request));
  return 0;
}

}  // namespace arthronaut::importing
