// Inner header: owners of what GStreamer's C interface gives out.
#pragma once

#include <gst/gst.h>

#include <memory>

namespace arthronaut::sources {

struct Unref {
  void operator()(GstElement* p) const { gst_object_unref(p); }
  void operator()(GstClock* p) const { gst_object_unref(p); }
  void operator()(GstPad* p) const { gst_object_unref(p); }
  void operator()(GstSample* p) const { gst_sample_unref(p); }
  void operator()(GstMessage* p) const { gst_message_unref(p); }
  void operator()(GstBus* p) const { gst_object_unref(p); }
  void operator()(GstCaps* p) const { gst_caps_unref(p); }
  void operator()(GstIterator* p) const { gst_iterator_free(p); }
  void operator()(GError* p) const { g_error_free(p); }
  void operator()(char* p) const { g_free(p); }
};
template <class T>
using GstPtr = std::unique_ptr<T, Unref>;

// A pipeline must not run any more when it is let go.
struct StopAndUnref {
  void operator()(GstElement* p) const {
    gst_element_set_state(p, GST_STATE_NULL);
    gst_object_unref(p);
  }
};
using RunningPipeline = std::unique_ptr<GstElement, StopAndUnref>;

}  // namespace arthronaut::sources
