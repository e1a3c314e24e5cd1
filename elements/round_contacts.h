// Contacts of circles with each other and with line segments, for rollers, balls, rounded feet.
//
//   circle_contact   a circle about marker a against a circle about marker b, outside or inside it
//   segment_contact  a circle about marker a (or a point) against a segment fixed in b, both sides and ends; a thickness makes the ends
//                    round
//
// The gap is the distance of the circle's centre from the other centre or from the segment, minus the radii; contact if it is negative.
// Laws as in unilateral_contact.h. The normal force passes through the circle's centre; friction (coulomb_stick) acts at the point of
// contact, so that a circle rolls. Valid for penetrations that are small compared with the radii; at a penetration equal to their sum the
// direction is undefined.
#pragma once

#include "elements/round_measures.h"
#include "mbd/model/model.h"
#include "mbd/system/row.h"

namespace steplap {

class SystemBuilder;

/// Fields common to both kinds.
struct RoundContact : Element {
  std::string a, b = "ground";
  std::string law = "kelvin_voigt";
  double stiffness = 0.0, damping = 0.0;
  std::optional<double> restitution; ///< coefficient of restitution, replaces damping (restitution.h)
  double exponent = 1.0;             ///< exponent n of the Hunt–Crossley law
  double dissipation = 0.0;          ///< Hunt–Crossley α, s/m
};

struct CircleContact : RoundContact {
  double radius_a = 0.0, radius_b = 0.0;
  bool inside = false; ///< circle a is inside the ring b
};

struct SegmentContact : RoundContact {
  double radius = 0.0;
  Vec2 from = Vec2::Zero(), to = Vec2::Zero(); ///< ends of the segment in marker b's axes, m
  double thickness = 0.0;
};

/// Returns the rows along which friction of such a contact sticks, one for each possible contact point (for a segment in the order of
/// SegmentPart). Empty if `element` is of neither kind.
[[nodiscard]] std::vector<RowSpec> rolling_rows(const Element& element, const SystemBuilder& builder);

/// Returns the measure between the circle's centre and the segment.
[[nodiscard]] SegmentMeasure segment_measure(const SegmentContact& contact, const SystemBuilder& builder);

[[nodiscard]] const ElementKind& circle_contact_kind();
[[nodiscard]] const ElementKind& segment_contact_kind();

} // namespace steplap
