#include "navigation/recording/session_timeline.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "navigation/recording/frame_record.h"
#include "navigation/recording/session_files.h"
#include "planning/geometry/error.h"

namespace arthronaut::recording {

namespace {

constexpr std::size_t kMostMarkers = 32;

// The next row of a table that is read along with the frames: both are in the order of their indices.
class RowsAlong {
 public:
  RowsAlong(SessionDatabase& database, const char* sql) : rows_(database.prepare(sql)) { advance(); }
  // Every row of that frame.
  template <typename Visit>
  void visit(std::int64_t frame, const Visit& visit) {
    while (has_row_ && rows_.integer(0) < frame) advance();
    for (; has_row_ && rows_.integer(0) == frame; advance()) visit(rows_);
  }

 private:
  void advance() { has_row_ = rows_.step(); }
  Statement rows_;
  bool has_row_ = false;
};

}  // namespace

struct SessionTimeline::State {
  explicit State(const std::filesystem::path& folder)
      : database(SessionDatabase::open(database_file(folder))) {}

  // What is read before a table breaks off, or says what no program writes, stays.
  template <typename Read>
  void as_far_as_whole(const Read& part) {
    try {
      part();
    } catch (const IoError& error) {
      problems.emplace_back(error.what());
    } catch (const InvalidInput& error) {
      problems.emplace_back(error.what());
    }
  }

  // What is not kept at a glance ends nothing; the first of it that is wrong is told.
  template <typename Check>
  void check_unkept(const Check& check) {
    if (!unkept_is_whole) return;
    const std::size_t told = problems.size();
    as_far_as_whole(check);
    unkept_is_whole = problems.size() == told;
  }

  void read_frames() {
    Statement rows = database.prepare(
        "SELECT frame, timestamp_ns, intrinsics_are_known, mark_state, mark_polarity FROM frames ORDER BY "
        "frame");
    while (rows.step()) {
      FrameGlance glance;
      glance.index = rows.integer(0);
      glance.timestamp_ns = rows.integer(1);
      glance.intrinsics_are_known = rows.boolean(2);
      frames.push_back(glance);
      check_unkept([&] {
        (void)rows.one_of(3, lens::MarkState::NotSeen);
        (void)rows.one_of(4, lens::MarkPolarity::BrightOutward);
      });
    }
  }

  std::uint32_t bit_of(int marker_id) {
    auto found = std::find(marker_ids.begin(), marker_ids.end(), marker_id);
    if (found == marker_ids.end()) {
      if (marker_ids.size() == kMostMarkers) return 0;
      found = marker_ids.insert(marker_ids.end(), marker_id);
    }
    return std::uint32_t{1} << static_cast<unsigned>(found - marker_ids.begin());
  }

  void read_markers() {
    RowsAlong rows(database,
                   "SELECT frame, marker_id, has_pose, state FROM markers ORDER BY frame, marker_id");
    for (FrameGlance& glance : frames)
      rows.visit(glance.index, [&](const Statement& row) {
        check_unkept([&] { (void)row.one_of(3, markers::MarkerState::Disagreeing); });
        const std::uint32_t bit = bit_of(row.int32(1));
        if (row.boolean(2)) glance.posed |= bit;
      });
  }

  // A body of several markers is named by its first one, whose bit stands for the body then.
  void read_bodies() {
    if (!database.prepare("SELECT 1 FROM sqlite_master WHERE name = 'bodies'").step()) return;
    std::uint32_t of_bodies = 0;
    Statement ids = database.prepare("SELECT DISTINCT body_id FROM bodies");
    while (ids.step()) of_bodies |= bit_of(ids.int32(0));
    RowsAlong rows(database, "SELECT frame, body_id FROM bodies ORDER BY frame, body_id");
    for (FrameGlance& glance : frames) {
      glance.posed &= ~of_bodies;
      rows.visit(glance.index, [&](const Statement& row) { glance.posed |= bit_of(row.int32(1)); });
    }
  }

  void read_guidance() {
    // Of all columns, since older records end before the lateral part of the offset.
    RowsAlong rows(database, "SELECT * FROM guidance ORDER BY frame");
    for (FrameGlance& glance : frames)
      rows.visit(glance.index, [&](const Statement& row) {
        glance.guidance = row.one_of(1, guidance::GuidanceState::GuideNotChecked);
        if (!glance.is_guided()) return;
        constexpr int kAngle = 10, kAnterior = 11, kProximal = 12, kLateral = 17;
        const double lateral_mm = row.column_count() > kLateral ? row.number(kLateral) : 0;
        glance.offset_mm =
            static_cast<float>(std::hypot(row.number(kAnterior), row.number(kProximal), lateral_mm));
        glance.angle_deg = static_cast<float>(row.number(kAngle));
      });
  }

  SessionDatabase database;
  std::vector<FrameGlance> frames;
  std::vector<int> marker_ids;
  std::vector<std::string> problems;
  bool unkept_is_whole = true;
  mutable std::optional<std::size_t> kept_at;
  mutable RecordedFrame kept;
};

SessionTimeline::SessionTimeline(const std::filesystem::path& session_folder)
    : state_(std::make_unique<State>(session_folder)) {
  State& s = *state_;
  s.as_far_as_whole([&] { s.read_frames(); });
  s.as_far_as_whole([&] { s.read_markers(); });
  s.as_far_as_whole([&] { s.read_bodies(); });
  s.as_far_as_whole([&] { s.read_guidance(); });
}

SessionTimeline::~SessionTimeline() = default;
SessionTimeline::SessionTimeline(SessionTimeline&&) noexcept = default;
SessionTimeline& SessionTimeline::operator=(SessionTimeline&&) noexcept = default;

const std::vector<FrameGlance>& SessionTimeline::frames() const { return state_->frames; }
const std::vector<int>& SessionTimeline::marker_ids() const { return state_->marker_ids; }
const std::vector<std::string>& SessionTimeline::problems() const { return state_->problems; }

const RecordedFrame& SessionTimeline::frame(std::size_t at) const {
  State& s = *state_;
  if (s.kept_at == at) return s.kept;
  const FrameGlance& glance = s.frames[at];
  s.kept = {};
  s.kept.index = glance.index;
  s.kept.timestamp_ns = glance.timestamp_ns;
  s.kept.intrinsics_are_known = glance.intrinsics_are_known;
  try {
    auto found = recording::read_frames(s.database, glance.index, glance.index);
    if (!found.empty()) s.kept = std::move(found.front());
  } catch (const IoError&) {
    // Told by problems(), since reading all of it met the same page.
  } catch (const InvalidInput&) {
    // Told by problems() likewise; a state of an outside tracker by the check of the session alone.
  }
  s.kept_at = at;
  return s.kept;
}

double SessionTimeline::time_s(std::size_t at) const {
  return static_cast<double>(frames()[at].timestamp_ns - frames().front().timestamp_ns) * 1e-9;
}

std::size_t SessionTimeline::at_time(double seconds) const {
  const std::int64_t wanted = frames().front().timestamp_ns + static_cast<std::int64_t>(seconds * 1e9);
  const auto after =
      std::upper_bound(frames().begin(), frames().end(), wanted,
                       [](std::int64_t t, const FrameGlance& f) { return t < f.timestamp_ns; });
  return after == frames().begin() ? 0 : static_cast<std::size_t>(after - frames().begin()) - 1;
}

std::size_t SessionTimeline::at_index(std::int64_t frame_index) const {
  const auto found = std::lower_bound(frames().begin(), frames().end(), frame_index,
                                      [](const FrameGlance& f, std::int64_t i) { return f.index < i; });
  return std::min(static_cast<std::size_t>(found - frames().begin()), frames().size() - 1);
}

}  // namespace arthronaut::recording
