#include "planning/pacs/line.h"

#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <linux/sockios.h>
#include <netinet/in.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <chrono>

namespace arthronaut::pacs {
namespace {

using ::testing::HasSubstr;

constexpr double kPatience_s = 3600;

TEST(PacsAllowance, EndsAfterSoManyBytes) {
  Allowance allowance(kPatience_s);
  EXPECT_EQ(allowance.admit(1, true), 0U);  // nothing was allowed yet
  Allowance other(kPatience_s);
  other.allow(100, "it sends too much");
  EXPECT_EQ(other.admit(60, true), 60U);
  other.note(60, true);
  EXPECT_EQ(other.admit(60, true), 40U);
  other.note(40, true);
  EXPECT_EQ(other.complaint(), "");
  other.allow(10, "it sends too much");
  EXPECT_EQ(other.admit(60, true), 10U);
  other.note(10, true);
  EXPECT_EQ(other.admit(1, true), 0U);
  EXPECT_EQ(other.complaint(), "it sends too much");
  EXPECT_TRUE(other.is_for_good());
}

// What we send is not bounded by what we want to hear.
TEST(PacsAllowance, LetsUsSpeak) {
  Allowance allowance(kPatience_s);
  allowance.allow(1, "it sends too much");
  EXPECT_EQ(allowance.admit(1000, false), 1000U);
  allowance.note(1000, false);
  EXPECT_EQ(allowance.admit(1000, true), 1U);
}

// No patience at all: the second byte is late already.
TEST(PacsAllowance, EndsWithAPeerThatTrickles) {
  Allowance allowance(0);
  allowance.allow(1 << 20, "it sends too much");
  EXPECT_EQ(allowance.admit(1, true), 1U);
  std::this_thread::sleep_for(std::chrono::milliseconds(2));
  EXPECT_EQ(allowance.admit(1, true), 0U);
  EXPECT_THAT(allowance.complaint(), HasSubstr("too slowly"));
  EXPECT_FALSE(allowance.is_for_good());
}

// Two ends of a connection on loopback: a socket pair knows no acknowledgements.
std::array<int, 2> connected() {
  const int door = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0),
            ours = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof(address);
  EXPECT_EQ(::bind(door, reinterpret_cast<const sockaddr*>(&address), size), 0);
  EXPECT_EQ(::listen(door, 1), 0);
  EXPECT_EQ(::getsockname(door, reinterpret_cast<sockaddr*>(&address), &size), 0);
  EXPECT_EQ(::connect(ours, reinterpret_cast<const sockaddr*>(&address), size), 0);
  const int theirs = ::accept(door, nullptr, nullptr);
  ::close(door);
  return {ours, theirs};
}

// Whether what was sent there is acknowledged within a quarter of the time that it is put off by where one
// answers another.
bool is_acknowledged_at_once(int socket) {
  const auto until = std::chrono::steady_clock::now() + std::chrono::milliseconds(10);
  int unacknowledged = 0;
  do {
    EXPECT_EQ(::ioctl(socket, SIOCOUTQ, &unacknowledged), 0);
  } while (unacknowledged > 0 && std::chrono::steady_clock::now() < until);
  return unacknowledged == 0;
}

// A peer that waits with the second part of its answer until the first was acknowledged is not kept waiting.
TEST(PacsLine, AcknowledgesTheFirstPartOfAnAnswerAtOnce) {
  const auto [ours, theirs] = connected();
  Line line(kPatience_s);
  line.allowance.allow(1 << 20, "it sends too much");
  prepare_socket(line, ours);
  const std::unique_ptr<DcmTransportConnection> connection(
      on_line(line, ours, std::make_unique<DcmTCPConnection>(ours)));
  std::array<char, 6> part{};
  int at_once = 0;
  constexpr int kAnswers = 50;  // the kernel acknowledges the first few at once in any case
  for (int i = 0; i < kAnswers; ++i) {
    ASSERT_EQ(connection->write(part.data(), part.size()), static_cast<ssize_t>(part.size()));
    ASSERT_EQ(::recv(theirs, part.data(), part.size(), MSG_WAITALL), static_cast<ssize_t>(part.size()));
    ASSERT_EQ(::send(theirs, part.data(), part.size(), 0), static_cast<ssize_t>(part.size()));
    ASSERT_EQ(connection->read(part.data(), part.size()), static_cast<ssize_t>(part.size()));
    at_once += is_acknowledged_at_once(theirs);
  }
  EXPECT_GE(at_once, kAnswers - 3);  // a busy machine may look late
  connection->close();
  ::close(theirs);
}

}  // namespace
}  // namespace arthronaut::pacs
