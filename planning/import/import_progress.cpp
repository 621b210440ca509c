#include "planning/import/import_progress.h"

#include <algorithm>

namespace arthronaut::importing {

namespace {

struct Share {
  const char* words;
  double from, to;
};

// Reading, and handing over to the other process, takes a third; of a CT the bones take longest.
Share share_of(ImportStage stage) {
  switch (stage) {
    case ImportStage::Starting:
      return {"Starting", 0, 0};
    case ImportStage::LookingThrough:
      return {"Looking through the folder", 0, 1};
    case ImportStage::Reading:
      return {"Reading", 0, 0.3};
    case ImportStage::ReadingImages:
      return {"Reading the images", 0.3, 0.5};
    case ImportStage::FindingBones:
      return {"Finding the bones", 0.3, 0.8};
    case ImportStage::MakingSurface:
      return {"Making the surface", 0.5, 0.8};
    case ImportStage::MendingMesh:
      return {"Mending the mesh", 0.8, 0.9};
    case ImportStage::LookingAtBones:
      return {"Looking at the bones", 0.9, 0.98};
  }
  return {"Working", 0, 0};
}

}  // namespace

std::string_view in_words(ImportStage stage) { return share_of(stage).words; }

double share_of_all(const ImportProgress& progress) {
  const Share share = share_of(progress.stage);
  return share.from + (share.to - share.from) * std::clamp(progress.fraction, 0.0, 1.0);
}

}  // namespace arthronaut::importing
