// Inner header: the memory that a driver writes pictures into, mapped, and handed to and fro. There is so
// much of it and no more: what is neither with the driver nor given back in time is a picture lost, which the
// driver's count tells.
//
// Threads: give_back() from any; all else from the one that reads.
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "navigation/camera/frame.h"
#include "navigation/sources/v4l2_device.h"

namespace arthronaut::sources {

class CameraBuffers {
 public:
  // Of a mode that was taken. Begins to give pictures. Throws DeviceError.
  explicit CameraBuffers(std::unique_ptr<V4l2Device> device);
  ~CameraBuffers();  // pictures that are still looked at stay: the mappings go here, with the last of them
  CameraBuffers(const CameraBuffers&) = delete;
  CameraBuffers& operator=(const CameraBuffers&) = delete;

  // The device is let go at once, whoever looks at pictures of it.
  void stop();

  enum class Came { Nothing, Picture, Change };  // Change: of the signal's format
  // Waits so long and no longer. Throws DeviceError when the device is gone.
  [[nodiscard]] Came wait(int patience_ms);

  struct Filled {
    int buffer = 0;
    const std::uint8_t* data = nullptr;
    std::size_t byte_count = 0;
    std::uint32_t sequence = 0;
    std::int64_t captured_ns = 0, received_ns = 0;  // on the steady clock
    camera::CaptureClock clock = camera::CaptureClock::HandedOver;
    bool is_damaged = false;
  };
  // nullopt: none waits. Throws DeviceError when the device is gone.
  [[nodiscard]] std::optional<Filled> take();
  void give_back(int buffer);
  // Whether another one may be kept while somebody looks at it.
  [[nodiscard]] bool can_spare() const;

 private:
  struct Mapped {
    void* address = nullptr;
    std::size_t byte_count = 0;
  };
  void map(std::uint32_t index);
  [[nodiscard]] bool has_changed() const;

  mutable std::mutex mutex_;  // of the device's file and of the count
  std::unique_ptr<V4l2Device> device_;
  std::vector<Mapped> mapped_;
  int with_driver_ = 0;
};

}  // namespace arthronaut::sources
