#include "tests/planning/pacs/certificates.h"

#include <cstdlib>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace arthronaut::test {

void run_openssl(const std::string& arguments) {
  const TemporaryFolder folder;
  const std::string said = folder / "said";
  if (std::system(("openssl " + arguments + " > " + said + " 2>&1").c_str()) == 0) return;
  std::ostringstream text;
  text << std::ifstream(said).rdbuf();
  throw std::runtime_error("openssl " + arguments + ": " + text.str());
}

Authority::Authority(const std::string& name) {
  run_openssl("req -x509 -newkey rsa:2048 -nodes -days 2 -subj '/CN=" + name + "' -keyout " +
              (folder_ / "authority.key").string() + " -out " + certificate().string());
}

std::filesystem::path Authority::sign(const std::string& name, const std::string& made_out_to, int days) {
  const std::string path = folder_ / name;
  std::ofstream(path + ".ext") << "subjectAltName=" << made_out_to << "\n";
  run_openssl("req -new -newkey rsa:2048 -nodes -subj '/CN=" + name + "' -keyout " + path + ".key -out " +
              path + ".csr");
  run_openssl("x509 -req -in " + path + ".csr -CA " + certificate().string() + " -CAkey " +
              (folder_ / "authority.key").string() + " -set_serial 1 -days " + std::to_string(days) +
              " -extfile " + path + ".ext -out " + path + ".pem");
  return path;
}

pacs::TlsOptions Authority::ours() {
  const std::string path = sign("ARTHRONAUT", "DNS:theatre.hospital");
  pacs::TlsOptions options;
  options.certificate = path + ".pem";
  options.key = path + ".key";
  options.authority = certificate();
  return options;
}

}  // namespace arthronaut::test
