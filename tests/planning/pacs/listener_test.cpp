#include "planning/pacs/listener.h"

#include <arpa/inet.h>
#include <dcmtk/dcmdata/dctk.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include "planning/pacs/association.h"
#include "planning/pacs/query.h"
#include "tests/planning/pacs/sent_series.h"

namespace arthronaut::pacs {
namespace {

constexpr const char* kCt = "1.2.840.10008.5.1.4.1.1.2";
constexpr const char* kMr = "1.2.840.10008.5.1.4.1.1.4";

class PacsListener : public ::testing::Test {
 protected:
  PacsListener() { options_.listening_port = test::free_port(); }
  [[nodiscard]] Peer us() const { return {"ARTHRONAUT", "127.0.0.1", options_.listening_port}; }
  ConnectionOptions options_ = test::quick_connection();
};

// A socket that is open and says nothing.
class SilentCaller {
 public:
  explicit SilentCaller(int port) : socket_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    is_connected_ = ::connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) == 0;
  }
  ~SilentCaller() { ::close(socket_); }
  SilentCaller(const SilentCaller&) = delete;
  SilentCaller& operator=(const SilentCaller&) = delete;
  [[nodiscard]] bool is_connected() const { return is_connected_; }

 private:
  const int socket_;
  bool is_connected_ = false;
};

TEST_F(PacsListener, TakesOnlyWhatCanBeStoredAndWasAskedFor) {
  const test::TemporaryFolder folder;
  IncomingSeries series(folder / "scan", "1.2.3", {.most_bytes = 1 << 30, .least_free_bytes = 0});
  const Listener listener(options_, {.series = &series, .sop_classes = {kCt}, .on_image = {}});
  const auto association = Association::connect(
      us(), test::quick_connection(),
      {{.sop_class = kCt, .transfer_syntaxes = uncompressed_syntaxes()},
       {.sop_class = kMr, .transfer_syntaxes = uncompressed_syntaxes()},
       {.sop_class = kCt, .transfer_syntaxes = {UID_JPEG2000TransferSyntax}},
       {.sop_class = kCt, .transfer_syntaxes = {UID_JPIPReferencedTransferSyntax}},
       {.sop_class = UID_StorageCommitmentPushModelSOPClass, .transfer_syntaxes = uncompressed_syntaxes()}},
      {});
  ASSERT_NE(association, nullptr);
  EXPECT_NE(association->accepted(kCt, UID_LittleEndianExplicitTransferSyntax), 0);
  EXPECT_NE(association->accepted(kCt, UID_JPEG2000TransferSyntax), 0);
  // DCMTK answers with another context of the class where it has none of the syntax.
  T_ASC_PresentationContext context{};
  ASSERT_TRUE(
      ASC_findAcceptedPresentationContext(
          association->get().params, association->accepted(kCt, UID_JPIPReferencedTransferSyntax), &context)
          .good());
  EXPECT_STRNE(context.acceptedTransferSyntax, UID_JPIPReferencedTransferSyntax);
  EXPECT_EQ(association->accepted(kMr), 0);
  EXPECT_EQ(association->accepted(UID_StorageCommitmentPushModelSOPClass), 0);
  association->release();
}

// Who comes, goes and comes again takes no thread and no memory with him.
TEST_F(PacsListener, ForgetsWhoHasGone) {
  const Listener listener(options_, {});
  for (int i = 0; i < 40; ++i) EXPECT_GE(echo(us(), test::quick_connection()), 0);
  // The acceptor looks once a second at the latest.
  const auto until = std::chrono::steady_clock::now() + std::chrono::seconds(20);
  while (listener.connection_count() > 0 && std::chrono::steady_clock::now() < until)
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  EXPECT_EQ(listener.connection_count(), 0);
}

TEST_F(PacsListener, OutlivesCallersThatSayNothing) {
  options_.connect_timeout_s = 1;
  const Listener listener(options_, {});
  const SilentCaller first(options_.listening_port), second(options_.listening_port);
  ASSERT_TRUE(first.is_connected() && second.is_connected());
  EXPECT_GE(echo(us(), test::quick_connection()), 0);
}

}  // namespace
}  // namespace arthronaut::pacs
