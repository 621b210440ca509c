// The comparison with a post-operative CT, beside the screen: the same that `arthronaut compare` computes,
// kept in the case as achieved.json when it has come to its end. Of a folder with several CTs it ends with
// the question which of them; one alone is taken, whatever lies beside it.
//
// The files are from elsewhere: they are looked through and read in a process of its own, with a limit on its
// memory.
//
// Threads: made and asked on the window's thread; one worker computes. It ends at once after stop() while it
// reads or seeks a bone, and with the bore in hand while it measures a tunnel.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "app/case/postop_comparison.h"
#include "navigation/worker/worker.h"
#include "planning/images/series_list.h"

namespace arthronaut::review {

struct PostopProgress {
  std::string what = "Beginning";
  double share = 0;                                       // of that, 0 to 1
  std::shared_ptr<const open_case::PostopAnswer> answer;  // null: not yet, it failed, or it asks
  std::vector<images::ImageSeries> which = {};            // it asks: one of these
  std::string better_kept = {};  // which tunnels stay as they were kept, and why; empty: none, or it may not
};

class PostopRun {
 public:
  // series: its UID; empty: not known yet. writes: whether achieved.json is kept; false in a case that is
  // read-only.
  PostopRun(const std::filesystem::path& case_folder, const std::filesystem::path& source,
            const std::string& series, bool writes, std::function<void()> on_news,
            const std::filesystem::path& program = "/proc/self/exe");
  [[nodiscard]] PostopProgress progress() const;
  [[nodiscard]] bool has_ended() const { return worker_.has_ended(); }
  [[nodiscard]] std::string error() const { return worker_.failure(); }  // empty: none
  // Nothing is kept then.
  void stop() { worker_.request_stop(); }
  [[nodiscard]] bool is_stopping() const { return worker_.is_stopping(); }

 private:
  worker::Worker<int, PostopProgress> worker_;
};

using Comparisons = std::map<tunnels::TunnelKey, postop::Comparison>;

// Keeps a comparison as the case's achieved.json. What is kept stays where these images are another
// patient's, or are known to show none of the plan's bones and the kept ones do: a CT that names nobody may
// be anybody's. So does each tunnel of better_kept(), beside the others. False where nothing was written.
// Throws IoError or InvalidInput (the case).
bool keep(const open_case::PostopAnswer& answer, const std::filesystem::path& case_folder);

// In words, that the case keeps tunnels that are relied on and are not in this comparison; empty: none.
[[nodiscard]] std::string better_kept(const open_case::PostopAnswer& answer,
                                      const std::filesystem::path& case_folder);

// What is told of images after the operation.
struct PostopShown {
  std::shared_ptr<const open_case::PostopAnswer> answer;  // with the images; null: only what the case keeps
  Comparisons comparisons;
  std::string other_patient;  // whose the images that were asked for last are; empty: nobody else's
  std::string
      not_its_bones;  // why those show no bone of the plan; empty: they do, or nothing was shown before
};
// Of which images the numbers that are shown are.
enum class PostopStanding {
  OfTheseImages,  // of those that were asked for last; or nothing is shown
  Kept,           // in the case, and nobody has asked for any since
  BeforeThese,    // others are being compared
  BeforeFailed,   // others were asked for, and nothing came of them
};
// asked_in_vain: the comparison that was asked for last failed.
[[nodiscard]] PostopStanding standing_of(const PostopShown& shown, bool is_running, bool asked_in_vain);
[[nodiscard]] bool is_of_earlier_images(PostopStanding standing);
[[nodiscard]] std::string in_words(PostopStanding standing);  // empty: OfTheseImages
// Why no grey picture stands behind the lines of a slice; empty: one does.
[[nodiscard]] std::string no_picture_words(const PostopShown& shown, const postop::Comparison& comparison);
// Images of another patient are refused: whose they are is told, and what was shown before stays. So are
// those that show none of the plan's bones reliably, where what was shown before does. False then.
bool take_answer(std::shared_ptr<const open_case::PostopAnswer> answer, PostopShown& shown);

// Of a case, where a comparison writes what it found.
[[nodiscard]] std::filesystem::path achieved_file(const std::filesystem::path& case_folder);

}  // namespace arthronaut::review
