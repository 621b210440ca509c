#include "navigation/recording/session_timeline.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

#include "navigation/recording/frame_record.h"
#include "navigation/recording/recording_lock.h"
#include "navigation/recording/session_files.h"
#include "planning/geometry/error.h"

namespace arthronaut::recording {

namespace {

constexpr std::size_t kMostMarkers = 32;

// The rows of a table, rising by their frames. Behind a damaged page it goes on with the next frame that can
// be read, and keeps which could not.
class Rows {
 public:
  // select: "SELECT frame, ... FROM table". Throws IoError where the table itself is not there.
  Rows(SessionDatabase& database, const std::string& select, const char* order = "frame")
      : database_(database), sql_(select + " WHERE frame >= ?1 ORDER BY " + order) {
    seek(0);
  }

  [[nodiscard]] bool step() {
    for (;; seek(next_)) {
      try {
        if (!rows_->step()) return false;
        last_ = rows_->integer(0);
        if (!lost_.empty() && lost_.back().to < 0) lost_.back().to = last_ - 1;
        next_ = last_ + 1;
        return true;
      } catch (const IoError& error) {
        if (lost_.empty()) error_ = error.what();
        if (lost_.empty() || lost_.back().to >= 0)
          lost_.push_back({last_ + 1, -1});
        else
          ++next_;
        if (++missed_ > kMostMissed) return false;
      }
    }
  }
  [[nodiscard]] const Statement& row() const { return *rows_; }

  // "session.sqlite: ...: the markers cannot be read of frames 76 to 150"; empty when all could be read.
  [[nodiscard]] std::string damage(const std::string& what) const {
    if (lost_.empty()) return {};
    std::string words = error_ + ": " + what + " cannot be read";
    for (std::size_t i = 0; i < lost_.size(); ++i)
      words += (i == 0                  ? " "
                : i + 1 == lost_.size() ? " and "
                                        : ", ") +
               (lost_[i].to < 0
                    ? "after frame " + std::to_string(lost_[i].from - 1)
                    : "of frames " + std::to_string(lost_[i].from) + " to " + std::to_string(lost_[i].to));
    return words;
  }

 private:
  struct Lost {
    std::int64_t from, to;  // below 0: to the end
  };
  // Looked for behind damage, one by one: 75 frames lie in four pages.
  static constexpr int kMostMissed = 5000;

  void seek(std::int64_t frame) {
    rows_.reset(new Statement(database_.prepare(sql_)));
    rows_->bind(1, frame);
    next_ = frame;
  }

  SessionDatabase& database_;
  std::string sql_, error_;
  std::unique_ptr<Statement> rows_;
  std::int64_t last_ = -1, next_ = 0;
  int missed_ = 0;
  std::vector<Lost> lost_;
};

// The next row of a table that is read along with the frames: both are in the order of their indices.
class RowsAlong {
 public:
  RowsAlong(SessionDatabase& database, const std::string& select, const char* order = "frame")
      : rows_(database, select, order) {
    advance();
  }
  // Every row of that frame.
  template <typename Visit>
  void visit(std::int64_t frame, const Visit& visit) {
    while (has_row_ && rows_.row().integer(0) < frame) advance();
    for (; has_row_ && rows_.row().integer(0) == frame; advance()) visit(rows_.row());
  }
  [[nodiscard]] std::string damage(const std::string& what) const { return rows_.damage(what); }

 private:
  void advance() { has_row_ = rows_.step(); }
  Rows rows_;
  bool has_row_ = false;
};

}  // namespace

struct SessionTimeline::State {
  explicit State(const std::filesystem::path& session_folder)
      : folder(session_folder), database(SessionDatabase::open(database_file(folder))) {}

  // What is read before a table breaks off, or says what no program writes, stays. False: it did.
  template <typename Read>
  bool as_far_as_whole(const Read& part) {
    try {
      part();
      return true;
    } catch (const IoError& error) {
      problems.emplace_back(error.what());
    } catch (const InvalidInput& error) {
      problems.emplace_back(error.what());
    }
    return false;
  }

  void tell(const std::string& damage) {
    if (!damage.empty()) problems.push_back(damage);
  }

  // A table that has a row of every frame: where it says what no program writes is told.
  template <typename Read>
  void table(const char* what, const Read& read) {
    at_frame = -1;
    if (!as_far_as_whole(read) && at_frame >= 0)
      problems.back() += ": " + std::string(what) + " cannot be read after frame " + std::to_string(at_frame);
  }

  // What is not kept at a glance ends nothing; the first of it that is wrong is told.
  template <typename Check>
  void check_unkept(const Check& check) {
    if (!unkept_is_whole) return;
    unkept_is_whole = as_far_as_whole(check);
  }

  void read_frames() {
    Rows rows(*database,
              "SELECT frame, timestamp_ns, intrinsics_are_known, mark_state, mark_polarity FROM frames");
    while (rows.step()) {
      const Statement& row = rows.row();
      FrameGlance glance;
      glance.index = row.integer(0);
      glance.timestamp_ns = row.integer(1);
      glance.intrinsics_are_known = row.boolean(2);
      frames.push_back(glance);
      check_unkept([&] {
        (void)row.one_of(3, lens::MarkState::NotSeen);
        (void)row.one_of(4, lens::MarkPolarity::BrightOutward);
      });
    }
    tell(rows.damage("the record"));
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
    RowsAlong rows(*database, "SELECT frame, marker_id, has_pose, state FROM markers", "frame, marker_id");
    for (FrameGlance& glance : frames) {
      rows.visit(glance.index, [&](const Statement& row) {
        check_unkept([&] { (void)row.one_of(3, markers::MarkerState::Disagreeing); });
        const std::uint32_t bit = bit_of(row.int32(1));
        if (row.boolean(2)) glance.posed |= bit;
      });
      at_frame = glance.index;
    }
    tell(rows.damage("the markers"));
  }

  // A body of several markers is named by its first one, whose bit stands for the body then.
  void read_bodies() {
    if (!database->prepare("SELECT 1 FROM sqlite_master WHERE name = 'bodies'").step()) return;
    std::uint32_t of_bodies = 0;
    Statement ids = database->prepare("SELECT DISTINCT body_id FROM bodies");
    while (ids.step()) of_bodies |= bit_of(ids.int32(0));
    RowsAlong rows(*database, "SELECT frame, body_id FROM bodies", "frame, body_id");
    for (FrameGlance& glance : frames) {
      glance.posed &= ~of_bodies;
      rows.visit(glance.index, [&](const Statement& row) { glance.posed |= bit_of(row.int32(1)); });
    }
  }

  void read_guidance() {
    // Of all columns, since older records end before the lateral part of the offset.
    RowsAlong rows(*database, "SELECT * FROM guidance");
    for (FrameGlance& glance : frames) {
      rows.visit(glance.index, [&](const Statement& row) {
        glance.guidance = row.one_of(1, guidance::kLastGuidanceState);
        if (!glance.is_guided()) return;
        constexpr int kAngle = 10, kAnterior = 11, kProximal = 12, kLateral = 17;
        const double lateral_mm = row.column_count() > kLateral ? row.number(kLateral) : 0;
        glance.offset_mm =
            static_cast<float>(std::hypot(row.number(kAnterior), row.number(kProximal), lateral_mm));
        glance.angle_deg = static_cast<float>(row.number(kAngle));
      });
      at_frame = glance.index;
    }
    tell(rows.damage("the guidance"));
  }

  std::filesystem::path folder;
  std::optional<SessionDatabase>
      database;  // nullopt once all is read: opened for every frame that is asked for
  std::vector<FrameGlance> frames;
  std::vector<int> marker_ids;
  std::vector<std::string> problems;
  bool unkept_is_whole = true;
  std::int64_t at_frame = -1;  // that was read last
  mutable std::optional<std::size_t> kept_at;
  mutable RecordedFrame kept;
  mutable bool kept_is_whole = false;
};

SessionTimeline::SessionTimeline(const std::filesystem::path& session_folder)
    : state_(std::make_unique<State>(session_folder)) {
  State& s = *state_;
  s.as_far_as_whole([&] { s.read_frames(); });
  s.table("the markers", [&] { s.read_markers(); });
  s.as_far_as_whole([&] { s.read_bodies(); });
  s.table("the guidance", [&] { s.read_guidance(); });
  // Its recorder wants the file for itself when the session ends.
  if (is_being_recorded(session_folder)) s.database.reset();
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
  s.kept_is_whole = false;
  try {
    std::optional<SessionDatabase> anew;
    if (!s.database) anew.emplace(SessionDatabase::open(database_file(s.folder)));
    auto found = recording::read_frames(anew ? *anew : *s.database, glance.index, glance.index);
    s.kept_is_whole = !found.empty();
    if (s.kept_is_whole) s.kept = std::move(found.front());
  } catch (const IoError&) {
    // Told by problems(), since reading all of it met the same page.
  } catch (const InvalidInput&) {
    // Told by problems() likewise; a state of an outside tracker by the check of the session alone.
  }
  s.kept_at = at;
  return s.kept;
}

bool SessionTimeline::is_readable(std::size_t at) const {
  (void)frame(at);
  return state_->kept_is_whole;
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
