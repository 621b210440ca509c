#include "app/paint/label_job.h"

#include <utility>

namespace arthronaut::paint {

namespace {

struct Stopped {};

}  // namespace

LabelJob::~LabelJob() { stops_ = true; }

void LabelJob::start(std::string what, Work work) {
  what_ = std::move(what);
  stops_ = false;
  fraction_ = 0;
  running_.start(
      [this, name = what_, work = std::move(work)] {
        Done done{name, {}, ""};
        try {  // the top of the thread: what is missing is a state of the screen
          done.labels = work([this](double fraction) {
            if (stops_) throw Stopped();
            fraction_ = fraction;
          });
        } catch (const Stopped&) {
        } catch (const std::exception& error) {
          done.failure = error.what();
        }
        return done;
      },
      wake_);
}

std::optional<LabelJob::Done> LabelJob::take() {
  if (!running_.is_ready()) return std::nullopt;
  Done done = running_.take();
  if (stops_) return std::nullopt;
  return done;
}

}  // namespace arthronaut::paint
