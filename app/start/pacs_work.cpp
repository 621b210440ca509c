#include "app/start/pacs_work.h"

#include <algorithm>
#include <set>
#include <utility>

#include "app/start/results_process.h"
#include "planning/files/format.h"
#include "planning/files/private_folder.h"
#include "planning/files/sha256.h"

namespace arthronaut::start {

namespace fs = std::filesystem;
using State = PacsNews::State;
using Kind = PacsJob::Kind;

namespace {

pacs::WebServer server_of(const PacsPeer& peer) {
  pacs::WebServer server = peer.web;
  if (!server.user.empty()) server.password = pacs::web_password(peer.web_password_file);
  return server;
}

void echo(const PacsJob& job, PacsNews& news) {
  const double taken_ms = job.peer.is_web() ? pacs::echo(server_of(job.peer), job.peer.connection, job.stop)
                                            : pacs::echo(job.peer.peer, job.peer.connection, job.stop);
  news.words = files::format("answers, in %.0f ms", taken_ms);
}

void find(const PacsJob& job, PacsNews& news) {
  news.found = job.peer.is_web()
                   ? pacs::find(server_of(job.peer), job.peer.connection, job.keys, {}, job.stop)
                   : pacs::find(job.peer.peer, job.peer.connection, job.keys, {}, job.stop);
  std::size_t studies = 0, series = 0;
  for (const auto& patient : news.found.patients) {
    studies += patient.studies.size();
    for (const auto& study : patient.studies) series += study.series.size();
  }
  news.words = studies == 0 ? "The PACS has nothing of the kind"
                            : files::format("%zu %s with %zu series", studies,
                                            studies == 1 ? "study" : "studies", series);
  if (news.found.is_cut) news.words += "; there are more, so ask more closely";
}

void fetch(const PacsJob& job, const pacs::OnProgress& on_progress, PacsNews& news) {
  files::create_private_folder(job.request.folder.parent_path());
  news.retrieved = job.peer.is_web() ? pacs::retrieve_series(server_of(job.peer), job.peer.connection,
                                                             job.request, on_progress, job.stop)
                                     : pacs::retrieve_series(job.peer.peer, job.peer.connection, job.request,
                                                             on_progress, job.stop);
  news.words = news.retrieved.message;
  if (news.retrieved.outcome == pacs::RetrieveSummary::Outcome::Stopped)
    news.state = State::Stopped;
  else if (!news.retrieved.is_usable())
    news.state = State::Failed;
}

void write_results(const PacsJob& job, const fs::path& program, PacsNews& news) {
  using End = own_process::CommandOutcome::End;
  const own_process::CommandOutcome outcome =
      write_dicom_results(program, job.case_folder, job.results_folder, job.is_deidentified, job.stop);
  news.words = outcome.words;
  if (outcome.end == End::Failed) {
    news.state = State::Failed;
    return;
  }
  if (outcome.end == End::Stopped) return;
  if (outcome.end == End::Unreliable) news.state = State::Unreliable;
  news.files = pacs::files_to_send({job.results_folder});
}

void send(const PacsJob& job, const pacs::OnProgress& on_progress, PacsNews& news) {
  news.sent =
      job.peer.is_web()
          ? pacs::send_files(server_of(job.peer), job.peer.connection, job.files, on_progress, job.stop)
          : pacs::send_files(job.peer.peer, job.peer.connection, job.files, {}, on_progress, job.stop);
  const auto stored = std::count_if(news.sent.files.begin(), news.sent.files.end(),
                                    [](const pacs::SentFile& file) { return file.is_stored; });
  news.words =
      files::format("%ld of %zu objects are stored", static_cast<long>(stored), news.sent.files.size());
  news.files = news.sent.files;
  if (news.sent.outcome == pacs::SendSummary::Outcome::Stopped) {
    news.state = State::Stopped;
    news.words = "Stopped: " + news.words;
  } else if (!news.sent.is_usable()) {
    news.state = State::Failed;
    if (!news.sent.failure.empty()) news.words += "; then " + news.sent.failure;
  } else if (!job.peer.is_web() && news.sent.commitment != pacs::Commitment::Confirmed) {
    news.state = State::Unreliable;
  }
}

}  // namespace

PacsNews do_pacs_job(const PacsJob& job, const fs::path& program, const pacs::OnProgress& on_progress) {
  PacsNews news;
  news.kind = job.kind;
  news.state = State::Done;
  try {  // the top of the work: what fails is said on the screen
    switch (job.kind) {
      case Kind::Echo:
        echo(job, news);
        break;
      case Kind::Find:
        find(job, news);
        break;
      case Kind::Fetch:
        fetch(job, on_progress, news);
        break;
      case Kind::WriteResults:
        write_results(job, program, news);
        break;
      case Kind::Send:
        send(job, on_progress, news);
        break;
    }
  } catch (const std::exception& error) {
    news.state = State::Failed;
    news.words = error.what();
  }
  if (job.stop.stop_requested() && news.state != State::Stopped) {
    news.state = State::Stopped;
    if (job.kind != Kind::Fetch && job.kind != Kind::Send) news.words = "Stopped";
  }
  return news;
}

PacsWork::PacsWork(std::function<void()> wake, fs::path program)
    : news_(std::make_shared<const PacsNews>()),
      worker_(
          worker::Backlog::Lossless,
          [program = std::move(program)](auto& inbox) {
            while (auto job = inbox.next()) {
              PacsNews running;
              running.kind = job->kind;
              running.state = State::Running;
              job->peer.connection.on_retry = [&](const pacs::Retry& retry) {
                running.words = files::format("%s; tried again, %d of %d", retry.reason.c_str(), retry.number,
                                              job->peer.connection.retries);
                inbox.publish(running);
              };
              inbox.publish(do_pacs_job(*job, program, [&](const pacs::TransferProgress& progress) {
                running.progress = progress;
                running.words.clear();
                inbox.publish(running);
              }));
            }
          },
          std::move(wake)) {}

PacsWork::~PacsWork() { cancel(); }

void PacsWork::start(PacsJob job) {
  if (is_busy()) return;
  stop_ = {};
  job.stop = stop_.get_token();
  PacsNews running;
  running.kind = job.kind;
  running.state = State::Running;
  news_ = std::make_shared<const PacsNews>(std::move(running));
  worker_.post(std::move(job));
}

void PacsWork::cancel() { stop_.request_stop(); }

void PacsWork::end() {
  cancel();
  worker_.finish();
}

bool PacsWork::poll() {
  const auto latest = worker_.latest();
  if (latest == taken_) return false;
  taken_ = news_ = latest;
  return true;
}

fs::path fetched_folder(const fs::path& data_folder, const pacs::FoundSeries& series) {
  constexpr std::size_t kHashLength = 12;
  std::string modality = series.modality.substr(0, 16);
  std::erase_if(modality, [](char c) { return !((c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9')); });
  return data_folder / "fetched" /
         ((modality.empty() ? "series" : modality) + "-" +
          files::sha256_of(series.uid).substr(0, kHashLength));
}

}  // namespace arthronaut::start
