#include "planning/norms/insertion_norms.h"

#include <algorithm>
#include <array>
#include <string>

#include "planning/geometry/error.h"

namespace arthronaut::norms {

namespace {

using bones::BoneKind;

// The first of each bone and bundle is the default: the widest review there is. On the one knee on hand with
// known attachments (a musculoskeletal model) it lies some millimetres too deep; to fit a norm to one knee
// would be to know it, not to plan it, and further forward than 35 % lie the grafts that failed (de Mees
// 2022).
constexpr std::array kNorms{
    InsertionNorm{
        BoneKind::Femur, Bundle::Whole, {28.4, 5.1}, {35.7, 6.9}, "review of 13 studies (Arthroscopy 2016)"},
    InsertionNorm{
        BoneKind::Femur, Bundle::Whole, {24.8, 5.1}, {28.5, 6.9}, "Bernard, Hertel 1997 (PubMed 9051173)"},
    InsertionNorm{BoneKind::Femur,
                  Bundle::Whole,
                  {31.0, 5.1},
                  {23.5, 6.9},
                  "functional cortical footprint (AJSM 2016, 10.1177/0363546516665804)"},
    InsertionNorm{BoneKind::Femur, Bundle::Whole, {29.0, 5.1}, {35.0, 6.9}, "Parkar 2017", true},
    InsertionNorm{
        BoneKind::Femur, Bundle::Anteromedial, {24.2, 4.0}, {21.6, 5.2}, "review (Arthroscopy 2016)"},
    InsertionNorm{BoneKind::Femur, Bundle::Anteromedial, {22.8, 4.0}, {23.2, 5.2}, "Sullivan 2015 (HSS J)"},
    InsertionNorm{
        BoneKind::Femur, Bundle::Posterolateral, {32.8, 4.7}, {46.7, 4.9}, "review (Arthroscopy 2016)"},
    InsertionNorm{BoneKind::Femur, Bundle::Posterolateral, {32.5, 4.7}, {50.0, 4.9}, "Sullivan 2015 (HSS J)"},
    InsertionNorm{BoneKind::Tibia,
                  Bundle::Whole,
                  {39.7, 3.5},
                  {46.3, 2.2},
                  "mean of Cho 2017 (PMC5686853) and Meuffels 2012 (CT); across: 10.1177/23259671231208678 "
                  "(46.7 and 45.9 %)"},
    InsertionNorm{BoneKind::Tibia,
                  Bundle::Whole,
                  {40.9, 3.5},
                  {46.7, 2.0},
                  "Amis-Jakob, Cho 2017 (PMC5686853); across: 10.1177/23259671231208678"},
    InsertionNorm{BoneKind::Tibia, Bundle::Whole, {46.2, 2.8}, {46.7, 2.0}, "Musahl 2003"},
    InsertionNorm{
        BoneKind::Tibia, Bundle::Whole, {41.2, 5.1}, {46.7, 2.0}, "Staubli, Rauschning 1994: 21 of 51 mm"},
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

std::span<const InsertionNorm> insertion_norms() { return kNorms; }

const InsertionNorm& default_norm(bones::BoneKind bone, Bundle bundle) {
  return *std::find_if(kNorms.begin(), kNorms.end(),
                       [&](const auto& norm) { return norm.bone == bone && norm.bundle == bundle; });
}

}  // namespace arthronaut::norms
