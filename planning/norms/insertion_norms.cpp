#include "planning/norms/insertion_norms.h"

#include <algorithm>
#include <array>
#include <string>

#include "planning/geometry/error.h"

namespace arthronaut::norms {

namespace {

using bones::BoneKind;

// The widest review there is. On the one knee on hand with known attachments (a musculoskeletal model) the
// femur's lies some millimetres too deep; to fit a norm to one knee would be to know it, not to plan it, and
// further forward than 35 % lie the grafts that failed (de Mees 2022).
constexpr std::array kNorms{
    InsertionNorm{
        BoneKind::Femur, Bundle::Whole, {28.4, 5.1}, {35.7, 6.9}, "review of 13 studies (Arthroscopy 2016)"},
    InsertionNorm{
        BoneKind::Femur, Bundle::Anteromedial, {24.2, 4.0}, {21.6, 5.2}, "review (Arthroscopy 2016)"},
    InsertionNorm{
        BoneKind::Femur, Bundle::Posterolateral, {32.8, 4.7}, {46.7, 4.9}, "review (Arthroscopy 2016)"},
    InsertionNorm{BoneKind::Tibia,
                  Bundle::Whole,
                  {39.7, 3.5},
                  {46.3, 2.2},
                  "mean of Cho 2017 (PMC5686853) and Meuffels 2012 (CT); across: 10.1177/23259671231208678 "
                  "(46.7 and 45.9 %)"},
    InsertionNorm{BoneKind::Tibia,
                  Bundle::Anteromedial,
                  {30.5, 3.5},
                  {46.3, 2.2},
                  "a quarter of the footprint's length (18.1 mm, Ferretti 2012) in front of its centre",
                  true},
    InsertionNorm{BoneKind::Tibia,
                  Bundle::Posterolateral,
                  {48.9, 3.5},
                  {46.3, 2.2},
                  "a quarter of the footprint's length (18.1 mm, Ferretti 2012) behind its centre",
                  true},
};

}  // namespace

std::string_view to_text(Bundle bundle) {
  switch (bundle) {
    case Bundle::Whole:
      return "single";
    case Bundle::Anteromedial:
      return "am";
    case Bundle::Posterolateral:
      return "pl";
  }
  return "unknown";
}

Bundle bundle_from_text(std::string_view text) {
  for (const Bundle bundle : {Bundle::Whole, Bundle::Anteromedial, Bundle::Posterolateral}) {
    if (text == to_text(bundle)) return bundle;
  }
  throw InvalidInput("\"" + std::string(text) + "\" is no bundle: single, am or pl");
}

const InsertionNorm& default_norm(bones::BoneKind bone, Bundle bundle) {
  return *std::find_if(kNorms.begin(), kNorms.end(),
                       [&](const auto& norm) { return norm.bone == bone && norm.bundle == bundle; });
}

std::string cited(const InsertionNorm& norm) {
  return std::string(norm.source) + (norm.is_recalled ? ", customary" : "");
}

}  // namespace arthronaut::norms
