#include <algorithm>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <stop_token>
#include <thread>

#include "app/command_line/after_operation.h"
#include "app/command_line/command.h"
#include "app/command_line/interruption.h"
#include "app/command_line/option_checks.h"
#include "app/command_line/pacs_report.h"
#include "planning/files/format.h"
#include "planning/files/json_document.h"
#include "planning/geometry/error.h"
#include "planning/import/series_process.h"
#include "planning/pacs/checks.h"
#include "planning/pacs/web.h"

namespace arthronaut::command_line {

namespace {

// What all four verbs have.
struct Connection {
  std::string peer;
  bool with_tls = false;
  pacs::TlsOptions tls;
  pacs::ConnectionOptions options;
  // DICOMweb instead.
  pacs::WebServer web;
  std::filesystem::path web_password_file;

  [[nodiscard]] bool is_web() const { return !web.url.empty(); }
  [[nodiscard]] pacs::WebServer server() const {
    pacs::WebServer all = web;
    while (all.url.ends_with('/')) all.url.pop_back();
    // What is wrong with the address is wrong usage; with the authority's file or the password's, it is not.
    refuse_together([&all] { pacs::check(all); });
    all.authority = tls.authority;
    if (!all.user.empty()) all.password = pacs::web_password(web_password_file);
    pacs::check(all);
    return all;
  }
  // As messages and JSON name it.
  [[nodiscard]] std::string where() const {
    return is_web() ? server().url : pacs::to_text(pacs::parse_peer(peer));
  }

  [[nodiscard]] pacs::ConnectionOptions chosen() const {
    if (!with_tls && !is_web() && !tls.authority.empty())
      throw CLI::ValidationError("--ca", "is of --tls, or of --web");
    pacs::ConnectionOptions all = options;
    if (with_tls) all.tls = tls;
    pacs::check(all);
    return all;
  }
};

// The PACS is one or the other.
CLI::Option* add_web_options(CLI::App& sub, Connection& connection) {
  CLI::Option_group* either = sub.add_option_group("Which PACS");
  either->add_option("--peer", connection.peer, "AET@HOST:PORT of the PACS")
      ->check(read_by([](const std::string& text) { (void)pacs::parse_peer(text); }));
  CLI::Option* web = either->add_option("--web", connection.web.url,
                                        "DICOMweb instead: https://HOST/dicom-web; --ca holds its authority, "
                                        "where that is not one of the system's");
  either->require_option(1);
  CLI::Option* user =
      sub.add_option("--user", connection.web.user, "User of the DICOMweb server")->needs(web);
  sub.add_option("--password-file", connection.web_password_file,
                 "File whose first line is the user's password; default: $ARTHRONAUT_DICOMWEB_PASSWORD")
      ->needs(user);
  return web;
}

void add_connection_options(CLI::App& sub, Connection& connection, bool peer_may_call_us) {
  CLI::Option* web = add_web_options(sub, connection);
  sub.add_option("--aet", connection.options.our_ae_title, "Our own AE title; default: ARTHRONAUT")
      ->check(read_by(pacs::check_ae_title))
      ->excludes(web);
  CLI::Option* tls =
      sub.add_flag("--tls", connection.with_tls, "Speak TLS; the peer's certificate is checked");
  CLI::Option* files[] = {sub.add_option("--cert", connection.tls.certificate, "Our certificate (PEM)"),
                          sub.add_option("--key", connection.tls.key, "Our private key (PEM)"),
                          sub.add_option("--ca", connection.tls.authority,
                                         "Certificate of the authority that signs the peer's (PEM)")};
  for (CLI::Option* file : files) tls->needs(file);
  files[0]->needs(tls);
  files[1]->needs(tls);
  tls->excludes(web);
  sub.add_option("--key-password-file", connection.tls.key_password_file,
                 "File whose first line is the password of an encrypted key")
      ->needs(tls);
  sub.add_option("--tls-name", connection.tls.name,
                 "Name that the peer's certificate is made out to; default: its host")
      ->needs(tls);
  sub.add_option("--connect-timeout-s", connection.options.connect_timeout_s,
                 "Longest wait for a connection; default: 10")
      ->check(between(1, 3600));
  sub.add_option("--timeout-s", connection.options.answer_timeout_s,
                 "Longest silence of the peer; default: 60")
      ->check(between(1, 3600));
  sub.add_option("--retries", connection.options.retries,
                 "How often a connection that fails or breaks is tried again; default: 3")
      ->check(whole_between(0, 100));
  if (peer_may_call_us)
    sub.add_option("--listen", connection.options.listening_port,
                   "Port where the peer may call us by our AE title: images by C-MOVE, reports of storage "
                   "commitment")
        ->check(whole_between(1, 65535))
        ->excludes(web);
}

// Ctrl+C ends the connection; what came whole is kept.
class StopOnInterruption {
 public:
  StopOnInterruption()
      : watcher_([this](const std::stop_token& ends) {
          while (!ends.stop_requested() && interruption_.caught() == 0)
            std::this_thread::sleep_for(std::chrono::milliseconds(50));
          if (interruption_.caught() != 0) source_.request_stop();
        }) {}
  [[nodiscard]] std::stop_token token() const { return source_.get_token(); }
  // Ends the program as the signal would have; returns when there was none.
  void end_if_caught() const {
    if (interruption_.caught() != 0) interruption_.end_program();
  }

 private:
  Interruption interruption_;
  std::stop_source source_;
  std::jthread watcher_;
};

void add_echo(CLI::App& pacs_app, Context& context) {
  const auto connection = std::make_shared<Connection>();
  CLI::App* sub = add_subcommand(pacs_app, context, "echo", "Ask whether the PACS is there and speaks to us",
                                 "arthronaut pacs echo --peer PACS@pacs.hospital:104 --aet THEATRE3");
  add_connection_options(*sub, *connection, false);
  sub->callback([&context, connection] {
    const std::string where = connection->where();
    const pacs::ConnectionOptions chosen = connection->chosen();
    const StopOnInterruption stop;
    const double taken_ms = connection->is_web()
                                ? pacs::echo(connection->server(), chosen, stop.token())
                                : pacs::echo(pacs::parse_peer(connection->peer), chosen, stop.token());
    stop.end_if_caught();
    context.say(files::format("%s answers, in %.1f ms", where.c_str(), taken_ms));
  });
}

struct FindArguments : Connection {
  pacs::FindKeys keys;
  pacs::FindOptions find;
  bool as_json = false;
};

void find(const Context& context, const FindArguments& arguments) {
  refuse_together([&] { pacs::check(arguments.keys, arguments.find); });
  const std::string where = arguments.where();
  const pacs::ConnectionOptions chosen = arguments.chosen();
  const StopOnInterruption stop;
  const auto found = arguments.is_web() ? pacs::find(arguments.server(), chosen, arguments.keys,
                                                     arguments.find, stop.token())
                                        : pacs::find(pacs::parse_peer(arguments.peer), chosen, arguments.keys,
                                                     arguments.find, stop.token());
  stop.end_if_caught();
  if (arguments.as_json) {
    files::write_json("-", json_of(where, found));
  } else {
    for (const std::string& line : lines_of(found)) context.say(line);
  }
  // Beside the answer, which is a whole one.
  if (context.quiet) return;
  if (found.patients.empty()) std::cerr << "arthronaut: " << where << " has nothing of the kind\n";
  if (found.is_cut)
    std::cerr << "arthronaut: there are more than " << arguments.find.most_studies
              << " studies; ask more closely, or with --most\n";
}

void add_find(CLI::App& pacs_app, Context& context) {
  const auto arguments = std::make_shared<FindArguments>();
  CLI::App* sub = add_subcommand(pacs_app, context, "find", "List a patient's studies and series",
                                 "arthronaut pacs find --peer PACS@pacs.hospital:104 --patient 4711 --json");
  add_connection_options(*sub, *arguments, false);
  sub->add_option("--patient", arguments->keys.patient_id, "Patient ID; * and ? stand for anything");
  sub->add_option("--name", arguments->keys.patient_name, "Patient's name as DICOM has it: \"Muster^A*\"");
  sub->add_option("--study", arguments->keys.study_uid, "UID of one study");
  sub->add_option("--accession", arguments->keys.accession_number, "Accession number");
  sub->add_option("--date", arguments->keys.study_date, "Study date, 20260131, or 20260101-20260131");
  sub->add_option("--modality", arguments->keys.modality, "Series of this modality alone: CT, MR");
  sub->add_option("--level", arguments->find.level,
                  "How deep to list: patient, study or series; default: series")
      ->transform(CLI::CheckedTransformer(
          std::map<std::string, pacs::FindLevel>{{"patient", pacs::FindLevel::Patient},
                                                 {"study", pacs::FindLevel::Study},
                                                 {"series", pacs::FindLevel::Series}}));
  sub->add_option("--most", arguments->find.most_studies, "Most studies to list; default: 500")
      ->check(whole_between(1, 1000000));
  sub->add_flag("--json", arguments->as_json, "The list as JSON");
  sub->callback([&context, arguments] { find(context, *arguments); });
}

struct GetArguments : Connection {
  pacs::RetrieveRequest request;
  bool as_json = false;
};

// Of the series that was fetched. What is wrong with its images the import says.
std::vector<library::PlannedCase> planned_cases_of_series(const pacs::RetrieveRequest& request) {
  importing::SeriesProcess looking({.source = request.folder});
  looking.finish();
  if (!looking.list()) return {};
  const std::vector<images::ImageSeries>& found = looking.list()->series;
  const auto series = std::ranges::find(found, request.series_uid, &images::ImageSeries::uid);
  if (series == found.end()) return {};
  return planned_cases_of({&*series, 1}).front();
}

void get(const Context& context, const GetArguments& arguments) {
  using Outcome = pacs::RetrieveSummary::Outcome;
  refuse_together([&] { pacs::check(arguments.request); });
  const std::string where = arguments.where();
  const pacs::ConnectionOptions connection = arguments.chosen();
  pacs::RetrieveSummary summary;
  const StopOnInterruption stop;
  {
    std::unique_ptr<Progress> line;
    const auto on_progress = [&](const pacs::TransferProgress& progress) {
      if (!line) line = std::make_unique<Progress>("Fetching", progress.total);
      line->advance_to(progress.done);
    };
    summary = arguments.is_web() ? pacs::retrieve_series(arguments.server(), connection, arguments.request,
                                                         on_progress, stop.token())
                                 : pacs::retrieve_series(pacs::parse_peer(arguments.peer), connection,
                                                         arguments.request, on_progress, stop.token());
  }
  if (summary.outcome == Outcome::Stopped) std::cerr << "arthronaut: " << summary.message << '\n';
  stop.end_if_caught();
  if (summary.outcome == Outcome::UnknownSeries) throw InvalidInput(summary.message);
  if (!summary.is_usable()) throw DeviceError(summary.message);
  std::vector<library::PlannedCase> planned;
  if (arguments.as_json || !context.quiet) planned = planned_cases_of_series(arguments.request);
  if (arguments.as_json) {
    auto document = json_of(where, arguments.request.series_uid, arguments.request.folder, summary);
    document["planned_cases"] = planned_cases_json(planned);
    files::write_json("-", document);
    return;
  }
  const int fetched = summary.image_count - summary.kept_count;
  context.say(summary.message + (summary.way.empty()
                                     ? "; nothing had to be fetched"
                                     : files::format("; %d fetched by %s", fetched, summary.way.c_str())));
  say_planned_cases(context, planned, arguments.request.series_uid, arguments.request.folder.string());
}

void add_get(CLI::App& pacs_app, Context& context) {
  const auto arguments = std::make_shared<GetArguments>();
  CLI::App* sub =
      add_subcommand(pacs_app, context, "get", "Fetch a series; what came whole before is not fetched again",
                     "arthronaut pacs get --peer PACS@pacs.hospital:104 --series UID -o knee_ct\n"
                     "  arthronaut import knee_ct -o Knee.arthro");
  add_connection_options(*sub, *arguments, true);
  sub->add_option("--series", arguments->request.series_uid, "UID of the series")->required();
  sub->add_option("--study", arguments->request.study_uid, "UID of its study, where the PACS asks for that");
  sub->add_option("-o,--output", arguments->request.folder,
                  "Folder to write: absent, empty, or with images of this series")
      ->required()
      ->check(a_file());
  sub->add_option_function<double>(
         "--most-gb",
         [arguments](double gigabytes) {
           arguments->request.most_bytes = static_cast<std::int64_t>(gigabytes * 1e9);
         },
         "Most gigabytes to take from the PACS; default: 34")
      ->check(between(0.001, 100000));
  sub->add_flag("--json", arguments->as_json, "What was fetched, as JSON");
  sub->callback([&context, arguments] { get(context, *arguments); });
}

struct SendArguments : Connection {
  std::vector<std::filesystem::path> paths;
  pacs::SendOptions send;
  bool without_commitment = false, must_be_committed = false, as_json = false;
};

void send(Context& context, const SendArguments& arguments) {
  using Outcome = pacs::SendSummary::Outcome;
  const std::string where = arguments.where();
  const pacs::ConnectionOptions connection = arguments.chosen();
  const auto files = pacs::files_to_send(arguments.paths);
  pacs::SendOptions options = arguments.send;
  options.asks_commitment = !arguments.without_commitment;
  pacs::SendSummary summary;
  const StopOnInterruption stop;
  {
    Progress line("Sending", static_cast<long>(files.size()));
    const auto on_progress = [&](const pacs::TransferProgress& progress) { line.advance_to(progress.done); };
    summary = arguments.is_web()
                  ? pacs::send_files(arguments.server(), connection, files, on_progress, stop.token())
                  : pacs::send_files(pacs::parse_peer(arguments.peer), connection, files, options,
                                     on_progress, stop.token());
  }
  stop.end_if_caught();
  if (arguments.as_json) files::write_json("-", json_of(where, summary));
  std::vector<std::string> doubts;
  int stored = 0;
  for (const pacs::SentFile& file : summary.files) {
    stored += file.is_stored ? 1 : 0;
    if (file.note.empty()) continue;
    const std::string line = file.file.string() + ": " + file.note;
    if (!file.is_stored || summary.commitment == pacs::Commitment::Failed) doubts.push_back(line);
    if (file.is_stored && !arguments.as_json) context.say(line);
  }
  if (stored == 0) throw DeviceError(where + ": took none of the files; " + doubts.front());
  if (!arguments.as_json) {
    context.say(files::format("Sent %d of %zu files to %s", stored, summary.files.size(), where.c_str()));
    if (options.asks_commitment)
      context.say(std::string("Storage commitment: ") + pacs::to_text(summary.commitment) + ": " +
                  summary.commitment_note);
  }
  if (summary.outcome == Outcome::BrokenOff) doubts.insert(doubts.begin(), summary.failure);
  if (arguments.must_be_committed && summary.commitment != pacs::Commitment::Confirmed)
    doubts.push_back("storage commitment is " + std::string(pacs::to_text(summary.commitment)) + ": " +
                     summary.commitment_note);
  if (summary.outcome == Outcome::SomeRefused || !doubts.empty())
    context.say_unreliable("what " + where + " holds", doubts);
}

void add_send(CLI::App& pacs_app, Context& context) {
  const auto arguments = std::make_shared<SendArguments>();
  CLI::App* sub = add_subcommand(pacs_app, context, "send",
                                 "Send DICOM files, and ask the PACS to commit itself to keep them",
                                 "arthronaut dicom Knee.arthro -o results\n"
                                 "  arthronaut pacs send --peer PACS@pacs.hospital:104 results");
  add_connection_options(*sub, *arguments, true);
  sub->add_option("FILE", arguments->paths, "DICOM files, or folders of them")->required();
  // DICOMweb has no storage commitment.
  CLI::Option* without =
      sub->add_flag("--no-commitment", arguments->without_commitment, "Ask for no storage commitment")
          ->excludes("--web");
  sub->add_flag("--require-commitment", arguments->must_be_committed,
                "Exit code 4 unless the PACS has confirmed that it keeps everything")
      ->excludes(without);
  sub->add_option("--commitment-wait-s", arguments->send.commitment_wait_s,
                  "How long its report is waited for; default: 5")
      ->check(between(0, 86400))
      ->excludes(without)
      ->excludes("--web");
  sub->add_flag("--json", arguments->as_json, "What was taken, as JSON");
  sub->callback([&context, arguments] { send(context, *arguments); });
}

}  // namespace

void add_pacs_command(CLI::App& app, Context& context) {
  CLI::App* pacs_app =
      add_subcommand(app, context, "pacs", "Find, fetch and send images over the hospital's DICOM network",
                     "arthronaut pacs find --peer PACS@pacs.hospital:104 --patient 4711\n"
                     "  arthronaut pacs get --peer PACS@pacs.hospital:104 --series UID -o knee_ct");
  pacs_app->require_subcommand(1);
  add_echo(*pacs_app, context);
  add_find(*pacs_app, context);
  add_get(*pacs_app, context);
  add_send(*pacs_app, context);
}

}  // namespace arthronaut::command_line
