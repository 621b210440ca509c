#include "navigation/theatre/medium_look_service.h"

#include <utility>

#include "navigation/worker/worker.h"

namespace arthronaut::theatre {

namespace {

using operation::MediumLook;
using operation::MediumLookPtr;
using operation::MediumLookRequest;
using operation::MediumLookWork;

class AtOnce : public MediumLookService {
 public:
  void post(MediumLookRequest request, const camera::FramePtr& picture) override {
    latest_ = work_.look(std::move(request), *picture);
  }
  [[nodiscard]] MediumLookPtr latest() const override { return latest_; }

 private:
  MediumLookWork work_;
  MediumLookPtr latest_;
};

class Beside : public MediumLookService {
 public:
  void post(MediumLookRequest request, const camera::FramePtr& picture) override {
    worker_.post({std::move(request), picture});
  }
  [[nodiscard]] MediumLookPtr latest() const override { return worker_.latest(); }

 private:
  struct Asked {
    MediumLookRequest request;
    camera::FramePtr picture;
  };
  using LookWorker = worker::Worker<Asked, MediumLook>;
  LookWorker worker_{worker::Backlog::NewestWins, [](LookWorker::Inbox& inbox) {
                       MediumLookWork work;
                       while (auto asked = inbox.next())
                         inbox.publish(work.look(std::move(asked->request), *asked->picture));
                     }};
};

}  // namespace

std::unique_ptr<MediumLookService> looks_at_once() { return std::make_unique<AtOnce>(); }
std::unique_ptr<MediumLookService> looks_beside() { return std::make_unique<Beside>(); }

}  // namespace arthronaut::theatre
