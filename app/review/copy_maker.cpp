#include "app/review/copy_maker.h"

#include "navigation/worker/niceness.h"

namespace arthronaut::review {

CopyMaker::CopyMaker(const std::shared_ptr<const recording::SessionOverview>& session,
                     const std::vector<recording::QuickPictures::Name>& names)
    : worker_(
          worker::Backlog::NewestWins,
          [session, names](auto& inbox) {
            worker::stand_back(19);
            recording::QuickPictures copies(session, names);
            const auto goes_on = [&inbox] { return !inbox.stops(); };
            while (auto frame = inbox.next()) {
              while (copies.make_next(*frame, goes_on))
                if (const auto newer = inbox.poll()) frame = newer;
            }
          },
          [] {}) {}

}  // namespace arthronaut::review
