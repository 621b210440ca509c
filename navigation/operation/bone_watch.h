// The registered bone against the picture (contour/contour_check.h), and what of it an operation heeds: a
// bone that has moved under its marker is an alarm, one that does not look as it did is a doubt.
//
// It is of one place of the bone under its marker, seen through one source: with another of either everything
// that was seen is forgotten, and a doubt is over. Another plan moves no bone. What a picture tells is in
// force with the next one; between the two it waits here, as everything that a run from the record alone has
// to hear of.
//
// Thread-free, deterministic. In the frames it allocates nothing once on_source() was told how large they
// are.
#pragma once

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "navigation/contour/contour_check.h"
#include "navigation/contour/covered.h"
#include "navigation/operation/place_doubt.h"
#include "navigation/operation/registration_ledger.h"
#include "navigation/operation/seen_drift.h"
#include "navigation/pipeline/navigation_pipeline.h"

namespace arthronaut::operation {

class BoneWatch {
 public:
  // Null: there is no surface to look for, and nothing is ever told by itself.
  explicit BoneWatch(const geometry::Surface* surface);

  // Pictures of that size come, or none any more.
  void on_source(const Eigen::Vector2i& image_size_px);
  void on_source_end();
  // After whatever may have changed it. One that has the bone elsewhere, or does not stand, ends a doubt; and
  // the next one that stands is watched anew.
  void on_registration(const RegistrationInForce& in_force);
  void on_touches(const Touches& touches) { doubt_.on_touches(touches); }
  // The probe, or the surgeon, has said that the bone lies where it lay: what it looks like now is how it
  // looks.
  void look_anew();

  // The newest picture, with what was seen in it. Precondition: on_registration() was told of in_force. While
  // an alarm holds, what told it stays as it was. hears_only: that it moved is told from elsewhere.
  void look(const camera::Frame& picture, const pipeline::FrameResult& frame, const tools::ToolSet& tools,
            const RegistrationInForce& in_force, bool hears_only);
  // What another run saw. Where a picture has just told a drift, that one stands.
  void tell(const SeenDrift& drift);
  void tell(const SeenLooks& looks) { looks_ = looks; }

  // What waits to take effect; once.
  [[nodiscard]] std::optional<SeenDrift> take_drift() { return std::exchange(drift_, std::nullopt); }
  // One that changes nothing is none.
  [[nodiscard]] std::optional<SeenLooks> take_looks();
  // has_control_point: one was set while the bone was seen to lie where it lay.
  void begin_doubt(bool has_control_point, std::size_t touch_count) {
    doubt_.begin(has_control_point, touch_count);
  }
  void end_doubt() { doubt_.end(); }

  [[nodiscard]] const PlaceDoubt& doubt() const { return doubt_; }
  [[nodiscard]] contour::ContourVerdict verdict() const;

 private:
  std::optional<contour::ContourCheck> check_;                // empty: there is no surface to look for
  std::optional<geometry::RigidTransform> marker_from_bone_;  // of the registration that stands
  bool begins_anew_ = false;
  contour::CoveredPlaces covered_;
  std::vector<std::uint8_t> luma_;  // of pictures that have none of their own
  std::optional<SeenDrift> drift_;  // told, and not in force yet
  std::optional<SeenLooks> looks_;
  PlaceDoubt doubt_;
};

}  // namespace arthronaut::operation
