#include "navigation/sources/connection_words.h"

#include "navigation/sources/frame_source.h"
#include "navigation/sources/libav.h"

namespace arthronaut::sources {

std::string connection_words(int error, const std::string& address) {
  switch (error) {
    case AVERROR_HTTP_UNAUTHORIZED:  // what is not shown of it is who logs in
      if (shown_address(address) == address) break;
      return "the server refuses this name and password";
    case AVERROR(ECONNREFUSED):
      return "the machine is there, but nothing answers at this port: see whether it sends, and at which "
             "port";
    case AVERROR(EHOSTUNREACH):
    case AVERROR(ENETUNREACH):
    case AVERROR(ENETDOWN):
      return "the machine is not reached: check cable and network";
    case AVERROR(ETIMEDOUT):
      return "nothing comes in time: see whether it is on and sends, and check address, cable and network";
    case AVERROR(EADDRINUSE):
      return "another program on this machine listens on this port: end it, or send to another port";
    case AVERROR(EADDRNOTAVAIL):
      return "this machine has no such address: udp://@:PORT listens on each that it has";
    case AVERROR(EIO):  // what it makes of a name that is not known, among others
      return "no machine of this name is found, or it breaks off at once: check address and network";
    default:
      break;
  }
  return libav_message(error);
}

}  // namespace arthronaut::sources
