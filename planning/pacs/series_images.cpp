#include "planning/pacs/series_images.h"

#include <algorithm>

#include "planning/files/format.h"
#include "planning/geometry/error.h"
#include "planning/images/dicom_file.h"
#include "planning/pacs/finding.h"

namespace arthronaut::pacs {

namespace {

using images::text_of;
using images::utf8_text_of;

// A frame an image, of the longest that are made.
constexpr int kMostImages = 100000;
constexpr const char* kBroke = "broke off while it listed the series";

// False when the connection broke; throws when the peer refuses.
bool ask(Association& association, const Peer& peer, DcmDataset& query,
         const std::function<void(DcmDataset&)>& take) {
  const FindOutcome outcome = send_find(association, query, kMostImages, take);
  if (outcome.is_cut)
    throw DeviceError(to_text(peer) + ": lists more than " + std::to_string(kMostImages) +
                      " images for one series");
  if (!outcome.refusal.empty() && !outcome.is_broken)
    throw DeviceError(to_text(peer) + ": " + outcome.refusal);
  return !outcome.is_broken;
}

bool ask_both(Association& association, const Peer& peer, const std::string& series_uid,
              const std::string& study_uid, SeriesImages& found) {
  found = {};
  DcmDataset series;
  put_key(series, DCM_QueryRetrieveLevel, "SERIES");
  put_key(series, DCM_PatientID, "");
  put_key(series, DCM_StudyInstanceUID, study_uid);
  put_key(series, DCM_SeriesInstanceUID, series_uid);
  put_key(series, DCM_NumberOfSeriesRelatedInstances, "");
  const auto take_series = [&](DcmDataset& answer) {
    if (text_of(answer, DCM_SeriesInstanceUID) != series_uid) return;
    const std::string study = text_of(answer, DCM_StudyInstanceUID);
    if (!study_uid.empty() && !study.empty() && study != study_uid) return;
    found.is_known = true;
    found.study_uid = study;
    found.patient_id = utf8_text_of(answer, DCM_PatientID);
    found.said_count = std::max(found.said_count, count_of(answer, DCM_NumberOfSeriesRelatedInstances));
  };
  if (!ask(association, peer, series, take_series)) return false;
  if (!found.is_known) return true;
  if (found.study_uid.empty()) found.study_uid = study_uid;

  DcmDataset images;
  put_key(images, DCM_QueryRetrieveLevel, "IMAGE");
  put_key(images, DCM_PatientID, found.patient_id);
  put_key(images, DCM_StudyInstanceUID, found.study_uid);
  put_key(images, DCM_SeriesInstanceUID, series_uid);
  put_key(images, DCM_SOPInstanceUID, "");
  put_key(images, DCM_SOPClassUID, "");
  const auto take_image = [&](DcmDataset& answer) {
    const std::string uid = text_of(answer, DCM_SOPInstanceUID);
    if (is_uid(uid))
      found.class_by_uid[uid] = text_of(answer, DCM_SOPClassUID);
    else
      ++found.nameless_count;
  };
  return ask(association, peer, images, take_image);
}

}  // namespace

std::string SeriesImages::cut_off_words() const {
  return files::format(
      "says that the series has %d images, and lists %d: nothing was fetched, as the others cannot be asked "
      "for. Whoever keeps it may let it list more at once, or count the series anew",
      said_count, static_cast<int>(class_by_uid.size()));
}

SeriesImages ask_series_images(const Peer& peer, const ConnectionOptions& connection,
                               const std::string& series_uid, const std::string& study_uid,
                               const std::stop_token& stop) {
  std::vector<Proposal> proposals;
  propose_find(proposals);
  SeriesImages found;
  for (int attempt = 0;; ++attempt) {
    const auto association = Association::connect(peer, connection, proposals, stop);
    if (!association) break;
    const bool is_answered = ask_both(*association, peer, series_uid, study_uid, found);
    if (stop.stop_requested()) break;
    if (is_answered) {
      association->release();
      if (found.nameless_count > 0)
        throw DeviceError(to_text(peer) + ": lists " + std::to_string(found.nameless_count) +
                          " images of the series without a valid UID, which cannot be asked for");
      return found;
    }
    if (attempt >= connection.retries) throw DeviceError(to_text(peer) + ": " + kBroke);
    pause_before_retry(connection, attempt, kBroke, stop);
  }
  found.was_stopped = true;
  return found;
}

}  // namespace arthronaut::pacs
