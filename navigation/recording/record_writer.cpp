#include "navigation/recording/record_writer.h"

#include <utility>

#include "navigation/recording/session_files.h"
#include "navigation/registration/registration_file.h"

namespace arthronaut::recording {

RecordWriter::RecordWriter(SessionDatabase& database, OpenFormats& formats, SessionHashes& hashes,
                           std::filesystem::path folder, const pipeline::PipelineOptions& options)
    : database_(database),
      formats_(formats),
      hashes_(hashes),
      folder_(std::move(folder)),
      options_(options),
      frames_(database, options.tools),
      event_(database.prepare("INSERT INTO events(after_frame, timestamp_ns, kind, text) VALUES(?,?,?,?)")),
      picture_(database.prepare("INSERT INTO pictures VALUES(?,?,?,?,?,?)")),
      digests_(database.prepare("INSERT INTO digests VALUES(?,?,?)")),
      latency_(database.prepare("INSERT INTO latency VALUES(?,?,?,?,?,?,?)")) {}

void RecordWriter::write(const Message& message) {
  if (!in_transaction_) database_.execute("BEGIN");
  in_transaction_ = true;
  std::visit([this](const auto& m) { put(m); }, message);
}

void RecordWriter::commit() {
  if (in_transaction_) database_.execute("COMMIT");
  in_transaction_ = false;
  formats_.flush();
  // More may still come to be known of the last frame: it waits for the next one.
  hashes_.cover_rows(database_, kFrameRows, last_frame_);
  for (const char* const rows : {kEventRows, kPictureRows})
    hashes_.cover_rows(database_, rows, rows_end(database_, rows));
  for (const char* const table : {"poses.csv", "guidance.csv"}) hashes_.cover_growth(table);
  for (const std::string& part : growing_) hashes_.cover_growth(part, kVideoHead);
  hashes_.sync();
}

void RecordWriter::write_event(std::string_view kind, std::string text) {
  write(SessionEvent{last_timestamp_ns_, std::string(kind), std::move(text), last_frame_});
}

void RecordWriter::put(const pipeline::FrameResult& result) {
  frames_.insert(result);
  formats_.append(result);
  last_frame_ = result.frame_index;
  last_timestamp_ns_ = result.timestamp_ns;
}

void RecordWriter::put(const SessionEvent& event) {
  event_.bind(1, event.after_frame).bind(2, event.timestamp_ns).bind(3, event.kind).bind(4, event.text).run();
  const bool is_of_file = event.kind == kDrilledEvent || event.kind == kDrilledTakenBackEvent;
  if (is_of_file && !event.text.empty()) hashes_.cover_file(event.text);
}

void RecordWriter::put(const KeptPicture& picture) {
  picture_.bind(1, picture_count_++).bind(2, picture.frame).bind(3, picture.packet);
  picture_.bind(4, picture.start_packet).bind(5, picture.start_ms);
  if (picture.luma)
    picture_.bind(6, static_cast<std::int64_t>(*picture.luma));
  else
    picture_.bind_null(6);
  picture_.run();
}

void RecordWriter::put(const PartBegun& part) { growing_.push_back(part.file); }

void RecordWriter::put(const PartEnded& part) {
  std::erase(growing_, part.file);
  hashes_.cover_to_end(part.file, kVideoHead);
}

void RecordWriter::put(const RegistrationFile& file) {
  const registration::Provenance* of = file.of ? &*file.of : nullptr;
  for (const std::string& name : {file.name, std::string("registration.json")})
    hashes_.write_file(name,
                       [&] { registration::write_registration_file(folder_ / name, file.registration, of); });
}

void RecordWriter::put(const HeaderFile& file) {
  hashes_.write_file("session.json", [&] { write_session_header(folder_, file.header, options_); });
}

void RecordWriter::put(const FrameDigests& frame) {
  digests_.bind(1, frame.frame)
      .bind(2, static_cast<std::int64_t>(frame.digests.frame))
      .bind(3, static_cast<std::int64_t>(frame.digests.decisions))
      .run();
}

void RecordWriter::put(const FrameLatency& frame) {
  latency_.bind(1, frame.frame);
  int position = 2;
  const SessionRecorder::Latency& l = frame.latency;
  for (const double ms :
       {l.capture_ms, l.decode_ms, l.queue_ms, l.tracking_ms, l.operation_ms, l.guidance_ms}) {
    ms >= 0 ? latency_.bind(position, ms) : latency_.bind_null(position);
    ++position;
  }
  latency_.run();
}

void RecordWriter::put(const strokes::Curves& curves) {
  hashes_.write_file("curves.csv", [&] { strokes::write_curves_file(folder_ / "curves.csv", curves); });
}

}  // namespace arthronaut::recording
