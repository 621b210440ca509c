#include "navigation/worker/recycler.h"

#include <gtest/gtest.h>

#include <set>
#include <string>
#include <thread>
#include <vector>

namespace arthronaut::worker {
namespace {

// What is let go comes back with the room it had, and never while somebody holds it.
TEST(Recycler, GivesOutWhatWasLetGo) {
  Recycler<std::vector<int>> vectors;
  std::shared_ptr<std::vector<int>> first = vectors.take();
  first->assign(1000, 7);
  const int* const memory = first->data();
  const std::shared_ptr<std::vector<int>> second = vectors.take();
  EXPECT_NE(first.get(), second.get());
  first.reset();
  first = vectors.take();
  EXPECT_EQ(first->data(), memory);
  EXPECT_EQ(first->size(), 1000U) << "as it was left";
}

TEST(Recycler, LetsGoOfWhatAValueHoldsAtOnce) {
  Recycler<std::shared_ptr<std::string>> holders([](std::shared_ptr<std::string>& held) { held.reset(); });
  const auto text = std::make_shared<std::string>("held");
  auto holder = holders.take();
  *holder = text;
  holder.reset();
  EXPECT_EQ(text.use_count(), 1);
}

TEST(Recycler, ValuesOutliveIt) {
  std::shared_ptr<std::string> text;
  {
    Recycler<std::string> strings;
    text = strings.take();
    *text = "still there";
  }
  EXPECT_EQ(*text, "still there");
}

// One thread makes, another lets go.
TEST(Recycler, ServesSeveralThreads) {
  Recycler<int> numbers;
  std::mutex mutex;
  std::vector<std::shared_ptr<int>> on_the_way;
  std::thread maker([&] {
    for (int i = 0; i < 5000; ++i) {
      std::shared_ptr<int> number = numbers.take();
      *number = i;
      const std::lock_guard lock(mutex);
      on_the_way.push_back(std::move(number));
    }
  });
  std::set<int> seen;
  while (seen.size() < 5000) {
    std::vector<std::shared_ptr<int>> taken;
    {
      const std::lock_guard lock(mutex);
      taken.swap(on_the_way);
    }
    for (const auto& number : taken) seen.insert(*number);
  }
  maker.join();
}

}  // namespace
}  // namespace arthronaut::worker
