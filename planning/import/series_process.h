// What a folder from a hospital holds (images::find_series), looked through in a process of its own: the
// headers of a thousand files from elsewhere, their codecs and the memory that they ask for are no harm to
// the workstation.
//
// The list comes first, whole; then, when they are wanted, the pictures of its series, one after the other.
// What ends the process at a picture takes that one and those after it, not the list.
//
//   Running ─► Done        the list is there, and a picture or the reason why there is none for each series
//           ─► Failed, Cancelled   as ChildProcess says; a list and pictures that came before stay
//
// For one thread, as ImportProcess.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "planning/images/series_list.h"
#include "planning/import/child_process.h"

namespace arthronaut::importing {

struct SeriesRequest {
  std::filesystem::path source;  // as images::find_series takes it
  bool with_pictures = false;
  double memory_limit_gib = 2.0;
  // A codec that goes round in circles says nothing. Reading one volume of 2 GiB off a slow disc takes a
  // minute.
  double longest_silence_s = 120;
  std::filesystem::path program = "/proc/self/exe";  // one that answers kImportChildWord
};

inline constexpr int kLongestPictureSide = 128;

struct SeriesPicture {
  images::Thumbnail thumbnail;
  std::string refusal;  // why there is none; then the thumbnail has no pixels

  [[nodiscard]] bool is_there() const { return !thumbnail.grey.empty(); }
};

class SeriesProcess {
 public:
  using State = ChildProcess::State;

  // Starts at once. Throws InvalidInput when the limit is not positive, IoError when no process can be
  // started.
  explicit SeriesProcess(SeriesRequest request);

  // Takes in what the child has sent. poll() returns at once, wait_for() after so long at the latest, earlier
  // when something came.
  State poll() { return wait_for(0); }
  State wait_for(double seconds);
  // Waits until it has ended; on_looked is told meanwhile how much of the source was looked through.
  State finish(const std::function<void(double looked_fraction)>& on_looked = {});
  void cancel() { child_.cancel(); }  // ends the child at once

  [[nodiscard]] State state() const { return child_.state(); }
  // Why it failed or was cancelled, for a person: of a source that is refused the words of find_series.
  [[nodiscard]] const std::string& message() const { return child_.message(); }
  [[nodiscard]] double looked_fraction() const { return looked_; }  // 0 to 1, while there is no list
  [[nodiscard]] const std::optional<images::SeriesList>& list() const { return list_; }
  // Of the first series of the list, in its order; more come with poll().
  [[nodiscard]] const std::vector<SeriesPicture>& pictures() const { return pictures_; }
  [[nodiscard]] int process_id() const { return child_.process_id(); }  // -1 once it has ended

 private:
  bool take(const Message& message);  // true: the last one
  [[nodiscard]] bool is_whole() const;

  bool with_pictures_;
  ChildProcess child_;
  double looked_ = 0;
  std::optional<images::SeriesList> list_;
  std::vector<SeriesPicture> pictures_;
};

}  // namespace arthronaut::importing
