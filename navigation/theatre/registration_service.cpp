#include "navigation/theatre/registration_service.h"

#include "navigation/worker/niceness.h"
#include "navigation/worker/worker.h"

namespace arthronaut::theatre {

namespace {

using operation::OutcomePtr;
using operation::RegistrationOutcome;
using operation::RegistrationRequest;
using operation::RegistrationWork;

class AtOnce : public RegistrationService {
 public:
  AtOnce(const BoneMaker& bone, const operation::RegistrationWorkOptions& options) : work_(bone, options) {}
  void post(std::vector<RegistrationRequest> requests) override {
    for (const RegistrationRequest& request : requests) work_.work_in(request);
  }
  [[nodiscard]] OutcomePtr latest() const override { return work_.outcome(); }

 private:
  RegistrationWork work_;
};

class Beside : public RegistrationService {
 public:
  Beside(BoneMaker bone, const operation::RegistrationWorkOptions& options, std::function<void()> on_news)
      : worker_(
            worker::Backlog::Lossless,
            [bone = std::move(bone), options](Inbox& inbox) { run(inbox, bone, options); },
            std::move(on_news)) {}
  void post(std::vector<RegistrationRequest> requests) override {
    for (RegistrationRequest& request : requests) worker_.post(std::move(request));
  }
  [[nodiscard]] OutcomePtr latest() const override { return worker_.latest(); }

 private:
  using Worker = worker::Worker<RegistrationRequest, RegistrationOutcome>;
  using Inbox = Worker::Inbox;

  static void run(Inbox& inbox, const BoneMaker& bone, const operation::RegistrationWorkOptions& options) {
    // Somebody who draws without a pause, faster than this machine registers, still sees how far it is.
    constexpr auto kAtLatest = std::chrono::seconds(1);
    // On two cores that also draw the screen it would hold up several pictures in a row.
    worker::stand_back(5);
    RegistrationWork work(bone, options);
    inbox.publish(work.outcome());
    auto published_at = Worker::Clock::now();
    bool has_news = false;
    while (auto request = inbox.next()) {
      do {
        has_news = work.work_in(*request) || has_news;
        if (inbox.stops()) return;
        if (has_news && Worker::Clock::now() - published_at > kAtLatest) break;
        request = inbox.poll();
      } while (request);
      if (!has_news) continue;
      inbox.publish(work.outcome());
      published_at = Worker::Clock::now();
      has_news = false;
    }
  }

  Worker worker_;
};

}  // namespace

std::unique_ptr<RegistrationService> registration_at_once(const BoneMaker& bone,
                                                          const operation::RegistrationWorkOptions& options) {
  return std::make_unique<AtOnce>(bone, options);
}

std::unique_ptr<RegistrationService> registration_beside(BoneMaker bone,
                                                         const operation::RegistrationWorkOptions& options,
                                                         std::function<void()> on_news) {
  return std::make_unique<Beside>(std::move(bone), options, std::move(on_news));
}

}  // namespace arthronaut::theatre
