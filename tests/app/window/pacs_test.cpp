// The hospital's PACS as a hand works it: a peer typed in, the patient found, the series fetched and
// imported, the results of a case sent.
#include <gtest/gtest.h>

#include <filesystem>
#include <functional>

#include "planning/cases/case.h"
#include "planning/cases/identity.h"
#include "planning/files/atomic_file.h"
#include "planning/pacs/query.h"
#include "planning/pacs/web.h"
#include "planning/phantom/phantom_case.h"
#include "tests/app/window/display.h"
#include "tests/planning/pacs/certificates.h"
#include "tests/planning/pacs/sent_series.h"
#include "tests/planning/pacs/tls_front.h"
#include "tests/temporary_folder.h"

namespace arthronaut::test {
namespace {

namespace fs = std::filesystem;

class PacsWindow : public ::testing::Test {
 protected:
  void SetUp() override {
    if (const std::string missing = missing_for_window_tests(); !missing.empty()) GTEST_SKIP() << missing;
  }
  // more: of the peer, in JSON, with a comma before it.
  void write_peers(const std::string& address, const std::string& more = "") const {
    fs::create_directories(folder_ / "arthronaut");
    files::write_atomically(
        folder_ / "arthronaut/pacs.json",
        R"({"format": "arthronaut.pacs_peers", "version": 2, "peers": [{"name": "Archive", "peer": ")" +
            address + R"(", "our_ae_title": "ARTHRONAUT", "listening_port": )" + std::to_string(our_port_) +
            more + "}]}");
  }
  void write_peers(const Orthanc& orthanc) const { write_peers(pacs::to_text(orthanc.peer())); }
  void save_knee() const {
    cases::save_case(folder_ / "Knee.arthro",
                     phantom::case_of(phantom::make_phantom_knee({.edge_length_mm = 3}), "Knee of a test"));
  }
  // From the open case: listed first, then a key held. `stored`: how many patients the PACS has.
  static void send_results(RunningWorkstation& app, const std::function<std::size_t()>& stored) {
    ASSERT_TRUE(app.wait_for_state("case", "open", 120));
    app.press("F5");
    ASSERT_TRUE(app.wait_for_state("case_selected", "Knee of a test"));
    app.press("p");
    ASSERT_TRUE(app.wait_for_state("pacs_light", "good")) << app.state("pacs_says");
    app.press("r");
    ASSERT_TRUE(app.wait_for_state("pacs", "send"));
    ASSERT_TRUE(app.wait_for_state("pacs_sends", "the open case"));
    app.press("d");
    app.press("Return");
    ASSERT_TRUE(app.wait_for_state("pacs_work", "write-done", 120) ||
                app.state("pacs_work") == "write-unreliable")
        << app.state("pacs_says");
    EXPECT_NE(app.state("pacs_outgoing"), "0");
    app.press("Return");  // a press is not enough
    EXPECT_EQ(stored(), 0U);
    ASSERT_TRUE(app.hold_until("Return", "pacs_work", "send-done", 120)) << app.state("pacs_says");
    EXPECT_EQ(stored(), 1U);
  }
  const TemporaryFolder folder_;
  const int our_port_ = free_port();
};

TEST_F(PacsWindow, TakesAPeerFindsThePatientAndImportsTheSeries) {
  const Orthanc orthanc;
  const TemporaryFolder made;
  write_and_send(orthanc, made / "ct");
  const VirtualDisplay display(1280, 720);
  RunningWorkstation app(display, folder_.path(), {"--frames", "0"});
  ASSERT_TRUE(app.wait_for_state("start", "cases"));
  ASSERT_TRUE(app.wait_for_widget("start.case.0"));
  app.press("p");
  ASSERT_TRUE(app.wait_for_state("start", "pacs"));
  EXPECT_EQ(app.state("pacs_peer"), "none");
  app.press("a");
  ASSERT_TRUE(app.wait_for_state("pacs", "peer"));
  ASSERT_TRUE(app.wait_for_state("pacs_typing", "yes"));
  app.type("Archive");
  app.press("Tab");
  ASSERT_TRUE(app.wait_for_state("pacs_field", "start.pacs.form.address"));
  app.type("no address");
  app.press("Return");
  ASSERT_TRUE(app.wait_for_state("pacs_failure",
                                 "peer \"no address\": has no AE title; it is written AET@HOST:PORT"));
  ASSERT_TRUE(app.wait_for_state("pacs_typing", "no"));
  app.click("start.pacs.form.address");
  ASSERT_TRUE(app.wait_for_state("pacs_typing", "yes"));
  app.press("ctrl+a");
  app.type(pacs::to_text(orthanc.peer()));
  app.press("Return");
  ASSERT_TRUE(app.wait_for_state("pacs", "search"));
  ASSERT_TRUE(app.wait_for_state("pacs_light", "good"));
  EXPECT_TRUE(fs::exists(folder_ / "arthronaut/pacs.json"));

  app.press("f");
  ASSERT_TRUE(app.wait_for_state("pacs_typing", "yes"));
  app.type("4711");
  app.press("Return");
  ASSERT_TRUE(app.wait_for_state("pacs_work", "find-done"));
  ASSERT_TRUE(app.wait_for_state("pacs_typing", "no"));
  ASSERT_TRUE(app.wait_for_widget("start.pacs.series.2"));
  app.press("Return");
  ASSERT_TRUE(app.wait_for_state("start", "import"));
  ASSERT_TRUE(app.wait_for_state("import", "choosing", 120));
  ASSERT_TRUE(app.wait_for_widget("start.source.0"));
}

// A PACS that is away is said to be so, by light and by words; Esc leads back out.
TEST_F(PacsWindow, SaysThatThePacsIsAway) {
  auto orthanc = std::make_unique<Orthanc>();
  write_peers(*orthanc);
  orthanc->kill();
  const VirtualDisplay display(1280, 720);
  RunningWorkstation app(display, folder_.path(), {"--frames", "0"});
  ASSERT_TRUE(app.wait_for_widget("start.case.0"));
  app.press("p");
  ASSERT_TRUE(app.wait_for_state("pacs_light", "bad"));
  EXPECT_NE(app.state("pacs_says").find("cannot be reached"), std::string::npos);
  orthanc->start();
  app.press("e");
  ASSERT_TRUE(app.wait_for_state("pacs_light", "good"));
  // A light stays green no longer than it was answered.
  orthanc->kill();
  app.press("f");
  ASSERT_TRUE(app.wait_for_state("pacs_typing", "yes"));
  app.type("4711");
  app.press("Return");
  ASSERT_TRUE(app.wait_for_state("pacs_work", "find-failed"));
  EXPECT_EQ(app.state("pacs_light"), "quiet");
  ASSERT_TRUE(app.wait_for_state("pacs_typing", "no"));
  app.press("Escape");
  ASSERT_TRUE(app.wait_for_state("start", "cases"));
}

// Nothing leaves before it was listed, and before a key was held.
TEST_F(PacsWindow, SendsTheResultsOfTheOpenCase) {
  const Orthanc orthanc({.our_port = our_port_});
  write_peers(orthanc);
  save_knee();
  const VirtualDisplay display(1280, 720);
  // By another way: it is the open one all the same.
  std::filesystem::create_directory_symlink(folder_ / "Knee.arthro", folder_ / "Way.arthro");
  RunningWorkstation app(display, folder_.path(), {(folder_ / "Way.arthro").string()});
  send_results(app, [&] {
    return pacs::find(orthanc.peer(), quick_connection(), {.patient_name = "*"}).patients.size();
  });
  EXPECT_EQ(app.state("pacs_commitment"), "confirmed");
  app.press("Escape");
  ASSERT_TRUE(app.wait_for_state("pacs", "search"));
  EXPECT_FALSE(fs::exists(folder_ / "arthronaut/outgoing"));
}

// The line is encrypted both ways: the PACS calls us with what it keeps, and is shown our certificate.
TEST_F(PacsWindow, SendsByTls) {
  Authority authority("Hospital authority");
  const std::string theirs = authority.sign("PACS", "IP:127.0.0.1").string();
  const Orthanc orthanc({.our_port = our_port_,
                         .certificate = theirs + ".pem",
                         .key = theirs + ".key",
                         .authority = authority.certificate()});
  pacs::ConnectionOptions connection = quick_connection();
  connection.tls = authority.ours();
  write_peers(pacs::to_text(orthanc.peer()),
              R"(, "tls": {"certificate": ")" + connection.tls->certificate.string() + R"(", "key": ")" +
                  connection.tls->key.string() + R"(", "authority": ")" + connection.tls->authority.string() +
                  R"(", "key_password_file": "", "name": ""})");
  save_knee();
  const VirtualDisplay display(1280, 720);
  RunningWorkstation app(display, folder_.path(), {(folder_ / "Knee.arthro").string()});
  send_results(app,
               [&] { return pacs::find(orthanc.peer(), connection, {.patient_name = "*"}).patients.size(); });
  EXPECT_EQ(app.state("pacs_commitment"), "confirmed");
}

// By DICOMweb, encrypted, as a user with a password from a file. It has no storage commitment.
TEST_F(PacsWindow, SendsByDicomWeb) {
  Authority authority("Hospital authority");
  const Orthanc orthanc({.offers_web = true, .web_user = "theatre", .web_password = "secret-7"});
  const TlsFront front(authority.sign("server", "IP:127.0.0.1"), orthanc.web_port());
  files::write_atomically(folder_ / "password", "secret-7\n");
  fs::permissions(folder_ / "password", fs::perms::owner_read | fs::perms::owner_write);
  const pacs::WebServer server{
      .url = front.url(), .authority = authority.certificate(), .user = "theatre", .password = "secret-7"};
  write_peers(server.url, R"(, "web": {"authority": ")" + server.authority.string() +
                              R"(", "user": "theatre", "password_file": ")" +
                              (folder_ / "password").string() + R"("})");
  save_knee();
  const VirtualDisplay display(1280, 720);
  RunningWorkstation app(display, folder_.path(), {(folder_ / "Knee.arthro").string()});
  send_results(app, [&] {
    return pacs::find(orthanc.peer(), quick_connection(), {.patient_name = "*"}).patients.size();
  });
}

// The case that is selected in the list is what is sent: where it is not the open one, that is said.
TEST_F(PacsWindow, SaysThatWhatWouldBeSentIsOfAnotherCase) {
  const Orthanc orthanc({.our_port = our_port_});
  write_peers(orthanc);
  const auto knee = phantom::make_phantom_knee({.edge_length_mm = 3});
  for (const char* name : {"First", "Second"})
    cases::save_case(folder_ / (std::string(name) + ".arthro"), phantom::case_of(knee, name));
  const VirtualDisplay display(1280, 720);
  {  // What was open once is in the list.
    RunningWorkstation before(display, folder_.path(), {(folder_ / "Second.arthro").string()});
    ASSERT_TRUE(before.wait_for_state("case", "open", 120));
  }
  RunningWorkstation app(display, folder_.path(), {(folder_ / "First.arthro").string()});
  ASSERT_TRUE(app.wait_for_state("case", "open", 120));
  app.press("F5");
  ASSERT_TRUE(app.wait_for_state("case_selected", "First"));
  ASSERT_TRUE(app.wait_for_widget("start.case.1"));
  app.click("start.case.1");
  ASSERT_TRUE(app.wait_for_state("case_selected", "Second"));
  app.press("p");
  ASSERT_TRUE(app.wait_for_state("pacs_light", "good"));
  app.press("r");
  ASSERT_TRUE(app.wait_for_state("pacs_sends", "another case"));
}

// Whose images after the operation are looked for is known.
TEST_F(PacsWindow, AsksForThePatientOfTheCase) {
  write_peers("ORTHANC@127.0.0.1:1");
  save_knee();
  cases::save_identity(folder_ / "Knee.arthro", {"Muster^Anna", "4711", "19900131"});
  const VirtualDisplay display(1280, 720);
  RunningWorkstation app(display, folder_.path(), {(folder_ / "Knee.arthro").string()});
  ASSERT_TRUE(app.wait_for_state("case", "open", 120));
  app.press("F5");
  ASSERT_TRUE(app.wait_for_state("case_selected", "Knee of a test"));
  app.press("p");
  EXPECT_TRUE(app.wait_for_state("pacs_patient", "4711"));
}

}  // namespace
}  // namespace arthronaut::test
