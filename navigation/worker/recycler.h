// Values that are made over and over, at the rate of the frames, without asking for memory each time: what
// the last holder lets go comes back and is given out again, its buffers as large as they had become.
//
//   Recycler<Frame> frames([](Frame& frame) { frame.memory.reset(); });   // at once, where it is let go
//   std::shared_ptr<Frame> frame = frames.take();                         // as it was left by whoever had it
//
// There are as many values as were ever held at a time. They may outlive the recycler. From any thread; a
// lock is held for as long as a pointer takes to be put away.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <mutex>
#include <new>
#include <utility>
#include <vector>

namespace arthronaut::worker {

template <typename Value>
class Recycler {
  // The control blocks of the pointers are kept as well; they are all of one size.
  struct Pool {
    explicit Pool(std::function<void(Value&)> with) : let_go(std::move(with)) {}
    Pool(const Pool&) = delete;
    Pool& operator=(const Pool&) = delete;
    ~Pool() {
      for (void* block : blocks) ::operator delete(block);
    }
    // Room for all that will come back, while nobody minds that memory is asked for.
    void expect_one_more() {
      ++count;
      values.reserve(count);
      blocks.reserve(count);
    }

    std::mutex mutex;
    const std::function<void(Value&)> let_go;
    std::size_t count = 0;
    std::vector<std::unique_ptr<Value>> values;
    std::vector<void*> blocks;
  };
  using PoolPtr = std::shared_ptr<Pool>;

  struct GiveBack {
    PoolPtr pool;
    void operator()(Value* value) const {
      std::unique_ptr<Value> owned(value);
      if (pool->let_go) pool->let_go(*value);
      const std::lock_guard lock(pool->mutex);
      pool->values.push_back(std::move(owned));
    }
  };

  template <typename Block>
  struct BlockAllocator {
    using value_type = Block;
    explicit BlockAllocator(PoolPtr with) : pool(std::move(with)) {}
    template <typename Other>
    explicit BlockAllocator(const BlockAllocator<Other>& other) : pool(other.pool) {}
    Block* allocate(std::size_t count) {
      const std::lock_guard lock(pool->mutex);
      if (pool->blocks.empty()) return static_cast<Block*>(::operator new(count * sizeof(Block)));
      void* const block = pool->blocks.back();
      pool->blocks.pop_back();
      return static_cast<Block*>(block);
    }
    void deallocate(Block* block, std::size_t) {
      const std::lock_guard lock(pool->mutex);
      pool->blocks.push_back(block);
    }
    PoolPtr pool;
  };

 public:
  explicit Recycler(std::function<void(Value&)> let_go = {})
      : pool_(std::make_shared<Pool>(std::move(let_go))) {}

  [[nodiscard]] std::shared_ptr<Value> take() {
    std::unique_ptr<Value> value;
    {
      const std::lock_guard lock(pool_->mutex);
      if (pool_->values.empty()) {
        pool_->expect_one_more();
      } else {
        value = std::move(pool_->values.back());
        pool_->values.pop_back();
      }
    }
    if (value == nullptr) value = std::make_unique<Value>();
    return std::shared_ptr<Value>(value.release(), GiveBack{pool_}, BlockAllocator<Value>(pool_));
  }

 private:
  PoolPtr pool_;
};

}  // namespace arthronaut::worker
