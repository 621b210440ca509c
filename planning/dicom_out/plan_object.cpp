#include "planning/dicom_out/dicom_object.h"
#include "planning/dicom_out/elements.h"
#include "planning/files/format.h"

namespace arthronaut::dicom_out {

namespace {

std::string coordinates(const Eigen::Vector3d& p) {
  // A decimal string has room for 16 characters.
  return files::format("%.4f\\%.4f\\%.4f", p.x(), p.y(), p.z());
}

struct Fiducial {
  std::string identifier, description;  // at most 16 characters; a sentence
  std::vector<Eigen::Vector3d> points_mm;
};

void add_fiducial(DcmItem& set, long number, const Fiducial& fiducial) {
  DcmItem& item = item_of(set, DCM_FiducialSequence, number);
  put(item, DCM_FiducialIdentifier, fiducial.identifier);
  put(item, DCM_FiducialDescription, fiducial.description);
  put(item, DCM_ShapeType, fiducial.points_mm.size() == 1 ? "POINT" : "LINE");
  put(item, DCM_NumberOfContourPoints, std::to_string(fiducial.points_mm.size()));
  std::string data;
  for (const Eigen::Vector3d& p : fiducial.points_mm) data += (data.empty() ? "" : "\\") + coordinates(p);
  put(item, DCM_ContourData, data);
}

}  // namespace

Object plan_object(const Belonging& belonging, const ObjectSetting& setting,
                   const std::vector<PlannedTunnel>& tunnels) {
  Object object = begun(belonging, kPlan, UID_SpatialFiducialsStorage);
  DcmDataset& dataset = *object.dataset;
  put_knee(dataset, setting);
  // Here a date is asked for: what stands for one that is not told is long before there was any such plan.
  const DicomMoment moment = setting.moment_in(belonging);
  put(dataset, DCM_ContentDate, moment.date.empty() ? "19000101" : moment.date);
  put(dataset, DCM_ContentTime, moment.date.empty() ? "000000" : moment.time);
  put(dataset, DCM_ContentLabel, "TUNNEL_PLAN");
  put(dataset, DCM_ContentDescription, "Planned tunnels of an ACL reconstruction, plan " + setting.plan_hash);
  put(dataset, DCM_ContentCreatorName, "");
  long set_number = 0;
  for (const PlannedTunnel& planned : tunnels) {
    const bool is_femur = planned.tunnel.bone == bones::BoneKind::Femur;
    std::string capitals = is_femur ? "FEMUR" : "TIBIA", bundle;
    if (planned.tunnel.bundle != norms::Bundle::Whole) {
      bundle = planned.tunnel.bundle == norms::Bundle::Anteromedial ? "AM" : "PL";
      capitals += "_" + bundle;
      bundle += " ";
    }
    const std::string of_tunnel = files::format("the %s's %stunnel of %.1f mm", is_femur ? "femur" : "tibia",
                                                bundle.c_str(), planned.tunnel.diameter_mm);
    DcmItem& set = item_of(dataset, DCM_FiducialSetSequence, set_number++);
    put(set, DCM_FrameOfReferenceUID, planned.frame_of_reference_uid);
    add_fiducial(
        set, 0,
        {capitals + "_ENTRY", "Entry of " + of_tunnel + ", from the joint", {planned.tunnel.entry_mm}});
    add_fiducial(set, 1, {capitals + "_EXIT", "Exit of " + of_tunnel, {planned.exit_mm}});
    add_fiducial(set, 2,
                 {capitals + "_AXIS", "Axis of " + of_tunnel, {planned.tunnel.entry_mm, planned.exit_mm}});
  }
  return object;
}

}  // namespace arthronaut::dicom_out
