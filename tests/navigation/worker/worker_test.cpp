#include "navigation/worker/worker.h"

#include <gtest/gtest.h>

#include <future>
#include <numeric>
#include <stdexcept>

namespace arthronaut::worker {

namespace {

using Numbers = std::vector<int>;
using NumberWorker = Worker<int, Numbers>;

// Nothing that was posted is left out, and the order stays.
TEST(Worker, LosslessWorksInAllOfIt) {
  NumberWorker worker(Backlog::Lossless, [](NumberWorker::Inbox& inbox) {
    Numbers seen;
    while (const auto number = inbox.next()) {
      seen.push_back(*number);
      inbox.publish(seen);
    }
  });
  Numbers posted(1000);
  std::iota(posted.begin(), posted.end(), 0);
  for (const int number : posted) worker.post(number);
  worker.finish();
  EXPECT_EQ(*worker.latest(), posted);
}

// While the body is busy only the newest message waits.
TEST(Worker, NewestWinsForgetsWhatCameBetween) {
  std::promise<void> is_busy, may_go_on;
  NumberWorker worker(Backlog::NewestWins, [&](NumberWorker::Inbox& inbox) {
    Numbers seen{*inbox.next()};
    is_busy.set_value();
    may_go_on.get_future().wait();
    while (const auto number = inbox.next()) {
      seen.push_back(*number);
      inbox.publish(seen);
    }
  });
  worker.post(1);
  is_busy.get_future().wait();
  for (int number = 2; number <= 9; ++number) worker.post(number);
  may_go_on.set_value();
  worker.finish();
  EXPECT_EQ(*worker.latest(), (Numbers{1, 9}));
}

TEST(Worker, AFailureIsAState) {
  NumberWorker worker(Backlog::Lossless,
                      [](NumberWorker::Inbox&) { throw std::runtime_error("no such bone"); });
  worker.finish();
  EXPECT_TRUE(worker.has_ended());
  EXPECT_EQ(worker.failure(), "no such bone");
  worker.post(1);  // is dropped and does no harm
  worker.finish();
  EXPECT_EQ(worker.latest(), nullptr);
}

// A wake-up that comes between the test and the wait must not be lost: posting and stopping at once, often.
TEST(Worker, NeverMissesAMessageOrTheEnd) {
  for (int round = 0; round < 2000; ++round) {
    NumberWorker worker(Backlog::Lossless, [](NumberWorker::Inbox& inbox) {
      while (const auto number = inbox.next()) inbox.publish(Numbers{*number});
    });
    worker.post(round);
    if (round % 2 == 0) {
      worker.finish();
      ASSERT_NE(worker.latest(), nullptr);
      ASSERT_EQ(worker.latest()->front(), round);
    }
  }
}

TEST(Worker, AWaitEndsWithAMessageOrTheStop) {
  const auto far = NumberWorker::Clock::now() + std::chrono::hours(1);
  NumberWorker worker(Backlog::Lossless, [far](NumberWorker::Inbox& inbox) {
    inbox.wait_until(far);
    inbox.publish(Numbers{inbox.poll().value_or(-1)});
    inbox.sleep_until(far);  // the end of the test ends it
  });
  worker.post(7);
  while (worker.latest() == nullptr) std::this_thread::yield();
  EXPECT_EQ(*worker.latest(), Numbers{7});
}

// Who waits for news is woken by it, by the end and by the time, whichever comes first.
TEST(Worker, WakesWhoWaitsForNews) {
  const auto far = [] { return NumberWorker::Clock::now() + std::chrono::hours(1); };
  NumberWorker worker(Backlog::Lossless, [](NumberWorker::Inbox& inbox) {
    while (const auto number = inbox.next()) {
      if (*number < 0) throw std::out_of_range("no such number");
      inbox.publish(Numbers{*number});
    }
  });
  std::shared_ptr<const Numbers> known;
  const auto soon = NumberWorker::Clock::now() + std::chrono::milliseconds(5);
  EXPECT_EQ(worker.wait_for_other_than(known, soon), nullptr);
  for (int number = 0; number < 2000; ++number) {  // a wake-up that is lost would wait for an hour
    worker.post(number);
    known = worker.wait_for_other_than(known, far());
    ASSERT_EQ(*known, Numbers{number});
  }
  worker.post(-1);
  EXPECT_EQ(worker.wait_for_other_than(known, far()), known);
  EXPECT_TRUE(worker.has_ended());
  EXPECT_THROW(std::rethrow_exception(worker.error()), std::out_of_range);
}

}  // namespace

}  // namespace arthronaut::worker
