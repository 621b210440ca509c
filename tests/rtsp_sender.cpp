// Sends what a description of GStreamer's makes by RTSP, rtsp://127.0.0.1:PORT/scope, until it is killed: to
// everybody from its beginning.
//   rtsp_sender PORT LAUNCH
// Says "listening" when it can be connected to.
// A program of its own: its time is not the tests', and GStreamer does not outlive a fork.
#include <gst/rtsp-server/rtsp-server.h>

#include <cstdio>

int main(int count, char** arguments) {
  if (count != 3) return 2;
  gst_init(nullptr, nullptr);
  GstRTSPServer* const server = gst_rtsp_server_new();
  gst_rtsp_server_set_service(server, arguments[1]);
  GstRTSPMediaFactory* const factory = gst_rtsp_media_factory_new();
  gst_rtsp_media_factory_set_launch(factory, arguments[2]);
  GstRTSPMountPoints* const mounts = gst_rtsp_server_get_mount_points(server);
  gst_rtsp_mount_points_add_factory(mounts, "/scope", factory);
  g_object_unref(mounts);
  if (gst_rtsp_server_attach(server, nullptr) == 0) return 1;
  std::puts("listening");
  std::fflush(stdout);
  g_main_loop_run(g_main_loop_new(nullptr, FALSE));
}
