#include "navigation/sources/datagram_input.h"

#include <algorithm>
#include <new>

namespace arthronaut::sources {

namespace {
constexpr std::size_t kLargest = 65536;  // a datagram
}

DatagramInput::DatagramInput(const std::string& address, const AVIOInterruptCB& interrupt,
                             AVDictionary** options)
    : datagram_(kLargest) {
  error_ = avio_open2(&socket_, address.c_str(), AVIO_FLAG_READ, &interrupt, options);
  if (error_ < 0) return;
  error_ = 0;
  waiting_.reserve(4 * kLargest);
  constexpr int kBuffer = 32768;
  auto* const buffer = static_cast<std::uint8_t*>(av_malloc(kBuffer));
  context_ = buffer != nullptr
                 ? avio_alloc_context(buffer, kBuffer, 0, this, &DatagramInput::read, nullptr, nullptr)
                 : nullptr;
  if (context_ == nullptr) throw std::bad_alloc();
  context_->seekable = 0;
}

DatagramInput::~DatagramInput() {
  if (context_ != nullptr) av_freep(&context_->buffer);
  avio_context_free(&context_);
  avio_closep(&socket_);
}

int DatagramInput::read(void* self, std::uint8_t* to, int size) {
  DatagramInput& input = *static_cast<DatagramInput*>(self);
  if (input.taken_ == input.waiting_.size()) {
    const int came = avio_read_partial(input.socket_, input.datagram_.data(), static_cast<int>(kLargest));
    if (came <= 0) return came < 0 ? came : AVERROR_EOF;
    input.waiting_.clear();
    input.taken_ = 0;
    input.ends_.pass_on({input.datagram_.data(), static_cast<std::size_t>(came)}, input.waiting_);
  }
  const std::size_t given = std::min(static_cast<std::size_t>(size), input.waiting_.size() - input.taken_);
  std::copy_n(input.waiting_.begin() + static_cast<std::ptrdiff_t>(input.taken_), given, to);
  input.taken_ += given;
  return static_cast<int>(given);
}

}  // namespace arthronaut::sources
