#include "tests/benchmarks/file_sender.h"

#include <gst/rtsp-server/rtsp-server.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

namespace arthronaut {

namespace {

[[noreturn]] void send(const std::string& file, int port) {
  gst_init(nullptr, nullptr);
  GstRTSPServer* const server = gst_rtsp_server_new();
  gst_rtsp_server_set_service(server, std::to_string(port).c_str());
  GstRTSPMediaFactory* const factory = gst_rtsp_media_factory_new();
  const std::string launch = "( filesrc location=" + file +
                             " ! matroskademux ! h264parse config-interval=-1 ! rtph264pay name=pay0 )";
  gst_rtsp_media_factory_set_launch(factory, launch.c_str());
  GstRTSPMountPoints* const mounts = gst_rtsp_server_get_mount_points(server);
  gst_rtsp_mount_points_add_factory(mounts, "/scope", factory);
  gst_rtsp_server_attach(server, nullptr);
  g_main_loop_run(g_main_loop_new(nullptr, FALSE));
  std::_Exit(0);
}

}  // namespace

FileSender::FileSender(const std::string& file, int port) : port_(port) {
  process_ = ::fork();
  if (process_ == 0) send(file, port);
}

FileSender::~FileSender() {
  ::kill(process_, SIGKILL);
  ::waitpid(process_, nullptr, 0);
}

std::string FileSender::address() const { return "rtsp://127.0.0.1:" + std::to_string(port_) + "/scope"; }

}  // namespace arthronaut
