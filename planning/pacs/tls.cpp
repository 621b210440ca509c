#include "planning/pacs/tls.h"

#include <arpa/inet.h>
#include <openssl/err.h>
#include <openssl/ssl.h>
#include <openssl/x509v3.h>

#include <mutex>

#include "planning/files/atomic_file.h"
#include "planning/geometry/error.h"

namespace arthronaut::pacs {

struct SecureLayer::Verdict {
  mutable std::mutex mutex;
  std::string host, refusal;

  // OpenSSL's own checks stand; this only keeps what they say. An address that only the subject's common name
  // holds is taken as OpenSSL takes a name there.
  static int note(int is_good, X509_STORE_CTX* store);
};

namespace {

int verdict_index() {
  static const int index = SSL_CTX_get_ex_new_index(0, nullptr, nullptr, nullptr, nullptr);
  return index;
}

bool is_address(const std::string& host) {
  in_addr address{};
  return inet_pton(AF_INET, host.c_str(), &address) == 1;
}

std::string common_name_of(X509* certificate) {
  if (certificate == nullptr) return "";
  char name[256] = {};
  X509_NAME_get_text_by_NID(X509_get_subject_name(certificate), NID_commonName, name, sizeof(name));
  return name;
}

std::string take_openssl_reason() {
  std::string reason;
  while (const unsigned long code = ERR_get_error()) {
    const char* text = ERR_reason_error_string(code);
    if (text != nullptr) reason = text;  // the last is the outermost
  }
  return reason.empty() ? "not PEM" : reason;
}

void check(const OFCondition& condition, const std::filesystem::path& file, const std::string& what) {
  if (condition.good()) return;
  const std::string reason = take_openssl_reason();
  throw InvalidInput(file, "", "holds no " + what + " that can be used: " + reason);
}

std::string password_of(const std::filesystem::path& file) {
  if (file.empty()) return "";
  const std::string text = files::read_text(file);
  return text.substr(0, text.find_first_of("\r\n"));
}

}  // namespace

int SecureLayer::Verdict::note(int is_good, X509_STORE_CTX* store) {
  if (is_good == 1) return 1;
  const auto* ssl =
      static_cast<const SSL*>(X509_STORE_CTX_get_ex_data(store, SSL_get_ex_data_X509_STORE_CTX_idx()));
  auto* verdict = static_cast<Verdict*>(SSL_CTX_get_ex_data(SSL_get_SSL_CTX(ssl), verdict_index()));
  const std::scoped_lock lock(verdict->mutex);
  X509* certificate = X509_STORE_CTX_get_current_cert(store);
  const int error = X509_STORE_CTX_get_error(store);
  if (error == X509_V_ERR_IP_ADDRESS_MISMATCH && certificate != nullptr &&
      X509_check_host(certificate, verdict->host.c_str(), 0, 0, nullptr) == 1) {
    X509_STORE_CTX_set_error(store, X509_V_OK);
    return 1;
  }
  std::string reason = X509_verify_cert_error_string(error);
  const bool is_other_host = error == X509_V_ERR_HOSTNAME_MISMATCH || error == X509_V_ERR_IP_ADDRESS_MISMATCH;
  if (is_other_host) reason = "it is not made out to " + verdict->host;
  verdict->refusal = "its certificate (" + common_name_of(certificate) + ") is not trusted: " + reason;
  return 0;
}

SecureLayer::SecureLayer(const TlsOptions& options, T_ASC_NetworkRole role, const std::string& host)
    : verdict_(std::make_unique<Verdict>()) {
  static std::once_flag once;
  std::call_once(once, [] { DcmTLSTransportLayer::initializeOpenSSL(); });
  layer_ =
      std::make_unique<LineLayer<DcmTLSTransportLayer>>(role, static_cast<const char*>(nullptr), OFFalse);
  // Set in any case: without one OpenSSL would ask on the terminal.
  layer_->setPrivateKeyPasswd(password_of(options.key_password_file).c_str());
  ERR_clear_error();
  check(layer_->setPrivateKeyFile(options.key.c_str(), DCF_Filetype_PEM), options.key, "private key");
  check(layer_->setCertificateFile(options.certificate.c_str(), DCF_Filetype_PEM), options.certificate,
        "certificate");
  if (!layer_->checkPrivateKeyMatchesCertificate())
    throw InvalidInput(options.key, "", "is not the key of " + options.certificate.string());
  check(layer_->addTrustedCertificateFile(options.authority.c_str(), DCF_Filetype_PEM), options.authority,
        "certificate");
  if (layer_->setTLSProfile(TSP_Profile_BCP195).bad() || layer_->activateCipherSuites().bad())
    throw DeviceError("TLS: the profile of BCP 195 is not available in this OpenSSL");
  layer_->setCertificateVerification(DCV_requireCertificate);

  SSL_CTX* context = layer_->getNativeHandle();
  verdict_->host = options.name.empty() ? host : options.name;
  SSL_CTX_set_ex_data(context, verdict_index(), verdict_.get());
  SSL_CTX_set_verify(context, SSL_VERIFY_PEER | SSL_VERIFY_FAIL_IF_NO_PEER_CERT, &Verdict::note);
  if (host.empty()) return;
  X509_VERIFY_PARAM* expected = SSL_CTX_get0_param(context);
  const int is_set = is_address(verdict_->host)
                         ? X509_VERIFY_PARAM_set1_ip_asc(expected, verdict_->host.c_str())
                         : X509_VERIFY_PARAM_set1_host(expected, verdict_->host.c_str(), 0);
  if (is_set != 1) throw InvalidInput("TLS: no certificate can be made out to \"" + verdict_->host + "\"");
}

SecureLayer::~SecureLayer() = default;

std::string SecureLayer::refusal() const {
  const std::scoped_lock lock(verdict_->mutex);
  return verdict_->refusal;
}

}  // namespace arthronaut::pacs
