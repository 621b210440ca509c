#include "app/review/copy_maker.h"

#include <sys/resource.h>
#include <unistd.h>

namespace arthronaut::review {

CopyMaker::CopyMaker(const std::shared_ptr<const recording::SessionOverview>& session,
                     const std::vector<recording::QuickPictures::Name>& names)
    : worker_(
          worker::Backlog::NewestWins,
          [session, names](auto& inbox) {
            // On Linux a thread has a niceness of its own; those that a decoder starts take it over.
            constexpr int kNice = 19;
            (void)::setpriority(PRIO_PROCESS, static_cast<id_t>(::gettid()), kNice);
            recording::QuickPictures copies(session, names);
            const auto goes_on = [&inbox] { return !inbox.stops(); };
            while (auto frame = inbox.next()) {
              while (copies.make_next(*frame, goes_on))
                if (const auto newer = inbox.poll()) frame = newer;
            }
          },
          [] {}) {}

}  // namespace arthronaut::review
