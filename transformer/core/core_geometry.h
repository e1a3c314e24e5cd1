// Geometry of a [[core]]: overlaps at its corners and the steel of its limbs.
//
// Positions are in the axes of the active part, from the middle of a limb (corner.h). Precondition of all functions: the fields of the core
// are complete and valid (core_builder.h).
#pragma once

#include "elements/step_lap/patch/polygon.h"
#include "transformer/core/core.h"
#include "transformer/core/corner.h"
#include "transformer/core/stack.h"

#include <string>
#include <vector>

namespace steplap {

/// One kind of interface at a corner: the overlap of a yoke sheet of one layer and a limb sheet of a neighbouring layer.
struct Lap {
  std::string name; ///< name within its corner: "", "3", "packet 2, 3", "packets 2 and 3, 1"
  Polygon yoke, limb;
  /// Positions of the cuts perpendicular to the mitre, m: the limb sheet is beyond `inner`, the yoke sheet before `outer`.
  double inner = 0.0, outer = 0.0;
  double count = 0.0;         ///< number of such interfaces in the stack
  double area = 0.0;          ///< area of one interface, m²
  double pressure = 1.0;      ///< pressure relative to that of the corner
  std::size_t packet = 0;     ///< index of the limb sheet's packet, of several equal ones the first
  bool is_between = false;    ///< the layers belong to two packets
  std::size_t zone = 0;       ///< zone in a stack by place (stack.h)
  double before = 0.0;        ///< in a stack by place: mean number of sheets in front of the interface
  long first = 0, last = 0;   ///< numbers of sheets in front of the first and of the last interface
  Vec2 middle = Vec2::Zero(); ///< centroid of the overlap, m
  std::vector<Vec2> overlap;  ///< vertices of the overlap, m
};

/// One mitre: an outer limb has one at each end, a middle limb two.
struct CoreCorner {
  bool is_top = true;
  std::string place;       ///< name of the position: "top", "bottom front"
  CornerFrame frame;       ///< frame of the widest packet
  Vec2 out = Vec2::Ones(); ///< signs: of x for outwards (at a T-joint away from the limb's axis), and of y for away from the window
  std::vector<Lap> laps;
};

/// Pressure on one kind of interface, in the axes of the active part.
struct LapPressure {
  double middle = 0.0;            ///< pressure at the centroid of the overlap, Pa
  Vec2 gradient = Vec2::Zero();   ///< pressure gradient, Pa/m
  double least = 0.0;             ///< smallest pressure in the overlap, Pa
  double transverse = 0.0;        ///< change per acceleration across the stack, from the front face to the back, Pa per m/s²
  double transverse_spread = 0.0; ///< largest deviation (±) of `transverse` among these interfaces from their mean, Pa per m/s²
};

/// Position of a limb in the core.
struct LimbPlace {
  bool is_middle = false;
  double side = 1.0; ///< for an outer limb: side of the active part, +1 or −1
  double x = 0.0;    ///< position of the limb's axis, m
};

/// Steel of one limb.
struct LimbSteel {
  double mass = 0.0;          ///< mass, kg; zero if the stack is unknown (counted overlaps)
  double inertia = 0.0;       ///< moment of inertia about the centre of gravity, kg m²
  Vec2 centre = Vec2::Zero(); ///< centre of gravity, m
};

/// Computes the overlaps and the steel of one core.
class CoreGeometry {
public:
  explicit CoreGeometry(const Core& core);

  /// Stack of sheets; for a core with counted overlaps one packet without sheets.
  [[nodiscard]] const Stack& stack() const { return stack_; }
  /// Returns the index of the widest packet with the highest yoke.
  [[nodiscard]] std::size_t largest() const { return largest_; }
  /// Returns the dimensions of the mitre of a packet.
  [[nodiscard]] Mitre mitre(std::size_t packet, bool is_middle) const;
  /// Returns the angle of the mitre relative to the yoke, rad.
  [[nodiscard]] double angle(std::size_t packet, bool is_middle) const;
  /// Returns the shift of the line from layer to layer, perpendicular to the mitre, m.
  [[nodiscard]] double pitch(std::size_t packet, bool is_middle) const;
  /// Returns true if two layers of the packet overlap. Otherwise only neighbouring packets hold its sheets.
  [[nodiscard]] bool overlaps_within(std::size_t packet, bool is_middle) const;
  /// Returns the position, perpendicular to the mitre, of the middle of the line at which sheets of this shape meet, m.
  [[nodiscard]] double line(const LayerShape& shape, bool is_middle) const;

  /// Returns all corners of a limb on side `side` of the active part, at the distance `reach` from it, m. Throws PolygonError if a bolt
  /// hole divides a sheet.
  [[nodiscard]] std::vector<CoreCorner> corners(bool is_middle, double side, double reach) const;
  /// Returns mass, inertia and centre of gravity of the sheets of one limb.
  [[nodiscard]] LimbSteel limb_steel(bool is_middle, double side) const;
  /// Returns the fraction of a limb's steel in each packet. If the stack is not by place, the first of several equal packets gets the
  /// fraction of all of them, and the others zero. Empty if the stack is unknown.
  [[nodiscard]] std::vector<double> packet_shares(bool is_middle, double side) const;
  /// Returns the index of the packet that an interface holds: that of its limb sheet.
  [[nodiscard]] std::size_t packet_of(const Lap& lap) const;
  /// Returns the mass of both yokes from x = 0 to the outer face of an outer limb, as if there were no limb, kg; negative if that face is
  /// on the other side of x = 0. Zero if the stack is unknown (counted overlaps).
  [[nodiscard]] double yoke_strip(const LimbPlace& outer) const;
  /// Returns the mass of the parts of both yokes that a limb, its sheets and the clearance replace, kg. Bolt holes are not deducted.
  [[nodiscard]] double yoke_cut(const LimbPlace& limb) const;
  /// Returns the pressure on an interface; `share`: factor of the joint (Core::joint_share).
  [[nodiscard]] LapPressure pressure(const CoreCorner& corner, const Lap& lap, double share) const;

private:
  struct End; // end of a limb with its corner
  [[nodiscard]] CoreCorner corner(const End& end) const;
  [[nodiscard]] CornerFrame frame(std::size_t packet, const End& end) const;
  [[nodiscard]] Polygon limb_sheet(std::size_t packet, const End& end, double q) const;
  [[nodiscard]] Polygon yoke_sheet(std::size_t packet, const End& end, double q) const;
  [[nodiscard]] Lap lap(std::size_t limb_packet, double inner, std::size_t yoke_packet, double outer, const End& end) const;
  void add_built(const End& end, std::vector<Lap>& laps) const;
  void add_counted(const End& end, std::vector<Lap>& laps) const;
  void merge(const End& end, std::size_t packet, std::size_t zone, std::vector<Lap>& laps) const;
  [[nodiscard]] std::string zone_name(std::size_t packet, std::size_t zone) const;
  [[nodiscard]] Polygon punched(const std::vector<Vec2>& ring, double side, std::initializer_list<double> levels) const;

  const Core& core_;
  Stack stack_;
  std::size_t largest_ = 0;
};

/// Returns the stack described by the fields; for counted overlaps one packet without sheets.
[[nodiscard]] Stack stack_of(const Core& core);

} // namespace steplap
