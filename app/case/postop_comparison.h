// Planned against achieved, of a case and the images after its operation: what `arthronaut compare` and
// Review both do. No window, no thread.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "planning/cases/case.h"
#include "planning/images/volume.h"
#include "planning/postop/achieved_place.h"
#include "planning/postop/comparison.h"
#include "planning/postop/postop_source.h"

namespace arthronaut::open_case {

struct PostopQuestion {
  std::filesystem::path case_folder;
  std::filesystem::path source;  // as postop::read_postop() takes it
  std::string bone = {};         // "femur" or "tibia"; empty: every bone with planned tunnels
  std::string series = {};       // DICOM: number or UID, where there are several
  std::set<int> labels = {};     // label maps: those that are bone; empty: all but 0
  // Reads the images, where that is not to be done in this process; empty: postop::read_postop().
  std::function<images::Volume(const postop::PostopSourceOptions& options)> read = {};
  // What goes on, and how much of it is done, 0 to 1. May be empty.
  std::function<void(const std::string& what, double share)> on_progress = {};
  // Asked many times a second while bones are sought, and between two tunnels; true ends it. May be empty.
  std::function<bool()> stops = {};
  // Images that say that they are of another patient than the case are not searched: whose they are is all
  // that is answered. For those who would keep nothing of them.
  bool refuses_another_patient = false;
};

struct PostopAnswer {
  std::map<tunnels::TunnelKey, postop::Comparison>
      comparisons;  // one for each planned tunnel that was asked for
  // Of those that were found, by the case's landmarks, or where these give no grid by what is proposed.
  std::map<tunnels::TunnelKey, postop::AchievedPlace> places;
  std::map<tunnels::TunnelKey, tunnels::Tunnel> planned;  // what each was compared with
  images::Volume images;                                  // as they were read
  bool was_stopped = false;                               // then there may be fewer comparisons
  // Whose the images are where that is another patient than the case's; else empty.
  std::string other_patient;
  // Why it must not be relied on, each sentence beginning with the tunnel: "femur: ..."; empty: reliable.
  [[nodiscard]] std::vector<std::string> doubts() const;
};

// A tunnel of images that say they are of another patient than the case, or of a knee of the other side, is
// in doubt for that reason. Throws IoError or InvalidInput: nothing planned, a plan of another bone, images
// that cannot be read or show no bone.
[[nodiscard]] PostopAnswer compare_with_postop(const PostopQuestion& question);

// A tunnel of which a file holds something relied on, against the same plan, that is not relied on now.
struct BetterKept {
  tunnels::TunnelKey key;
  std::string why_not_now;  // may be empty
};

// Of what was compared, the tunnels of which `file` holds something relied on, against the same plan, that is
// not relied on now: all of it, or its entry, direction, diameter or length. None where there is no such
// file, or it is broken.
[[nodiscard]] std::vector<BetterKept> better_kept_in(const std::filesystem::path& file,
                                                     const PostopAnswer& answer);

// Writes what was compared into a case's `file`, tunnel by tunnel: those of better_kept_in(), which it
// returns, stay, each with its bone as its own images showed it. Where these are all, nothing is written.
// Throws IoError or InvalidInput; `file` is as it was then.
std::vector<BetterKept> keep_tunnel_by_tunnel(const std::filesystem::path& file,
                                              const std::filesystem::path& case_folder,
                                              const PostopAnswer& answer);

}  // namespace arthronaut::open_case
