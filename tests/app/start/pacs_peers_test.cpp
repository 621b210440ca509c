#include "app/start/pacs_peers.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "planning/files/atomic_file.h"
#include "planning/geometry/error.h"
#include "tests/temporary_folder.h"

namespace arthronaut::start {
namespace {

using ::testing::HasSubstr;

PacsPeerForm archive() {
  PacsPeerForm form;
  form.name = "Archive";
  form.address = "PACS@pacs.hospital:104";
  return form;
}

std::string refusal_of(const auto& action) {
  try {
    action();
  } catch (const InvalidInput& error) {
    return error.what();
  }
  return "";
}

TEST(PacsPeers, AreKeptAsTheyWereTyped) {
  const test::TemporaryFolder folder;
  for (const char* file : {"ca.pem", "our.pem", "our.key"}) files::write_atomically(folder / file, "PEM");
  PacsPeerForm secure = archive();
  secure.name = "Theatre";
  secure.our_ae_title = "THEATRE3";
  secure.listening_port = "11112";
  secure.authority = (folder / "ca.pem").string();
  secure.certificate = (folder / "our.pem").string();
  secure.key = (folder / "our.key").string();
  secure.tls_name = "pacs.example";
  const auto file = folder / "data/pacs.json";
  EXPECT_TRUE(load_pacs_peers(file).empty());
  save_pacs_peers(file, {peer_of(archive()), peer_of(secure)});
  const auto peers = load_pacs_peers(file);
  ASSERT_EQ(peers.size(), 2U);
  EXPECT_EQ(pacs::to_text(peers[0].peer), "PACS@pacs.hospital:104");
  EXPECT_FALSE(peers[0].connection.tls);
  EXPECT_EQ(peers[0].connection.listening_port, 0);
  const PacsPeerForm again = form_of(peers[1]);
  EXPECT_EQ(again.name, secure.name);
  EXPECT_EQ(again.our_ae_title, secure.our_ae_title);
  EXPECT_EQ(again.listening_port, secure.listening_port);
  EXPECT_EQ(again.authority, secure.authority);
  EXPECT_EQ(again.certificate, secure.certificate);
  EXPECT_EQ(again.key, secure.key);
  EXPECT_EQ(again.tls_name, secure.tls_name);
}

TEST(PacsPeers, SayWhatIsWrongWithTheForm) {
  const auto refusal = [](const PacsPeerForm& form) { return refusal_of([&] { (void)peer_of(form); }); };
  EXPECT_EQ(refusal(archive()), "");
  PacsPeerForm form = archive();
  form.name = "";
  EXPECT_THAT(refusal(form), HasSubstr("needs a name"));
  form = archive();
  form.address = "pacs.hospital:104";
  EXPECT_THAT(refusal(form), HasSubstr("has no AE title"));
  for (const char* port : {"0", "65536", "x", "104x", "-1"}) {
    form = archive();
    form.listening_port = port;
    EXPECT_THAT(refusal(form), HasSubstr("1 to 65535")) << port;
  }
  form = archive();
  form.our_ae_title = "A TITLE THAT IS TOO LONG";
  EXPECT_THAT(refusal(form), HasSubstr("our AE title"));
  form = archive();
  form.authority = "/none/ca.pem";
  EXPECT_THAT(refusal(form), HasSubstr("our certificate"));
}

// What somebody typed in a file that is broken now can be mended by hand: adding a PACS leaves it alone.
TEST(PacsPeers, ABrokenFileIsNotWrittenOver) {
  const test::TemporaryFolder folder;
  const auto file = folder / "pacs.json";
  const std::string broken = R"({"format": "arthronaut.pacs_peers", "version": 1, "peers": [)";
  files::write_atomically(file, broken);
  EXPECT_THAT(refusal_of([&] { save_pacs_peers(file, {peer_of(archive())}); }), HasSubstr("pacs.json"));
  std::ifstream kept(file);
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(kept), {}), broken);
}

TEST(PacsPeers, ABrokenFileIsSaidWithItsPlace) {
  const test::TemporaryFolder folder;
  const auto refusal = [&](const std::string& peers) {
    const auto file = folder / "pacs.json";
    files::write_atomically(file,
                            R"({"format": "arthronaut.pacs_peers", "version": 1, "peers": [)" + peers + "]}");
    return refusal_of([&] { (void)load_pacs_peers(file); });
  };
  const std::string good =
      R"({"name": "A", "peer": "PACS@host:104", "our_ae_title": "US", "listening_port": 0})";
  EXPECT_EQ(refusal(good), "");
  EXPECT_THAT(refusal(good + "," + good), HasSubstr("peers[1].name"));
  EXPECT_THAT(refusal(R"({"name": "A", "peer": "host", "our_ae_title": "US", "listening_port": 0})"),
              HasSubstr("has no AE title"));
  EXPECT_THAT(refusal(R"({"name": "A", "peer": "P@h:1", "our_ae_title": "US", "listening_port": 70000})"),
              HasSubstr("listening_port"));
}

// A DICOMweb server beside the others; its password stands in its own file, never in this one. A list without
// one can be read by the programs before it.
TEST(PacsPeers, KeepADicomWebServer) {
  const test::TemporaryFolder folder;
  files::write_atomically(folder / "ca.pem", "PEM");
  PacsPeerForm web = archive();
  web.name = "Web";
  web.address = "https://pacs.hospital/dicom-web";
  web.authority = (folder / "ca.pem").string();
  web.user = "theatre3";
  web.key_password_file = (folder / "password").string();
  const PacsPeer made = peer_of(web);
  EXPECT_TRUE(made.is_web());
  EXPECT_TRUE(made.is_encrypted());
  const auto file = folder / "pacs.json";
  save_pacs_peers(file, {peer_of(archive())});
  EXPECT_THAT(files::read_text(file), HasSubstr("\"version\": 1"));
  save_pacs_peers(file, {peer_of(archive()), made});
  EXPECT_THAT(files::read_text(file), HasSubstr("\"version\": 2"));
  const auto peers = load_pacs_peers(file);
  ASSERT_EQ(peers.size(), 2U);
  EXPECT_FALSE(peers[0].is_web());
  const PacsPeerForm again = form_of(peers[1]);
  EXPECT_EQ(again.address, web.address);
  EXPECT_EQ(again.authority, web.authority);
  EXPECT_EQ(again.user, web.user);
  EXPECT_EQ(again.key_password_file, web.key_password_file);
  EXPECT_EQ(peers[1].web.password, "");

  web.certificate = (folder / "ca.pem").string();
  EXPECT_THAT(refusal_of([&] { (void)peer_of(web); }), HasSubstr("no certificate of ours"));
  web.certificate.clear();
  web.address = "http://pacs.hospital/dicom-web";
  EXPECT_THAT(refusal_of([&] { (void)peer_of(web); }), HasSubstr("use https"));
  PacsPeerForm dimse = archive();
  dimse.user = "theatre3";
  EXPECT_THAT(refusal_of([&] { (void)peer_of(dimse); }), HasSubstr("belongs to a DICOMweb server"));
}

}  // namespace
}  // namespace arthronaut::start
