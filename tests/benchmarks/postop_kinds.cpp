#include "tests/benchmarks/postop_kinds.h"

#include <algorithm>

namespace arthronaut::test {

namespace {

double between(double low, double high, std::mt19937_64& random) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

// Of the head of a bone: thin cortex, marrow that is not even.
void as_in_the_metaphysis(KnownCtOptions& ct, std::mt19937_64& random) {
  ct.cortex_hu = between(700, 1300, random);
  ct.marrow_hu = between(120, 220, random);
  ct.blur_mm = between(0.05, 0.5, random);
  ct.operate = uneven_marrow(ct.marrow_hu, 35, 1.2, ct.seed);
}

// Whatever scanner and bone, the tunnel plain.
void as_anywhere(Drilled& how, KnownCtOptions& ct, std::mt19937_64& random) {
  const double in_plane_mm = between(0.35, 0.6, random);
  ct.spacing_mm = {in_plane_mm, in_plane_mm, between(0.5, 1.25, random)};
  ct.blur_mm = between(0.2, 0.9, random);
  ct.noise_hu = between(15, 45, random);
  ct.cortex_mm = between(0.8, 2, random);
  ct.cortex_hu = between(700, 1400, random);
  ct.marrow_hu = between(130, 230, random);
  how.content_hu = between(40, ct.marrow_hu - 60, random);
  if (between(0, 1, random) < 0.5)
    ct.operate = uneven_marrow(ct.marrow_hu, between(10, 40, random), between(0.8, 2, random), ct.seed);
}

DrilledKind varied(const char* name,
                   std::function<void(Drilled&, KnownCtOptions&, std::mt19937_64&)> change) {
  return {name,
          [change = std::move(change)](Drilled& how, KnownCtOptions& ct, std::mt19937_64& random) {
            as_anywhere(how, ct, random);
            change(how, ct, random);
          },
          8,
          14,
          6,
          12};
}

}  // namespace

const std::vector<DrilledKind>& drilled_kinds() {
  static const std::vector<DrilledKind> all{
      {"fine", [](auto&, auto&, auto&) {}},
      {"1 mm slices, blurred",
       [](auto&, auto& ct, auto&) {
         ct.spacing_mm = {0.6, 0.6, 1.0};
         ct.blur_mm = 0.5;
       }},
      {"soft kernel", [](auto&, auto& ct, auto& random) { ct.blur_mm = between(0.6, 1.0, random); }},
      {"graft 40 HU below marrow", [](auto& how, auto&, auto&) { how.content_hu = 110; }},
      {"dense rim, graft as marrow",
       [](auto& how, auto&, auto&) {
         how.content_hu = 150;
         how.rim_hu = 400;
         how.rim_mm = 1.2;
       }},
      {"socket of 22 mm", [](auto& how, auto&, auto&) { how.to_mm = 22; }},
      {"widened by 3 mm at the entry", [](auto& how, auto&, auto&) { how.widened_mm = 3; }},
      {"screw of 7 mm to 16 mm",
       [](auto& how, auto&, auto&) {
         how.screw_diameter_mm = 7;
         how.screw_to_mm = 16;
         how.screw_aside_mm = 0.5;
       }},
      {"metal along all of it but 5 mm",
       [](auto& how, auto& ct, auto& random) {
         ct.blur_mm = 0.5;
         how.screw_diameter_mm = 7;
         how.screw_from_mm = 5;
         how.screw_to_mm = 60;
         how.screw_aside_mm = between(0, 0.5, random) * (how.tunnel.diameter_mm - 7);
       }},
      {"one density, air about it",
       [](auto& how, auto& ct, auto&) {
         ct.marrow_hu = ct.cortex_hu = 800;
         ct.soft_tissue_hu = -1000;
         how.content_hu = -1000;
         ct.noise_hu = 40;
       }},
      {"any rim, uneven marrow",
       [](auto& how, auto& ct, auto& random) {
         as_in_the_metaphysis(ct, random);
         how.content_hu = between(40, 110, random);
         how.rim_hu = between(300, 550, random);
         how.rim_mm = between(0.0, 1.5, random);
       }},
      {"faint graft, uneven marrow",
       [](auto& how, auto& ct, auto& random) {
         as_in_the_metaphysis(ct, random);
         how.content_hu = ct.marrow_hu - between(20, 60, random);
         if (between(0, 1, random) < 0.5) how.to_mm = 25;
       }},
      {"bone plug of 20 mm",
       [](auto& how, auto&, auto& random) {
         how.plug_hu = 450;
         how.plug_diameter_mm = how.tunnel.diameter_mm - between(0.5, 2, random);
         how.plug_from_mm = between(0, 8, random);
         how.plug_to_mm = how.plug_from_mm + 20;
       }},
      {"button and bore of 4.5 mm beyond 25 mm",
       [](auto& how, auto& ct, auto& random) {
         as_in_the_metaphysis(ct, random);
         how.narrow_from_mm = 25;
         how.screw_diameter_mm = 4;
         how.screw_from_mm = 33;
         how.screw_to_mm = 60;
       }},
      varied("varied, plain one", [](auto&, auto&, auto&) {}),
      varied("varied, socket", [](auto& how, auto&, auto& random) { how.to_mm = between(15, 28, random); }),
      varied("varied, graft of 40 to 150 HU",
             [](auto& how, auto&, auto& random) {
               how.content_hu = between(40, 150, random);
               if (between(0, 1, random) < 0.5) how.to_mm = between(15, 28, random);
             }),
      varied("varied, dense rim",
             [](auto& how, auto&, auto& random) {
               how.content_hu = between(40, 150, random);
               how.rim_hu = between(300, 600, random);
               how.rim_mm = between(0.3, 1.6, random);
             }),
      varied("varied, button",
             [](auto& how, auto&, auto& random) {
               how.narrow_from_mm = between(15, 28, random);
               how.screw_diameter_mm = 4;
               how.screw_from_mm = how.narrow_from_mm + 8;
               how.screw_to_mm = 60;
             }),
      varied("varied, screw",
             [](auto& how, auto&, auto& random) {
               how.screw_diameter_mm = std::min(9.0, how.tunnel.diameter_mm - between(0, 1.5, random));
               how.screw_from_mm = between(0, 5, random);
               how.screw_to_mm = how.screw_from_mm + between(10, 25, random);
               how.screw_aside_mm =
                   between(0, 0.5, random) * (how.tunnel.diameter_mm - how.screw_diameter_mm);
             }),
      varied("varied, widened one",
             [](auto& how, auto&, auto& random) {
               how.widened_mm = between(1, 4, random);
               how.widened_to_mm = between(12, 25, random);
             }),
  };
  return all;
}

}  // namespace arthronaut::test
