// What whoever connects a camera is told when nothing comes of it: what to see to, and not "Input/output
// error", "Address already in use" or "Connection refused".
#include <gmock/gmock.h>
#include <gst/rtsp-server/rtsp-server.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <string>
#include <thread>

#include "navigation/sources/frame_source.h"
#include "planning/geometry/error.h"
#include "tests/message_of.h"

namespace arthronaut::sources {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

std::string words_of(const std::string& address) {
  return test::message_of<DeviceError>([&] { (void)open_source(address); });
}

TEST(ConnectionWords, OfANameThatIsNotKnown) {
  EXPECT_THAT(words_of("rtsp://tower.invalid/scope"), HasSubstr("no machine of this name is found"));
}

TEST(ConnectionWords, OfAPortThatNothingAnswersAt) {
  EXPECT_THAT(words_of("rtsp://127.0.0.1:1/scope"), HasSubstr("nothing answers at this port"));
}

TEST(ConnectionWords, OfAPortThatAnotherProgramListensOn) {
  const int socket = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  sockaddr_in any{};
  any.sin_family = AF_INET;
  socklen_t size = sizeof any;
  ASSERT_EQ(::bind(socket, reinterpret_cast<sockaddr*>(&any), size), 0);
  ASSERT_EQ(::getsockname(socket, reinterpret_cast<sockaddr*>(&any), &size), 0);
  EXPECT_THAT(words_of("udp://127.0.0.1:" + std::to_string(ntohs(any.sin_port))),
              HasSubstr("another program on this machine listens on this port"));
  ::close(socket);
}

TEST(ConnectionWords, OfAnAddressOfAnotherMachine) {
  EXPECT_THAT(words_of("udp://192.0.2.1:5000?localaddr=192.0.2.1"),
              HasSubstr("this machine has no such address"));
}

// A server of GStreamer's, at a port that is free, which lets in the user "scope" with one password.
class GuardedServer {
 public:
  GuardedServer() {
    gst_rtsp_server_set_service(server_, "0");
    GstRTSPAuth* const auth = gst_rtsp_auth_new();
    GstRTSPToken* const token =
        gst_rtsp_token_new(GST_RTSP_TOKEN_MEDIA_FACTORY_ROLE, G_TYPE_STRING, "user", nullptr);
    gchar* const login = gst_rtsp_auth_make_basic("scope", "right");
    gst_rtsp_auth_add_basic(auth, login, token);
    g_free(login);
    gst_rtsp_token_unref(token);
    gst_rtsp_server_set_auth(server_, auth);
    g_object_unref(auth);
    GstRTSPMediaFactory* const factory = gst_rtsp_media_factory_new();
    gst_rtsp_media_factory_set_launch(
        factory,
        "( videotestsrc is-live=true ! video/x-raw,format=I420,width=320,height=240,framerate=30/1 ! "
        "jpegenc ! rtpjpegpay name=pay0 )");
    gst_rtsp_media_factory_add_role(factory, "user", GST_RTSP_PERM_MEDIA_FACTORY_ACCESS, G_TYPE_BOOLEAN, TRUE,
                                    GST_RTSP_PERM_MEDIA_FACTORY_CONSTRUCT, G_TYPE_BOOLEAN, TRUE, nullptr);
    GstRTSPMountPoints* const mounts = gst_rtsp_server_get_mount_points(server_);
    gst_rtsp_mount_points_add_factory(mounts, "/scope", factory);
    g_object_unref(mounts);
    gst_rtsp_server_attach(server_, nullptr);
    thread_ = std::thread([this] { g_main_loop_run(loop_); });
  }
  ~GuardedServer() {
    g_main_loop_quit(loop_);
    thread_.join();
    g_main_loop_unref(loop_);
    g_object_unref(server_);
  }
  GuardedServer(const GuardedServer&) = delete;
  GuardedServer& operator=(const GuardedServer&) = delete;

  [[nodiscard]] std::string address(const std::string& login) const {
    return "rtsp://" + login + "127.0.0.1:" + std::to_string(gst_rtsp_server_get_bound_port(server_)) +
           "/scope";
  }

 private:
  GstRTSPServer* server_ = (gst_init(nullptr, nullptr), gst_rtsp_server_new());
  GMainLoop* loop_ = g_main_loop_new(nullptr, FALSE);
  std::thread thread_;
};

// Who gave a password is not told to give one, and it is not shown.
TEST(ConnectionWords, OfAPasswordThatIsMissingOrWrong) {
  const GuardedServer server;
  EXPECT_THAT(words_of(server.address("")), HasSubstr("the server asks for a name and a password"));
  EXPECT_THAT(words_of(server.address("scope:wrong@")),
              AllOf(HasSubstr("the server refuses this name and password"), Not(HasSubstr("wrong"))));
  EXPECT_NE(open_source(server.address("scope:right@"))->next(), nullptr);
}

}  // namespace
}  // namespace arthronaut::sources
