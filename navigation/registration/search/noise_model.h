// What the height of a tip above the bone says about how it met the bone.
//
// What the tip tells is not symmetric: it never goes into the bone, but it is lifted off, and it rides on
// soft tissue. So the noise model of a residual (signed distance to the bone) is a mixture of three: contact,
// normal about 0; soft tissue, normal about 0.9 mm; lifted, any height above the bone, and hardly ever inside
// it. Their shares and the contact's spread are found with the pose by expectation maximisation (A. P.
// Dempster, N. M. Laird, D. B. Rubin, "Maximum likelihood from incomplete data via the EM algorithm", Journal
// of the Royal Statistical Society B 39, 1977). Registration by EM over a mixture with a part for what lies
// nowhere near is known from A. Myronenko, X. Song, "Point set registration: coherent point drift", IEEE
// TPAMI 32, 2010; there the parts are points, here they are ways in which a tip meets a surface.
#pragma once

#include <algorithm>
#include <cmath>

namespace arthronaut::registration {

struct NoiseModel {
  double contact_sigma_mm = 0.4;
  double soft_share = 0.10;
  double lifted_share = 0.10;
  // Of a lifted point inside the bone, by mm: a gross error, twenty times rarer than a lift. As likely as a
  // lift where the mesh may hold cartilage that is not there.
  double buried_density_per_mm = kRarelyBuried_per_mm;
  static constexpr double kRarelyBuried_per_mm = 0.01, kOftenBuried_per_mm = 0.2;

  [[nodiscard]] double contact_share() const { return 1 - soft_share - lifted_share; }
};

// Laws of the three explanations. Lifts are alike up to the field's band, and all beyond it count as the last
// of them. Into the bone goes nothing but a gross error: a pose that buries strokes can't explain them away.
inline constexpr double kSoftHeight_mm = 0.9, kSoftSigma_mm = 0.37;
inline constexpr double kLiftedDensity_per_mm = 0.2, kLiftOnset_mm = 0.15;
inline constexpr double kMinSigma_mm = 0.06, kMaxSigma_mm = 0.6;

class NormalDensity {
 public:
  explicit NormalDensity(double sigma) : variance_(sigma * sigma), area_(sigma * 2.5066282746310002) {}
  [[nodiscard]] double at(double x) const { return std::exp(-0.5 * x * x / variance_) / area_; }

 private:
  double variance_, area_;
};

// A number for each of the ways in which a tip meets the bone.
struct ByExplanation {
  double contact = 0, soft = 0, lifted = 0;

  [[nodiscard]] double sum() const { return contact + soft + lifted; }
};
inline ByExplanation operator*(const ByExplanation& a, const ByExplanation& b) {
  return {a.contact * b.contact, a.soft * b.soft, a.lifted * b.lifted};
}
inline ByExplanation operator*(double factor, const ByExplanation& a) {
  return {factor * a.contact, factor * a.soft, factor * a.lifted};
}
inline ByExplanation operator+(const ByExplanation& a, const ByExplanation& b) {
  return {a.contact + b.contact, a.soft + b.soft, a.lifted + b.lifted};
}

// By one noise model, of which all that many residuals share is worked out once.
class Explainer {
 public:
  explicit Explainer(const NoiseModel& model)
      : shares_{model.contact_share(), model.soft_share, model.lifted_share},
        buried_density_per_mm_(model.buried_density_per_mm),
        contact_(model.contact_sigma_mm),
        soft_(std::hypot(kSoftSigma_mm, model.contact_sigma_mm)),
        contact_information_(1 / (model.contact_sigma_mm * model.contact_sigma_mm)),
        soft_information_(1 / (kSoftSigma_mm * kSoftSigma_mm + 1 / contact_information_)) {}

  [[nodiscard]] const ByExplanation& shares() const { return shares_; }
  // Of the residual, were it known how the tip met the bone.
  [[nodiscard]] ByExplanation densities_per_mm(double residual_mm) const {
    const double share_above = 1 / (1 + std::exp(-residual_mm / kLiftOnset_mm));
    return {contact_.at(residual_mm), soft_.at(residual_mm - kSoftHeight_mm),
            buried_density_per_mm_ + (kLiftedDensity_per_mm - buried_density_per_mm_) * share_above};
  }
  // What a residual says of the height, 1/mm^2, and how far the pose is from what it says.
  struct Pull {
    double information, miss_mm;
  };
  [[nodiscard]] Pull pull_of(double residual_mm, const ByExplanation& probabilities) const {
    const double soft = probabilities.soft * soft_information_;
    const double information = probabilities.contact * contact_information_ + soft;
    return {information, residual_mm - (information > 0 ? kSoftHeight_mm * soft / information : 0.0)};
  }
  [[nodiscard]] double contact_information() const { return contact_information_; }
  [[nodiscard]] double soft_information() const { return soft_information_; }

 private:
  ByExplanation shares_;
  double buried_density_per_mm_;
  NormalDensity contact_, soft_;
  double contact_information_, soft_information_;
};

// The M step for the noise model, from how each residual is explained by the one before. The shares lean on a
// prior of a few mm of path, so that none dies out.
class ModelUpdate {
 public:
  void add(const ByExplanation& probabilities, double residual_mm, double weight) {
    sums_ = sums_ + weight * probabilities;
    square_sum_ += weight * probabilities.contact * residual_mm * residual_mm;
  }
  [[nodiscard]] NoiseModel updated(const NoiseModel& model) const {
    NoiseModel updated = model;
    updated.contact_sigma_mm = std::clamp(std::sqrt(square_sum_ / sums_.contact), kMinSigma_mm, kMaxSigma_mm);
    updated.soft_share = sums_.soft / sums_.sum();
    updated.lifted_share = sums_.lifted / sums_.sum();
    return updated;
  }

 private:
  static constexpr double kPriorWeight = 4.0;
  ByExplanation sums_{kPriorWeight, 0.1 * kPriorWeight, 0.1 * kPriorWeight};
  double square_sum_ = 0.2 * 0.2 * kPriorWeight;
};

// What the noise model says about one residual: the derivatives of its negative log density.
struct ResidualEvidence {
  double contact = 0;      // probability that the tip touched the bone
  double slope = 0;        // first derivative, 1/mm
  double curvature = 0;    // second derivative, 1/mm^2; negative where explanations compete
  double information = 0;  // the curvature if it were known which explanation holds, 1/mm^2
};
[[nodiscard]] ResidualEvidence evidence_of(double residual_mm, const NoiseModel& model);

}  // namespace arthronaut::registration
