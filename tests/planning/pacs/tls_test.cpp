// TLS with a real PACS: who is trusted, who is not, and why.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "planning/pacs/query.h"
#include "planning/pacs/retrieve.h"
#include "tests/planning/pacs/certificates.h"
#include "tests/planning/pacs/sent_series.h"

namespace arthronaut::pacs {
namespace {

using test::quick_connection;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

class PacsTls : public ::testing::Test {
 protected:
  [[nodiscard]] test::OrthancForm form(const std::string& made_out_to, int days = 2) {
    const std::string path = authority_.sign("PACS", made_out_to, days);
    return {.certificate = path + ".pem", .key = path + ".key", .authority = authority_.certificate()};
  }
  [[nodiscard]] ConnectionOptions secure() {
    ConnectionOptions connection = quick_connection();
    connection.tls = authority_.ours();
    return connection;
  }
  static std::string refusal_of(const Peer& peer, const ConnectionOptions& connection) {
    try {
      (void)echo(peer, connection);
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "";
  }
  test::Authority authority_{"Hospital authority"};
};

TEST_F(PacsTls, FindsFetchesAndSends) {
  test::OrthancForm settings = form("IP:127.0.0.1");
  const int our_port = test::free_port();
  settings.our_port = our_port;
  const test::Orthanc orthanc(settings);
  const test::TemporaryFolder folder;
  ConnectionOptions connection = secure();
  EXPECT_GT(echo(orthanc.peer(), connection), 0);
  test::write_and_send(orthanc, folder / "ct", {}, connection);
  EXPECT_EQ(find(orthanc.peer(), connection, {.patient_id = "4711"}).patients.size(), 1U);
  const RetrieveRequest request{
      .series_uid = test::DicomSeriesForm{}.origin.series_uid, .study_uid = "", .folder = folder / "got"};
  EXPECT_TRUE(retrieve_series(orthanc.peer(), connection, request).is_usable());
  EXPECT_EQ(test::pixels_of(folder / "got"), test::pixels_of(folder / "ct"));
}

// The other way round: the peer calls us, and trusts our certificate.
TEST_F(PacsTls, IsCalledBack) {
  test::OrthancForm settings = form("IP:127.0.0.1");
  settings.our_port = test::free_port();
  settings.allows_get = false;
  const test::Orthanc orthanc(settings);
  const test::TemporaryFolder folder;
  ConnectionOptions connection = secure();
  connection.listening_port = settings.our_port;
  test::write_and_send(orthanc, folder / "ct", {}, connection);
  const RetrieveRequest request{
      .series_uid = test::DicomSeriesForm{}.origin.series_uid, .study_uid = "", .folder = folder / "got"};
  const auto summary = retrieve_series(orthanc.peer(), connection, request);
  EXPECT_EQ(summary.way, "C-MOVE");
  EXPECT_EQ(test::pixels_of(folder / "got"), test::pixels_of(folder / "ct"));
}

TEST_F(PacsTls, RefusesWhomTheAuthorityDoesNotSign) {
  const test::Orthanc orthanc(form("IP:127.0.0.1"));
  test::Authority stranger("Somebody else");
  ConnectionOptions connection = secure();
  connection.tls->authority = stranger.certificate();
  EXPECT_THAT(refusal_of(orthanc.peer(), connection),
              AllOf(HasSubstr("its certificate"), HasSubstr("not trusted"), Not(HasSubstr("tried"))));
}

// A peer that refuses ours often closes without a word of why.
TEST_F(PacsTls, SaysThatOursMayNotBeTrusted) {
  const test::Orthanc orthanc(form("IP:127.0.0.1"));
  test::Authority stranger("Somebody else");
  const std::string path = stranger.sign("stranger", "DNS:theatre").string();
  ConnectionOptions connection = secure();
  connection.tls->certificate = path + ".pem";
  connection.tls->key = path + ".key";
  EXPECT_THAT(refusal_of(orthanc.peer(), connection), HasSubstr("trust"));
}

TEST_F(PacsTls, RefusesAnExpiredCertificate) {
  const test::Orthanc orthanc(form("IP:127.0.0.1", -1));
  EXPECT_THAT(refusal_of(orthanc.peer(), secure()), HasSubstr("certificate has expired"));
}

TEST_F(PacsTls, RefusesACertificateOfAnotherHost) {
  const test::Orthanc orthanc(form("DNS:other.hospital"));
  EXPECT_THAT(refusal_of(orthanc.peer(), secure()), HasSubstr("it is not made out to 127.0.0.1"));
  ConnectionOptions named = secure();
  named.tls->name = "other.hospital";
  EXPECT_EQ(refusal_of(orthanc.peer(), named), "");
  named.tls->name = "third.hospital";
  EXPECT_THAT(refusal_of(orthanc.peer(), named), HasSubstr("it is not made out to third.hospital"));
}

TEST_F(PacsTls, DoesNotMixWithTheClear) {
  const test::Orthanc secret(form("IP:127.0.0.1"));
  EXPECT_THAT(refusal_of(secret.peer(), quick_connection()), HasSubstr(to_text(secret.peer())));
  const test::Orthanc open;
  EXPECT_THAT(refusal_of(open.peer(), secure()),
              AllOf(HasSubstr(to_text(open.peer())), HasSubstr("may not speak TLS there")));
}

TEST_F(PacsTls, RefusesKeysThatDoNotFitWithoutShowingThem) {
  const test::TemporaryFolder folder;
  const Peer nobody{"PACS", "127.0.0.1", 1};
  ConnectionOptions connection = secure();
  const std::string sealed = folder / "sealed.key", password = folder / "password";
  test::run_openssl("rsa -aes256 -passout pass:Geheim17 -in " + connection.tls->key.string() + " -out " +
                    sealed);

  ConnectionOptions wrong = connection;
  wrong.tls->key = sealed;
  EXPECT_THAT(refusal_of(nobody, wrong), HasSubstr("sealed.key: holds no private key that can be used"));
  std::ofstream(password) << "Falsch18\n";
  wrong.tls->key_password_file = password;
  EXPECT_THAT(refusal_of(nobody, wrong), AllOf(HasSubstr("sealed.key"), Not(HasSubstr("Falsch18"))));
  std::ofstream(password) << "Geheim17\nanother line\n";
  EXPECT_THAT(refusal_of(nobody, wrong), HasSubstr("Connection refused"));  // the key was opened

  ConnectionOptions foreign = connection;
  foreign.tls->key = authority_.sign("other", "DNS:other").string() + ".key";
  EXPECT_THAT(refusal_of(nobody, foreign), HasSubstr("other.key: is not the key of"));
  ConnectionOptions swapped = connection;
  swapped.tls->certificate = connection.tls->key;
  EXPECT_THAT(refusal_of(nobody, swapped), HasSubstr("holds no certificate that can be used"));
}

}  // namespace
}  // namespace arthronaut::pacs
