#include "navigation/registration/search/noise_model.h"

namespace arthronaut::registration {

ResidualEvidence evidence_of(double residual_mm, const NoiseModel& model) {
  const Explainer explainer(model);
  const ByExplanation joint = explainer.shares() * explainer.densities_per_mm(residual_mm);
  const auto [contact, soft, lifted] = (1 / joint.sum()) * joint;
  const double contact_slope = residual_mm * explainer.contact_information();
  const double soft_slope = (residual_mm - kSoftHeight_mm) * explainer.soft_information();
  ResidualEvidence evidence;
  evidence.contact = contact;
  evidence.slope = contact * contact_slope + soft * soft_slope;
  evidence.information = contact * explainer.contact_information() + soft * explainer.soft_information();
  const double square_slope = contact * contact_slope * contact_slope + soft * soft_slope * soft_slope;
  evidence.curvature = evidence.information - (square_slope - evidence.slope * evidence.slope);
  return evidence;
}

}  // namespace arthronaut::registration
