// What a [[core]] comes to: the overlaps at its corners and the steel of its limbs, as the stack is built.
//
// Places are in the active part's axes, from the middle of a limb (corner.h). Everything here is for a core
// whose fields are complete and sound (core_builder.h sees to that).
#pragma once

#include "elements/step_lap/patch/polygon.h"
#include "transformer/core/core.h"
#include "transformer/core/corner.h"
#include "transformer/core/stack.h"

#include <string>
#include <vector>

namespace steplap {

/// One kind of interface at a corner: where a yoke sheet of one layer and a limb sheet of a neighbouring layer overlap.
struct Lap {
  std::string name; ///< within its corner: "", "3", "packet 2, 3", "packets 2 and 3, 1"
  Polygon yoke, limb;
  double inner = 0.0, outer = 0.0; ///< m, across the mitre: limb sheet beyond the one, yoke sheet before the other
  double count = 0.0;              ///< of such interfaces in the stack
  double area = 0.0;               ///< m², of one
  double pressure = 1.0;           ///< share of the corner's
  std::size_t packet = 0;          ///< the one that both layers are like
  bool is_between = false;         ///< layers of two packets instead
  std::size_t zone = 0;            ///< of a stack by place (stack.h)
  double before = 0.0;             ///< sheets in front of it, in the mean; of a stack by place
  long first = 0, last = 0;        ///< sheets in front of the foremost and the rearmost of these interfaces
  Vec2 middle = Vec2::Zero();      ///< of the overlap
  std::vector<Vec2> overlap;       ///< its vertices
};

/// One mitre: an outer limb has one at either end, a middle limb two.
struct CoreCorner {
  bool is_top = true;
  std::string place;       ///< "top", "bottom front"
  CornerFrame frame;       ///< of the widest packet
  Vec2 out = Vec2::Ones(); ///< signs of x outwards (at a T-joint off the limb's axis) and of y away from the window
  std::vector<Lap> laps;
};

/// By which the sheets of one kind of interface are pressed on each other; active part's axes.
struct LapPressure {
  double middle = 0.0;            ///< Pa, at the middle of the overlap
  Vec2 gradient = Vec2::Zero();   ///< Pa/m
  double least = 0.0;             ///< Pa, anywhere in the overlap
  double transverse = 0.0;        ///< Pa per m/s² of acceleration across the stack, from the front face to the back
  double transverse_spread = 0.0; ///< the same, by which the outermost of these interfaces differs from their mean
};

struct LimbPlace {
  bool is_middle = false;
  double side = 1.0; ///< of an outer limb
  double x = 0.0;    ///< of its axis, m
};

/// Of a limb's sheets.
struct LimbSteel {
  double mass = 0.0;          ///< kg; zero where the stack is not known (overlaps counted)
  double inertia = 0.0;       ///< kg m², about the centre of gravity
  Vec2 centre = Vec2::Zero(); ///< of gravity, m
};

class CoreGeometry {
public:
  explicit CoreGeometry(const Core& core);

  [[nodiscard]] const Stack& stack() const { return stack_; } ///< of a counted core: one packet, no sheets
  /// The widest packet of the highest yoke: its place among the packets.
  [[nodiscard]] std::size_t largest() const { return largest_; }
  [[nodiscard]] Mitre mitre(std::size_t packet, bool is_middle) const;
  /// Angle against the yoke, rad.
  [[nodiscard]] double angle(std::size_t packet, bool is_middle) const;
  /// From layer to layer, across the mitre, m.
  [[nodiscard]] double pitch(std::size_t packet, bool is_middle) const;
  /// Do two layers of the packet overlap anywhere in it? Without that nothing holds its sheets but its neighbours'.
  [[nodiscard]] bool overlaps_within(std::size_t packet, bool is_middle) const;
  /// Middle of the line at which sheets of that shape meet, across the mitre, m.
  [[nodiscard]] double line(const LayerShape& shape, bool is_middle) const;

  /// All corners of a limb that stands on that side of the active part, `reach` from it. Throws PolygonError where a
  /// bolt hole cuts a sheet in two.
  [[nodiscard]] std::vector<CoreCorner> corners(bool is_middle, double side, double reach) const;
  [[nodiscard]] LimbSteel limb_steel(bool is_middle, double side) const;
  /// Of a limb's steel, the share that each packet has; of a stack that is not by place, packets alike count as their first one,
  /// and the others have none. Empty where the stack is not known.
  [[nodiscard]] std::vector<double> packet_shares(bool is_middle, double side) const;
  /// The packet whose share a lap holds.
  [[nodiscard]] std::size_t packet_of(const Lap& lap) const {
    return stack_.is_by_place ? lap.zone / static_cast<std::size_t>(stack_.slices) : lap.packet;
  }
  /// Of both yokes from x = 0 to the outer face of an outer limb, as if no limb stood there, kg; negative where that face
  /// lies behind x = 0 as seen from its side. Zero where the stack is not known (overlaps counted).
  [[nodiscard]] double yoke_strip(const LimbPlace& outer) const;
  /// What a limb takes of both yokes: where its sheets and the clearance are, kg. Bolt holes are not taken off.
  [[nodiscard]] double yoke_cut(const LimbPlace& limb) const;
  /// `share`: of the joint.
  [[nodiscard]] LapPressure pressure(const CoreCorner& corner, const Lap& lap, double share) const;

private:
  struct End; // of a limb: which of its corners
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

/// The stack that the fields describe; of a counted core one packet without sheets.
[[nodiscard]] Stack stack_of(const Core& core);

} // namespace steplap
