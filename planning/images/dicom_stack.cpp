// From the slices of a series to the stack that a volume is made of.
#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <set>

#include "planning/files/format.h"
#include "planning/geometry/error.h"
#include "planning/geometry/quantile.h"
#include "planning/geometry/rigid_transform.h"
#include "planning/images/dicom_study.h"

namespace arthronaut::images {

namespace {

// Slices lie where their positions say, to the rounding of scanners' headers; a missing slice is 100 % off.
constexpr double kPositionTolerance_fraction = 0.05;

std::string names_of(const DicomSlices& slices) {
  constexpr std::size_t kMostNamed = 3;
  std::string names;
  for (std::size_t i = 0; i < std::min(slices.size(), kMostNamed); ++i)
    names += (i == 0 ? "" : ", ") + slices[i].name();
  return slices.size() > kMostNamed ? names + ", ..." : names;
}

// Takes out what `is_out` says, which is given back in its order.
template <class IsOut>
DicomSlices taken_out(DicomSlices& slices, const IsOut& is_out) {
  const auto out = std::stable_partition(slices.begin(), slices.end(),
                                         [&](const DicomSlice& slice) { return !is_out(slice); });
  DicomSlices taken(std::make_move_iterator(out), std::make_move_iterator(slices.end()));
  slices.erase(out, slices.end());
  return taken;
}

// A folder that was copied into itself holds images twice: the same image by its own name.
void leave_out_copies(DicomSlices& slices, std::vector<std::string>& notes) {
  std::set<std::string> seen;
  const DicomSlices copies = taken_out(slices, [&](const DicomSlice& slice) {
    const auto& uids = slice.origin->sop_instance_uids;
    return slice.frames_in_file == 1 && !uids.empty() && !seen.insert(uids.front()).second;
  });
  if (copies.empty()) return;
  notes.push_back("left out: " + std::to_string(copies.size()) + (copies.size() == 1 ? " copy" : " copies") +
                  " of images that are there already (" + names_of(copies) + ")");
}

// Scouts often share the series of the slices that were planned on them: the few that lie across all others.
void leave_out_scouts(DicomSlices& slices, std::vector<std::string>& notes) {
  constexpr std::size_t kSlicesAScout = 4;  // as many others at least
  const auto lie_across = [](const DicomSlice& a, const DicomSlice& b) {
    constexpr double kAcross_cos = 0.94;  // 20 degrees; slices of one stack have one direction
    return a.has_geometry && b.has_geometry && std::abs(a.normal().dot(b.normal())) < kAcross_cos;
  };
  const auto across = [&](const DicomSlice& one) {
    return static_cast<std::size_t>(std::count_if(
        slices.begin(), slices.end(), [&](const DicomSlice& other) { return lie_across(one, other); }));
  };
  if (across(slices.front()) == 0) return;
  const DicomSlice of_most =
      *std::min_element(slices.begin(), slices.end(),
                        [&](const DicomSlice& a, const DicomSlice& b) { return across(a) < across(b); });
  if (across(of_most) * (kSlicesAScout + 1) > slices.size()) return;
  const DicomSlices scouts =
      taken_out(slices, [&](const DicomSlice& slice) { return lie_across(slice, of_most); });
  notes.push_back("left out: " + std::to_string(scouts.size()) +
                  (scouts.size() == 1 ? " image that lies" : " images that lie") + " across the others (" +
                  names_of(scouts) + ")");
}

void refuse_odd_ones(const DicomSlices& slices) {
  const DicomSlice& first = slices.front();
  const auto refuse = [](const DicomSlice& s, const std::string& reason) {
    throw InvalidInput(s.file, s.place(), reason);
  };
  for (const DicomSlice& s : slices) {
    if (!s.has_geometry) refuse(s, "does not say where it lies in the patient");
    if (s.frame.columns != first.frame.columns || s.frame.rows != first.frame.rows) {
      refuse(s, "is " + std::to_string(s.frame.columns) + " x " + std::to_string(s.frame.rows) +
                    " pixels, other images of the series are " + std::to_string(first.frame.columns) + " x " +
                    std::to_string(first.frame.rows));
    }
    // Scout pictures across the others often share their series.
    if (s.along_columns.dot(first.along_columns) < 0.9999 || s.along_rows.dot(first.along_rows) < 0.9999)
      refuse(s, "lies at an angle to " + first.name() + " of the same series");
    if (std::abs(s.column_spacing_mm - first.column_spacing_mm) > 1e-3 * first.column_spacing_mm ||
        std::abs(s.row_spacing_mm - first.row_spacing_mm) > 1e-3 * first.row_spacing_mm) {
      refuse(s, "has another pixel spacing than other images of the series");
    }
  }
}

// A multi-echo series has each slice several times: the first echo is the one with the most signal.
void keep_first_echo(DicomSlices& slices, std::vector<std::string>& notes) {
  std::map<double, std::size_t> echoes;
  for (const DicomSlice& s : slices) {
    if (!s.echo_time_ms) return;
    ++echoes[*s.echo_time_ms];
  }
  if (echoes.size() < 2) return;
  const auto [first_ms, count] = *echoes.begin();
  // A series whose slices merely differ in their echo time has no position twice.
  if (count == slices.size() || count < 2) return;
  std::erase_if(slices, [first = first_ms](const DicomSlice& s) { return *s.echo_time_ms != first; });
  notes.push_back("of " + std::to_string(echoes.size()) + " echoes the first was taken" +
                  files::format(" (echo time %.3g ms)", first_ms));
}

bool has_position_twice(const DicomSlices& sorted) {
  for (std::size_t i = 0; i + 1 < sorted.size(); ++i) {
    if (sorted[i + 1].depth_mm() - sorted[i].depth_mm() < 0.01) return true;
  }
  return false;
}

void sort_by_position(DicomSlices& slices) {
  std::stable_sort(slices.begin(), slices.end(),
                   [](const DicomSlice& a, const DicomSlice& b) { return a.depth_mm() < b.depth_mm(); });
}

// The step from slice to slice, in the patient: not along the normal for a CT with a tilted gantry.
Eigen::Vector3d slice_step_mm(const DicomSlices& sorted) {
  std::vector<double> gaps;
  for (std::size_t i = 0; i + 1 < sorted.size(); ++i)
    gaps.push_back(sorted[i + 1].depth_mm() - sorted[i].depth_mm());
  const double usual = geometry::median(gaps);
  const Eigen::Vector3d step =
      (sorted.back().position_mm - sorted.front().position_mm) / static_cast<double>(sorted.size() - 1);
  for (std::size_t i = 0; i < gaps.size(); ++i) {
    const DicomSlice& next = sorted[i + 1];
    if (std::abs(gaps[i] - usual) > kPositionTolerance_fraction * usual) {
      throw InvalidInput(
          next.file, next.place(),
          files::format("lies %.2f mm from the slice before it, the others %.2f mm apart", gaps[i], usual) +
              ": a slice is missing or one too many (" + sorted[i].file.filename().string() + ")");
    }
  }
  for (std::size_t i = 0; i < gaps.size(); ++i) {
    const DicomSlice& next = sorted[i + 1];
    const Eigen::Vector3d expected = sorted.front().position_mm + static_cast<double>(i + 1) * step;
    if ((next.position_mm - expected).norm() > kPositionTolerance_fraction * usual + 0.02) {
      throw InvalidInput(next.file, next.place(),
                         files::format("lies %.2f mm beside the line of the other slices",
                                       (next.position_mm - expected).norm()));
    }
  }
  return step;
}

// Slices of a tilted gantry lie aslant above one another. Where their places do not say so and their header
// does, either may be right: a copy that straightened the places alone shows sheared bones.
void note_untold_tilt(const DicomSlice& slice, const Eigen::Vector3d& step_mm,
                      std::vector<std::string>& notes) {
  constexpr double kLeast_deg = 1;
  const double named_deg = std::abs(slice.gantry_tilt_deg);
  const double placed_deg =
      geometry::deg_from_rad(std::acos(std::min(std::abs(step_mm.normalized().dot(slice.normal())), 1.0)));
  if (named_deg < kLeast_deg || placed_deg > named_deg / 2) return;
  notes.push_back(
      files::format("its header names a gantry tilt of %.1f degrees, its slices lie %.1f degrees "
                    "aslant: if that is not so, its bones are sheared",
                    named_deg, placed_deg));
}

// A scanner counts its slices one by one; a copy that lost every second one is as even as the whole series.
void note_steps_of_numbers(const DicomSlices& sorted, std::vector<std::string>& notes) {
  if (!sorted[0].instance_number || !sorted[1].instance_number) return;
  const double step = *sorted[1].instance_number - *sorted[0].instance_number;
  if (!(std::abs(step) >= 2)) return;
  for (std::size_t i = 1; i + 1 < sorted.size(); ++i) {
    const auto &here = sorted[i].instance_number, &next = sorted[i + 1].instance_number;
    if (!here || !next || *next - *here != step) return;
  }
  notes.push_back(files::format("its slices are numbered in steps of %.0f: those between may be missing",
                                std::abs(step)));
}

}  // namespace

DicomStack stacked(const std::filesystem::path& source, DicomSlices slices) {
  DicomStack stack;
  leave_out_copies(slices, stack.notes);
  leave_out_scouts(slices, stack.notes);
  refuse_odd_ones(slices);
  sort_by_position(slices);
  const bool has_echoes = has_position_twice(slices);
  if (has_echoes) keep_first_echo(slices, stack.notes);
  if (slices.size() < 2) {
    throw InvalidInput(source, "",
                       std::filesystem::is_directory(source)
                           ? "holds one slice only"
                           : "is one slice: name the folder that holds its series");
  }
  for (std::size_t i = 0; i + 1 < slices.size(); ++i) {
    if (slices[i + 1].depth_mm() - slices[i].depth_mm() < 0.01) {
      throw InvalidInput(slices[i + 1].file, slices[i + 1].place(),
                         "lies at the same place as " + slices[i].name() +
                             ": which one is of the series? Put the other elsewhere");
    }
  }
  stack.step_mm = slice_step_mm(slices);
  note_untold_tilt(slices.front(), stack.step_mm, stack.notes);
  if (!has_echoes) note_steps_of_numbers(slices, stack.notes);  // echoes are counted in between
  stack.slices = std::move(slices);
  return stack;
}

}  // namespace arthronaut::images
