#include "planning/import/import_child.h"

#include <poll.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <unistd.h>

#include <filesystem>
#include <new>
#include <thread>

#include "planning/files/format.h"
#include "planning/geometry/error.h"
#include "planning/images/series_list.h"
#include "planning/import/import_messages.h"
#include "planning/import/shared_voxels.h"
#include "planning/postop/postop_source.h"

namespace arthronaut::importing {

namespace {

namespace fs = std::filesystem;

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

// As every other error: the library's words begin with the call that failed.
std::string in_words(const fs::filesystem_error& error) {
  return IoError(error.path1(), error.code().message()).what();
}

std::string needs_more(const ChildRequest& request) {
  constexpr double kGib = 1024.0 * 1024 * 1024;
  return files::format("needs more than the %.3g GiB of memory that an import may take",
                       static_cast<double>(request.memory_limit_bytes) / kGib) +
         ": --memory-limit-gib allows more";
}

void make_bones(int socket, const ChildRequest& request) {
  BoneImport import = import_bones(request.source, request.options, [&](const ImportProgress& progress) {
    send_all(socket, message_of(progress));
  });
  if (import.image && !put_voxels(kSharedDescriptor, import.image->volume.voxels)) import.image.reset();
  send_all(socket, message_of(import));
}

void read_postop(int socket, const ChildRequest& request) {
  postop::PostopSourceOptions options{.series = request.options.series};
  options.on_progress = [&](double fraction) {
    send_all(socket, message_of(ImportProgress{ImportStage::Reading, fraction}));
  };
  const images::Volume volume = postop::read_postop(request.source, options);
  BoneImport import;
  import.identity = {volume.patient.name, volume.patient.id, volume.patient.birth_date};
  import.side_in_images = volume.side;
  const images::EncodedVolume encoded = images::encoded(volume);
  if (!put_voxels(kSharedDescriptor, encoded.voxels)) throw std::bad_alloc();
  import.image.emplace().volume.header = encoded.header;
  send_all(socket, message_of(import));
}

// A series that has none may well be listed, and so may those after it.
SeriesPicture picture_of(const images::ImageSeries& series, const ChildRequest& request) {
  try {
    return {images::thumbnail_of(series, kLongestPictureSide), ""};
  } catch (const std::bad_alloc&) {
    return {{}, needs_more(request)};
  } catch (const fs::filesystem_error& error) {
    return {{}, in_words(error)};
  } catch (const std::exception& error) {
    return {{}, error.what()};
  }
}

// The list is sent before the first picture is made: what dies at that leaves it behind.
void look_through(int socket, const ChildRequest& request) {
  images::VolumeFileOptions reading{.series = {}, .most_bytes = request.memory_limit_bytes};
  reading.on_progress = [&](double fraction) {
    send_all(socket, message_of(ImportProgress{ImportStage::LookingThrough, fraction}));
  };
  const images::SeriesList list = images::find_series(request.source, reading);
  const std::string message = message_of(list);
  if (message.size() > kLongestList_bytes)
    throw InvalidInput(request.source, "", "holds more than can be listed");
  send_all(socket, message);
  if (request.work != ChildWork::ListSeriesWithPictures) return;
  for (const images::ImageSeries& series : list.series)
    send_all(socket, message_of(picture_of(series, request)));
}

void answer(int socket, const ChildRequest& request) {
  try {
    if (request.work == ChildWork::MakeBones)
      make_bones(socket, request);
    else if (request.work == ChildWork::ReadPostop)
      read_postop(socket, request);
    else
      look_through(socket, request);
  } catch (const std::bad_alloc&) {
    send_all(socket, message_of(Failure{.words = request.source.string() + ": " + needs_more(request)}));
  } catch (const fs::filesystem_error& error) {
    send_all(socket, message_of(Failure{.words = in_words(error)}));
  } catch (const ImportRefused& error) {
    send_all(socket, message_of(error.failure()));
  } catch (const std::exception& error) {
    send_all(socket, message_of(Failure{.words = error.what()}));
  }
}

}  // namespace

int run_import_child(int socket) {
  const auto request = received_request(socket);
  if (!request) return 2;
  end_with(socket);
  give_up_rights(request->memory_limit_bytes);
  answer(socket, *request);
  return 0;
}

}  // namespace arthronaut::importing
