// The innermost loops of the edge profiles, eight samples or shifts at a time: one profile against the image
// of the four cells that it crosses. Plain numbers and nothing else, compiled for every processor and for
// those with AVX2, as exposed_kernel.h: both give the same bits.
#pragma once

namespace arthronaut::markers {

// The light along a line across an edge, from reach + search before the place where the edge is predicted to
// as far behind it, a pixel apart.
struct EdgeProfile {
  static constexpr int kMostReach = 26;   // search included
  static constexpr int kMostWindow = 16;  // reach alone
  alignas(32) float light[64] = {};       // below 0: saturated; finite beyond the last one, too
  int reach = 0;                          // of the window in which the edge is matched
  int search = 0;                         // how far the window is shifted to either side
  float cells[4] = {};                    // what the profile crosses: dark 0, bright 1
  float cell_px = 0;                      // from edge to edge
  float box_px = 1, sigma_px = 1;         // the smear: pixel or motion, and the optics
};

struct EdgeMatch {
  enum class Outcome {
    AtTheEnd,  // of what was searched
    Flat,
    Different,
    Matched,  // all below is meaningful
  } outcome = Outcome::Different;
  float gain = 0;      // bright less dark level
  float offset = 0;    // of the edge from where it was predicted
  float sigma = 0;     // of the offset, by the noise
  float likeness = 0;  // correlation of profile and model
  // How the residuals want the smear changed: step = gain / weight.
  float sigma_gain = 0, sigma_weight = 0, box_gain = 0, box_weight = 0;
};

// Fills in a match that was just made.
void match_edge(const EdgeProfile& profile, EdgeMatch& match);
void match_edge_avx2(const EdgeProfile& profile, EdgeMatch& match);

}  // namespace arthronaut::markers
