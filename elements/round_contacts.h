// Contacts of round things with each other and with line segments: rollers, balls, rounded feet.
//
//   circle_contact   a circle about marker a against a circle about marker b, outside or inside it
//   segment_contact  a circle about marker a (or a point) against a segment fixed in b, with both its sides
//                    and its ends; the segment has a thickness, so that its ends are round
// Gap: the distance of the centre from the other centre, or from the segment, less the radii; closed while it
// is negative. Laws as in unilateral_contact.h. The force passes through the circle's centre; friction
// (coulomb_stick) acts where the two touch, so that a circle rolls. Valid while the penetration is small
// against the radii: at a penetration by all of them the direction is lost.
#pragma once

#include "elements/round_measures.h"
#include "mbd/model/model.h"
#include "mbd/system/row.h"

namespace steplap {

class SystemBuilder;

/// What both kinds have.
struct RoundContact : Element {
  std::string a, b = "ground";
  std::string law = "kelvin_voigt";
  double stiffness = 0.0, damping = 0.0;
  std::optional<double> restitution; ///< instead of damping (restitution.h)
  double exponent = 1.0;             ///< Hunt–Crossley n
  double dissipation = 0.0;          ///< Hunt–Crossley α
};

struct CircleContact : RoundContact {
  double radius_a = 0.0, radius_b = 0.0;
  bool inside = false; ///< a inside b's ring
};

struct SegmentContact : RoundContact {
  double radius = 0.0;
  Vec2 from = Vec2::Zero(), to = Vec2::Zero(); ///< in marker b's axes
  double thickness = 0.0;
};

/// Rows along which friction under such a contact sticks, one for each place where the two can touch, in the
/// order of SegmentPart for a segment; `element` is one of the two kinds. Empty otherwise.
[[nodiscard]] std::vector<RowSpec> rolling_rows(const Element& element, const SystemBuilder& builder);

/// The segment and the circle's centre, in their bodies' frames.
[[nodiscard]] SegmentMeasure segment_measure(const SegmentContact& contact, const SystemBuilder& builder);

[[nodiscard]] const ElementKind& circle_contact_kind();
[[nodiscard]] const ElementKind& segment_contact_kind();

} // namespace steplap
