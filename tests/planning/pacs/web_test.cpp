// DICOMweb, against Orthanc's.
#include "planning/pacs/web.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <csignal>
#include <fstream>
#include <utility>

#include "planning/files/atomic_file.h"
#include "planning/geometry/error.h"
#include "tests/planning/pacs/certificates.h"
#include "tests/planning/pacs/raw_web_server.h"
#include "tests/planning/pacs/sent_series.h"
#include "tests/planning/pacs/tls_front.h"

namespace arthronaut::pacs {
namespace {

namespace fs = std::filesystem;
using Outcome = RetrieveSummary::Outcome;
using test::kImageCount;
using test::pixels_of;
using test::quick_connection;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::string failure_of(const auto& action) {
  try {
    action();
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

class PacsWeb : public ::testing::Test {
 protected:
  [[nodiscard]] static WebServer server_of(const test::Orthanc& orthanc) {
    return {.url = orthanc.web_url(), .authority = {}, .user = {}, .password = {}};
  }
  [[nodiscard]] RetrieveRequest request() const {
    RetrieveRequest asked;
    asked.series_uid = test::DicomSeriesForm{}.origin.series_uid;
    asked.folder = got_ / "scan";
    return asked;
  }
  const test::TemporaryFolder made_, got_;
};

TEST_F(PacsWeb, SendsFindsAndFetches) {
  const test::Orthanc orthanc({.offers_web = true});
  const WebServer server = server_of(orthanc);
  EXPECT_GE(echo(server, quick_connection()), 0);
  test::write_dicom_series(made_ / "ct", test::ellipsoid_ct());
  int last = 0;
  const auto sent = send_files(server, quick_connection(), files_to_send({made_ / "ct"}),
                               [&](const TransferProgress& progress) { last = progress.done; });
  EXPECT_EQ(sent.outcome, SendSummary::Outcome::Stored) << sent.files.front().note;
  EXPECT_EQ(last, kImageCount);
  EXPECT_EQ(sent.commitment, Commitment::NotSupported);

  const auto found = find(server, quick_connection(), {.patient_id = "4711"});
  ASSERT_EQ(found.patients.size(), 1U);
  EXPECT_EQ(found.patients[0].name, "Muster^Anna");
  const FoundStudy& study = found.patients[0].studies.at(0);
  EXPECT_EQ(study.uid, test::DicomSeriesForm{}.origin.study_uid);
  EXPECT_EQ(study.date, "20260130");
  ASSERT_EQ(study.series.size(), 1U);
  EXPECT_EQ(study.series[0].modality, "CT");
  EXPECT_EQ(study.series[0].image_count, kImageCount);
  EXPECT_TRUE(find(server, quick_connection(), {.patient_id = "0815"}).patients.empty());

  const auto got = retrieve_series(server, quick_connection(), request());
  EXPECT_EQ(got.outcome, Outcome::Whole) << got.message;
  EXPECT_EQ(got.way, "WADO-RS");
  EXPECT_EQ(got.image_count, kImageCount);
  EXPECT_EQ(pixels_of(got_ / "scan"), pixels_of(made_ / "ct"));
  EXPECT_THAT(got_.names(), ElementsAre("scan"));
  EXPECT_EQ(retrieve_series(server, quick_connection(), request()).kept_count, kImageCount);
}

TEST_F(PacsWeb, GoesOnWhereItWasStoppedOrBroke) {
  test::Orthanc orthanc({.offers_web = true});
  const WebServer server = server_of(orthanc);
  test::write_and_send(orthanc, made_ / "ct");
  std::stop_source stop;
  const auto stopped = retrieve_series(
      server, quick_connection(), request(),
      [&](const TransferProgress& progress) {
        if (progress.done == 7) stop.request_stop();
      },
      stop.get_token());
  EXPECT_EQ(stopped.outcome, Outcome::Stopped);
  EXPECT_FALSE(fs::exists(got_ / "scan"));
  const auto kill = [&](const TransferProgress& progress) {
    if (progress.done == 20) orthanc.kill();
  };
  EXPECT_THAT(failure_of([&] { (void)retrieve_series(server, quick_connection(), request(), kill); }),
              HasSubstr("cannot be reached"));
  EXPECT_FALSE(fs::exists(got_ / "scan"));
  orthanc.start();
  bool was_killed = false;
  const auto resumed =
      retrieve_series(server, quick_connection(), request(), [&](const TransferProgress& progress) {
        if (progress.done != 30 || std::exchange(was_killed, true)) return;
        orthanc.kill();  // and up again when we try
        orthanc.start();
      });
  EXPECT_EQ(resumed.outcome, Outcome::Whole) << resumed.message;
  EXPECT_EQ(resumed.kept_count, 20);
  EXPECT_EQ(pixels_of(got_ / "scan"), pixels_of(made_ / "ct"));
}

// A server that is gone for good in the middle: what it has stored is told, object by object, and why the
// rest is not; sent again, all is there. Where nothing was stored the error alone says so.
TEST_F(PacsWeb, KeepsAnAccountOfWhatWasStoredWhenTheServerIsGone) {
  test::Orthanc orthanc({.offers_web = true});
  const WebServer server = server_of(orthanc);
  test::write_dicom_series(made_ / "ct", test::ellipsoid_ct());
  const std::vector<SentFile> files = files_to_send({made_ / "ct"});
  const auto broken = send_files(server, quick_connection(), files, [&](const TransferProgress& progress) {
    if (progress.done == 7) orthanc.kill();
  });
  EXPECT_EQ(broken.outcome, SendSummary::Outcome::BrokenOff);
  EXPECT_THAT(broken.failure, HasSubstr("cannot be reached"));
  ASSERT_EQ(broken.files.size(), files.size());
  for (std::size_t i = 0; i < files.size(); ++i) {
    EXPECT_EQ(broken.files[i].is_stored, i < 7) << i;
    EXPECT_EQ(broken.files[i].note.empty(), i < 7) << broken.files[i].note;
    EXPECT_EQ(broken.files[i].note == "not sent", i > 7) << broken.files[i].note;
  }
  EXPECT_THAT(broken.files[7].note, ::testing::StartsWith("not confirmed: "));
  EXPECT_THAT(broken.files[7].note, HasSubstr("cannot be reached"));
  EXPECT_THAT(failure_of([&] { (void)send_files(server, quick_connection(), files); }),
              HasSubstr("cannot be reached"));
  orthanc.start();
  EXPECT_EQ(send_files(server, quick_connection(), files).outcome, SendSummary::Outcome::Stored);
}

// A disk that is too full for the next image is told as that, with folder and room, and not as the server's
// fault; of the image nothing is left, and what came whole before waits for more room.
TEST_F(PacsWeb, TellsAFullDiskAsWhatItIs) {
  const test::Orthanc orthanc({.offers_web = true});
  test::write_and_send(orthanc, made_ / "ct");
  RetrieveRequest tight = request();
  int asked = 0;
  tight.free_bytes = [&](const fs::path&) {
    constexpr std::uintmax_t kPlenty = std::uintmax_t{100} << 30;
    return ++asked <= 3 ? kPlenty : static_cast<std::uintmax_t>(tight.least_free_bytes) + 1000;
  };
  const std::string failure =
      failure_of([&] { (void)retrieve_series(server_of(orthanc), quick_connection(), tight); });
  EXPECT_EQ(failure, (got_ / "scan").string() + ": the disk has 537 MB free, of which 537 MB are to stay");
  EXPECT_FALSE(fs::exists(got_ / "scan"));
  ASSERT_EQ(got_.names().size(), 1U);
  for (const auto& waiting : fs::directory_iterator(got_ / got_.names().front()))
    EXPECT_EQ(waiting.path().extension(), ".dcm");
  const auto whole = retrieve_series(server_of(orthanc), quick_connection(), request());
  EXPECT_EQ(whole.outcome, Outcome::Whole) << whole.message;
  EXPECT_EQ(whole.kept_count, 3);
  EXPECT_EQ(pixels_of(got_ / "scan"), pixels_of(made_ / "ct"));
}

// A limit on the size of files ends a write half-way, as a disk does that somebody else fills meanwhile.
TEST_F(PacsWeb, TellsAWriteThatFailsAsWhatItIs) {
  const test::Orthanc orthanc({.offers_web = true});
  test::write_and_send(orthanc, made_ / "ct");
  rlimit before{};
  ::getrlimit(RLIMIT_FSIZE, &before);
  const auto handler = ::signal(SIGXFSZ, SIG_IGN);
  const rlimit full{1000, before.rlim_max};
  ::setrlimit(RLIMIT_FSIZE, &full);
  const std::string failure =
      failure_of([&] { (void)retrieve_series(server_of(orthanc), quick_connection(), request()); });
  ::setrlimit(RLIMIT_FSIZE, &before);
  ::signal(SIGXFSZ, handler);
  EXPECT_THAT(failure,
              ::testing::MatchesRegex((got_ / "scan").string() +
                                      ": cannot be written to: File too large; the disk has [0-9]+ MB free"));
  EXPECT_THAT(got_.names(), ElementsAre());
}

TEST_F(PacsWeb, AnUnknownSeriesLeavesNothing) {
  const test::Orthanc orthanc({.offers_web = true});
  RetrieveRequest unknown = request();
  unknown.series_uid = "1.2.3";
  EXPECT_EQ(retrieve_series(server_of(orthanc), quick_connection(), unknown).outcome, Outcome::UnknownSeries);
  EXPECT_THAT(got_.names(), ElementsAre());
}

TEST_F(PacsWeb, ChecksTheCertificateAndThePassword) {
  test::Authority authority("Clinic"), other("Somebody");
  // Debian's Orthanc does not outlive a caller by HTTPS, so something stands before it, as in a hospital.
  const test::Orthanc orthanc({.offers_web = true, .web_user = "theatre", .web_password = "secret-7"});
  const test::TlsFront front(authority.sign("server", "IP:127.0.0.1"), orthanc.web_port());
  WebServer server{.url = front.url(), .authority = {}, .user = {}, .password = {}};
  server.authority = authority.certificate();
  server.user = "theatre";
  server.password = "secret-7";
  EXPECT_GE(echo(server, quick_connection()), 0);
  const auto failure = [](const WebServer& wrong) {
    return failure_of([&] { (void)echo(wrong, quick_connection()); });
  };
  WebServer wrong = server;
  wrong.authority = other.certificate();
  EXPECT_THAT(failure(wrong), HasSubstr("is not trusted"));
  wrong.authority.clear();  // the system's, of which ours is none
  EXPECT_THAT(failure(wrong), HasSubstr("is not trusted"));
  wrong = server;
  wrong.url = "https" + orthanc.web_url().substr(4);  // which speaks http there
  EXPECT_THAT(failure(wrong), HasSubstr("may not speak TLS there"));
  wrong = server;
  wrong.password = "secret-8";
  EXPECT_THAT(failure(wrong), HasSubstr("HTTP 401"));
  EXPECT_THAT(failure(wrong), testing::Not(HasSubstr("secret")));
}

TEST_F(PacsWeb, RefusesACertificateOfAnotherHost) {
  test::Authority authority("Clinic");
  const test::TlsFront front(authority.sign("server", "DNS:pacs.hospital"), test::free_port());
  WebServer server{.url = front.url(), .authority = {}, .user = {}, .password = {}};
  server.authority = authority.certificate();
  EXPECT_THAT(failure_of([&] { (void)echo(server, quick_connection()); }), HasSubstr("is not trusted"));
}

TEST_F(PacsWeb, SaysWhatIsWrongWithTheUrl) {
  const auto refusal = [](const std::string& url, const std::string& user = "") {
    return failure_of([&] { check(WebServer{.url = url, .authority = {}, .user = user, .password = {}}); });
  };
  EXPECT_EQ(refusal("https://pacs.hospital:8443/dicom-web"), "");
  EXPECT_THAT(refusal("ftp://host/x"), HasSubstr("is written https://"));
  EXPECT_THAT(refusal("https:///x"), HasSubstr("names no host"));
  EXPECT_THAT(refusal("https://me:word@host/x"), HasSubstr("holds a user or a password"));
  EXPECT_THAT(refusal("https://host/x?y=1"), HasSubstr("query"));
  EXPECT_THAT(refusal("http://host/x", "me"), HasSubstr("does not go over http"));
}

// Whatever it answers: neither followed, nor taken without measure, nor believed.
TEST_F(PacsWeb, BoundsWhatAServerCanDo) {
  const auto failure = [&](const std::string& answer, std::size_t filler = 0) {
    const test::RawWebServer raw(answer, filler);
    ConnectionOptions once = quick_connection();
    once.retries = 0;
    return failure_of([&] { (void)find(WebServer{raw.url(), {}, {}, {}}, once, {.patient_id = "4711"}); });
  };
  EXPECT_THAT(failure("HTTP/1.1 302 Found\r\nLocation: http://127.0.0.1:1/\r\nContent-Length: 0\r\n\r\n"),
              HasSubstr("which is not followed"));
  EXPECT_THAT(failure("HTTP/1.1 200 OK\r\nContent-Type: application/dicom+json\r\n\r\n[", 80 << 20),
              HasSubstr("more than 64 MB"));
  EXPECT_THAT(failure("HTTP/1.1 200 OK\r\nContent-Length: 5\r\n\r\nhello"), HasSubstr("no JSON"));
  EXPECT_THAT(failure("HTTP/1.1 200 OK\r\nContent-Length: 100\r\n\r\n[]"), HasSubstr("broke off"));
  EXPECT_THAT(failure("HTTP/1.1 503 Busy\r\nContent-Length: 0\r\n\r\n"), HasSubstr("HTTP 503"));
}

std::string web_answer(const std::string& type, const std::string& body,
                       const std::string& status = "200 OK") {
  return "HTTP/1.1 " + status + "\r\nConnection: close\r\nContent-Type: " + type +
         "\r\nContent-Length: " + std::to_string(body.size()) + "\r\n\r\n" + body;
}

// Lists two images at a time, whatever is asked for.
class ListsTwo {
 public:
  ListsTwo(const fs::path& made, bool has_pages, std::size_t said) : has_pages_(has_pages), said_(said) {
    for (const SentFile& file : files_to_send({made})) {
      std::ifstream stream(file.file, std::ios::binary);
      images_.emplace_back(file.sop_instance_uid, std::string((std::istreambuf_iterator<char>(stream)), {}));
    }
  }
  [[nodiscard]] std::string answer(const std::string& request) const {
    const std::string line = request.substr(0, request.find("\r\n"));
    const test::DicomSeriesForm form;
    if (const auto at = line.find("/instances/"); at != std::string::npos) {
      for (const auto& [uid, bytes] : images_)
        if (line.find(uid + " ", at) != std::string::npos)
          return web_answer("multipart/related; type=\"application/dicom\"; boundary=cut",
                            "--cut\r\nContent-Type: application/dicom\r\n\r\n" + bytes + "\r\n--cut--");
      return web_answer("text/plain", "", "404 Not Found");
    }
    if (line.find("/instances") == std::string::npos)
      return list("{" + value("0020000E", form.origin.series_uid) + "," +
                  value("0020000D", form.origin.study_uid) + ",\"00201209\":{\"vr\":\"IS\",\"Value\":[" +
                  std::to_string(said_) + "]}}");
    const auto at = line.find("offset=");
    if (at != std::string::npos && !has_pages_) return web_answer("text/plain", "", "400 Bad Request");
    std::string objects;
    const std::size_t from = at == std::string::npos ? 0 : std::stoul(line.substr(at + 7));
    for (std::size_t i = from; i < std::min(from + 2, images_.size()); ++i)
      objects += (objects.empty() ? "{" : ",{") + value("00080018", images_[i].first) + "}";
    return list(objects);
  }
  [[nodiscard]] std::size_t count() const { return images_.size(); }

 private:
  static std::string value(const std::string& tag, const std::string& text) {
    return "\"" + tag + "\":{\"vr\":\"UI\",\"Value\":[\"" + text + "\"]}";
  }
  static std::string list(const std::string& objects) {
    return web_answer("application/dicom+json", "[" + objects + "]");
  }
  const bool has_pages_;
  const std::size_t said_;
  std::vector<std::pair<std::string, std::string>> images_;  // UID and file
};

// A list that the server has cut off is no whole series.
TEST_F(PacsWeb, AListThatIsCutOffIsPagedOrRefused) {
  test::write_dicom_series(made_ / "ct", test::ellipsoid_ct());
  ASSERT_GT(kImageCount, 4);
  const auto got = [&](bool has_pages, std::size_t said) {
    const ListsTwo lists(made_ / "ct", has_pages, said);
    const test::RawWebServer raw([&](const std::string& asked) { return lists.answer(asked); });
    return retrieve_series(WebServer{raw.url(), {}, {}, {}}, quick_connection(), request());
  };
  const RetrieveSummary cut = got(false, kImageCount);
  EXPECT_EQ(cut.outcome, Outcome::Incomplete);
  EXPECT_THAT(cut.message, HasSubstr("says that the series has " + std::to_string(kImageCount) +
                                     " images, and lists 2: nothing was fetched"));
  EXPECT_EQ(cut.way, "");
  EXPECT_THAT(got_.names(), ElementsAre());
  // It counts more than it has.
  EXPECT_EQ(got(true, kImageCount + 1).outcome, Outcome::Incomplete);
  EXPECT_THAT(got_.names(), ElementsAre());
  const RetrieveSummary whole = got(true, kImageCount);
  EXPECT_EQ(whole.outcome, Outcome::Whole) << whole.message;
  EXPECT_EQ(whole.image_count, kImageCount);
}

// What it says of what it was sent may be of any shape: nothing of it is stored, and nothing is thrown.
TEST_F(PacsWeb, AnAnswerToWhatWasSentMayBeOfAnyShape) {
  test::TemporaryFolder folder;
  test::write_dicom_series(folder / "ct", test::ellipsoid_ct());
  const SentFile file = files_to_send({folder / "ct"}).front();
  const std::string uid = '"' + file.sop_instance_uid + '"';
  for (const std::string& item :
       {"{\"00081155\":[" + uid + "]}", std::string("{\"00081155\":{\"Value\":{}}}"), std::string("7"),
        std::string("{}"), "{\"00081155\":{\"Value\":[" + uid + "]},\"00081197\":[1]}"}) {
    const std::string body = std::string("{\"00081198\":{\"Value\":[") + item + "]}}";
    const test::RawWebServer raw(
        "HTTP/1.1 200 OK\r\nContent-Type: application/dicom+json\r\nContent-Length: " +
        std::to_string(body.size()) + "\r\n\r\n" + body);
    ConnectionOptions once = quick_connection();
    once.retries = 0;
    const SendSummary summary = send_files(WebServer{raw.url(), {}, {}, {}}, once, {file});
    EXPECT_EQ(summary.outcome, SendSummary::Outcome::SomeRefused) << item;
    EXPECT_FALSE(summary.files.front().is_stored) << item;
  }
}

}  // namespace
}  // namespace arthronaut::pacs
