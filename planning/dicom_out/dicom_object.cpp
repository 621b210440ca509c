#include "planning/dicom_out/dicom_object.h"

#include <arthronaut/version.h>

#include <algorithm>
#include <iterator>
#include <vector>

#include "planning/dicom_out/elements.h"
#include "planning/dicom_out/object_bytes.h"
#include "planning/dicom_out/uid.h"

namespace arthronaut::dicom_out {

namespace {

// Patient (C.7.1.1), general study (C.7.2.1).
void add_patient_and_study(DcmDataset& dataset, const Belonging& belonging) {
  const images::DicomOrigin& study = belonging.study;
  put(dataset, DCM_SpecificCharacterSet, "ISO_IR 192");
  put(dataset, DCM_PatientName, belonging.is_deidentified ? "Anonymous^" : belonging.patient.patient_name);
  put(dataset, DCM_PatientID, belonging.patient.patient_id);
  put_if_known(dataset, DCM_IssuerOfPatientID, study.patient_id_issuer);
  put(dataset, DCM_PatientBirthDate, belonging.patient.birth_date);
  put(dataset, DCM_PatientSex, study.patient_sex);
  if (belonging.is_deidentified) {
    put(dataset, DCM_PatientIdentityRemoved, "YES");
    put(dataset, DCM_DeidentificationMethod, "Arthronaut: made without patient, study and dates");
    put(dataset, DCM_LongitudinalTemporalInformationModified, "REMOVED");
  }
  put(dataset, DCM_StudyInstanceUID, study.study_uid);
  put(dataset, DCM_StudyDate, study.study_date);
  put(dataset, DCM_StudyTime, study.study_time);
  put(dataset, DCM_StudyID, study.study_id);
  put(dataset, DCM_AccessionNumber, study.accession_number);
  put(dataset, DCM_ReferringPhysicianName, study.referring_physician);
  // It would be said of the study's times as well, and of those that came with images nobody knows it.
  if (!belonging.is_of_images && !belonging.is_deidentified) put(dataset, DCM_TimezoneOffsetFromUTC, "+0000");
}

void put_content_moment(DcmDataset& dataset, const Belonging& belonging, const ObjectSetting& setting) {
  const DicomMoment moment = setting.moment_in(belonging);
  put(dataset, DCM_ContentDate, moment.date);
  put(dataset, DCM_ContentTime, moment.time);
}

// Encapsulated document (C.24.2).
void add_document(DcmDataset& dataset, const ObjectSetting& setting, const std::string& title,
                  const char* mime_type, const std::string& bytes) {
  put(dataset, DCM_AcquisitionDateTime, "");
  put(dataset, DCM_ImageLaterality, setting.side == bones::Side::Left ? "L" : "R");
  put(dataset, DCM_DocumentTitle, title);
  put_empty_sequence(dataset, DCM_ConceptNameCodeSequence);
  put(dataset, DCM_MIMETypeOfEncapsulatedDocument, mime_type);
  // DCMTK adds a zero to an odd length; the true one stands beside it.
  put_bytes(dataset, DCM_EncapsulatedDocument, bytes.data(), bytes.size());
  put_long_number(dataset, DCM_EncapsulatedDocumentLength, static_cast<Uint32>(bytes.size()));
}

// The images that a model was made from: in the document (C.24.2) and by their series (C.12.2).
void add_sources(DcmDataset& dataset, const images::DicomOrigin& study) {
  std::vector<std::string> uids;
  std::copy_if(study.sop_instance_uids.begin(), study.sop_instance_uids.end(), std::back_inserter(uids),
               is_uid);
  if (!is_uid(study.sop_class_uid) || !is_uid(study.series_uid) || uids.empty()) return;
  DcmItem& series = item_of(dataset, DCM_ReferencedSeriesSequence, 0);
  put(series, DCM_SeriesInstanceUID, study.series_uid);
  for (std::size_t i = 0; i < uids.size(); ++i) {
    const auto number = static_cast<long>(i);
    for (DcmItem* item : {&item_of(dataset, DCM_SourceInstanceSequence, number),
                          &item_of(series, DCM_ReferencedInstanceSequence, number)}) {
      put(*item, DCM_ReferencedSOPClassUID, study.sop_class_uid);
      put(*item, DCM_ReferencedSOPInstanceUID, uids[i]);
    }
  }
}

}  // namespace

DicomMoment ObjectSetting::moment_in(const Belonging& belonging) const {
  if (belonging.is_deidentified) return {};
  return belonging.is_of_images ? local_moment_from(moment_utc) : moment_from(moment_utc);
}

Object begun(const Belonging& belonging, const ObjectKind& kind, const char* sop_class) {
  Object object{
      .file_name = {}, .belonging = belonging, .kind = kind, .dataset = std::make_unique<DcmDataset>()};
  DcmDataset& dataset = *object.dataset;
  put(dataset, DCM_SOPClassUID, sop_class);
  add_patient_and_study(dataset, belonging);
  put(dataset, DCM_Modality, kind.modality);
  put(dataset, DCM_SeriesNumber, std::to_string(kind.series_number));
  put(dataset, DCM_SeriesDescription, kind.series_description);
  put(dataset, DCM_Manufacturer, "Arthronaut");
  put(dataset, DCM_ManufacturerModelName, "Arthronaut");
  put(dataset, DCM_SoftwareVersions, kProgramVersion);
  return object;
}

void put_knee(DcmDataset& dataset, const ObjectSetting& setting) {
  put(dataset, DCM_Laterality, setting.side == bones::Side::Left ? "L" : "R");
  put(dataset, DCM_BodyPartExamined, "KNEE");
}

Object model_object(const Belonging& belonging, const ObjectSetting& setting, const std::string& title,
                    const std::string& stl, bool is_modified) {
  Object object = begun(belonging, kModels, UID_EncapsulatedSTLStorage);
  DcmDataset& dataset = *object.dataset;
  // Of an enhanced general equipment (C.7.5.2) the number must not be empty, and a program has none.
  put(dataset, DCM_DeviceSerialNumber, "none");
  put(dataset, DCM_FrameOfReferenceUID, belonging.study.frame_of_reference_uid);
  put(dataset, DCM_PositionReferenceIndicator, "");
  put_content_moment(dataset, belonging, setting);
  put(dataset, DCM_BurnedInAnnotation, "NO");
  add_document(dataset, setting, title, "model/stl", stl);
  add_sources(dataset, belonging.study);
  // Manufacturing 3D model (C.35.1).
  DcmItem& unit = item_of(dataset, DCM_MeasurementUnitsCodeSequence, 0);
  put(unit, DCM_CodeValue, "mm");
  put(unit, DCM_CodingSchemeDesignator, "UCUM");
  put(unit, DCM_CodeMeaning, "mm");
  put(dataset, DCM_ModelModification, is_modified ? "YES" : "NO");
  put(dataset, DCM_ModelMirroring, "NO");
  return object;
}

Object report_object(const Belonging& belonging, const ObjectSetting& setting, const std::string& pdf) {
  Object object = begun(belonging, kDocument, UID_EncapsulatedPDFStorage);
  DcmDataset& dataset = *object.dataset;
  put(dataset, DCM_ConversionType, "WSD");  // of a workstation (C.8.6.1)
  put_content_moment(dataset, belonging, setting);
  put(dataset, DCM_BurnedInAnnotation, belonging.patient.is_empty() ? "NO" : "YES");
  add_document(dataset, setting, "ACL reconstruction: plan and report", "application/pdf", pdf);
  return object;
}

Object picture_object(const Belonging& belonging, const ObjectSetting& setting, const KeyPicture& picture) {
  Object object = begun(belonging, kPictures, UID_SecondaryCaptureImageStorage);
  DcmDataset& dataset = *object.dataset;
  put(dataset, DCM_ConversionType, "WSD");
  put_knee(dataset, setting);
  put_content_moment(dataset, belonging, setting);
  put(dataset, DCM_PatientOrientation, "");
  put_if_known(dataset, DCM_ImageComments, picture.title);
  // Image pixel (C.7.6.3).
  put_number(dataset, DCM_SamplesPerPixel, 3);
  put(dataset, DCM_PhotometricInterpretation, "RGB");
  put_number(dataset, DCM_PlanarConfiguration, 0);
  put_number(dataset, DCM_Rows, picture.height);
  put_number(dataset, DCM_Columns, picture.width);
  put_number(dataset, DCM_BitsAllocated, 8);
  put_number(dataset, DCM_BitsStored, 8);
  put_number(dataset, DCM_HighBit, 7);
  put_number(dataset, DCM_PixelRepresentation, 0);
  put_bytes(dataset, DCM_PixelData, picture.rgb.data(), picture.rgb.size());
  return object;
}

void number(Object& object, const std::string& series_uid, int instance_number) {
  put(*object.dataset, DCM_SeriesInstanceUID, series_uid);
  put(*object.dataset, DCM_InstanceNumber, std::to_string(instance_number));
  put(*object.dataset, DCM_SOPInstanceUID, uid_of("instance", bytes_of(*object.dataset)));
}

}  // namespace arthronaut::dicom_out
