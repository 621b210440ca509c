#include "tests/planning/pacs/orthanc.h"

#include <arpa/inet.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <thread>

namespace arthronaut::test {

namespace {

// Not on the path of who is not root.
constexpr const char* kProgram = "/usr/sbin/Orthanc";

sockaddr_in loopback(int port) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  return address;
}

}  // namespace

int free_port() {
  const int socket = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in address = loopback(0);
  socklen_t size = sizeof(address);
  const bool is_bound = ::bind(socket, reinterpret_cast<const sockaddr*>(&address), size) == 0 &&
                        ::getsockname(socket, reinterpret_cast<sockaddr*>(&address), &size) == 0;
  ::close(socket);
  if (!is_bound) throw std::runtime_error("no free port");
  return ntohs(address.sin_port);
}

bool listens(int port) {
  const int socket = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  const sockaddr_in address = loopback(port);
  const bool is_there = ::connect(socket, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) == 0;
  ::close(socket);
  return is_there;
}

Orthanc::Orthanc(OrthancForm form)
    : port_(free_port()), web_port_(free_port()), offers_web_(form.offers_web) {
  if (!std::filesystem::exists(kProgram)) throw std::runtime_error("package orthanc is needed");
  nlohmann::json settings = {{"StorageDirectory", folder_ / "store"},
                             {"IndexDirectory", folder_ / "store"},
                             {"Plugins", nlohmann::json::array()},
                             {"HttpServerEnabled", false},
                             {"DicomAet", "ORTHANC"},
                             {"DicomCheckCalledAet", true},
                             {"DicomPort", port_},
                             {"DefaultEncoding", form.encoding},
                             {"DicomAlwaysAllowFind", form.answers_anybody},
                             {"DicomAlwaysAllowGet", false},
                             {"DicomAlwaysAllowMove", true},
                             {"OverwriteInstances", true}};
  if (form.knows_us)
    settings["DicomModalities"]["us"] = {{"AET", "ARTHRONAUT"},
                                         {"Host", "127.0.0.1"},
                                         {"Port", form.our_port > 0 ? form.our_port : 1},
                                         {"AllowGet", form.allows_get},
                                         {"UseDicomTls", !form.certificate.empty()}};
  if (!form.certificate.empty()) {
    settings["DicomTlsEnabled"] = true;
    settings["DicomTlsCertificate"] = form.certificate;
    settings["DicomTlsPrivateKey"] = form.key;
    settings["DicomTlsTrustedCertificates"] = form.authority;
  }
  if (form.offers_web) {
    settings["Plugins"] = {"/usr/share/orthanc/plugins/libOrthancDicomWeb.so"};
    settings["HttpServerEnabled"] = true;
    settings["HttpPort"] = web_port_;
    settings["RemoteAccessAllowed"] = false;
    settings["AuthenticationEnabled"] = !form.web_user.empty();
    if (!form.web_user.empty()) settings["RegisteredUsers"][form.web_user] = form.web_password;
    settings["DicomWeb"] = {{"Enable", true}, {"Root", "/dicom-web/"}, {"EnableWado", false}, {"Ssl", false}};
  }
  std::ofstream(folder_ / "orthanc.json") << settings;
  start();
}

Orthanc::~Orthanc() { kill(); }

void Orthanc::start() {
  const std::string settings = folder_ / "orthanc.json", log = folder_ / "orthanc.log";
  const pid_t test = ::getpid();
  process_ = ::fork();
  if (process_ == 0) {
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (::getppid() != test) ::_exit(1);
    const int output = ::open(log.c_str(), O_WRONLY | O_CREAT | O_APPEND, 0600);
    ::dup2(output, STDOUT_FILENO);
    ::dup2(output, STDERR_FILENO);
    ::execl(kProgram, kProgram, settings.c_str(), nullptr);
    ::_exit(127);
  }
  constexpr int kMostTries = 600;
  for (int i = 0; i < kMostTries; ++i) {
    if (listens(port_) && (!offers_web_ || listens(web_port_))) return;
    if (::waitpid(process_, nullptr, WNOHANG) == process_) break;
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  std::ifstream stream(log);
  const std::string text((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>());
  throw std::runtime_error("Orthanc does not start: " + text);
}

void Orthanc::kill() {
  if (process_ <= 0) return;
  ::kill(process_, SIGKILL);
  ::waitpid(process_, nullptr, 0);
  process_ = -1;
}

}  // namespace arthronaut::test
