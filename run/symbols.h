// How elements are drawn: shapes between places of bodies, and what they tell of the bodies' own geometry.
//
// Sizes are those of the model: radii, thicknesses, corners. What has none (a spring's width, a pin's) is left to
// whoever draws. A kind that is to be drawn adds one function and one line to the table in symbols.cpp; it reads its
// fields by name, so that no element's header is needed here. A kind that is not in the table is drawn by diamonds where
// its markers sit and a dotted line between them, which claims nothing.
#pragma once

#include "mbd/model/model.h"

#include <array>
#include <functional>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace steplap {

/// Where a marker sits: in its body's axes about the centre of gravity; the ground's own.
struct MarkerPlace {
  std::string body;          ///< its name, "ground" for the ground
  Vec2 point = Vec2::Zero(); ///< m
  double angle = 0.0;        ///< of the marker's axes against the body's
  Vec2 at = Vec2::Zero();    ///< m: the same place in the ground's axes, bodies in the reference pose
  double axes = 0.0;         ///< rad: of the marker's axes against the ground's, likewise

  /// A point and a direction given in the marker's axes, in the body's.
  [[nodiscard]] Vec2 in_body(const Vec2& p) const { return point + rotated(p, angle); }
  /// A direction given in the marker's axes, in the body's.
  [[nodiscard]] Vec2 turned(const Vec2& direction) const { return rotated(direction, angle); }
};

/// One thing to draw. Types, and what they take:
///   spring      2 places; direction: along an axis, else from place to place. Styles: "" zigzag, damper (dashpot),
///               both, tie (bar with plates at its ends), cylinder
///   rope        2 or more places, a polyline
///   rod, weld, pin, bushing, neutral   their places
///   rail        direction that is free. Styles: "", limit (stops at the sizes: lower, upper), brake, skate (one place only)
///   contact     place that touches, place on the line; direction: the normal of the line, towards what touches;
///               sizes: where the line ends, along the normal turned clockwise, if it does
///   faces       outlines that press on each other: places of corners that touch (none: those of the body's outline), the
///               other's place last; direction: as of a contact, if the other is a half-plane
///   touch       centres of two circles; sizes: their radii, 1 if the first is inside the second
///   edge_touch  centre of a circle, frame of a segment; sizes: radius, from x, from y, to x, to y, thickness, then x and y of
///               further points that make the segment a road. Styles: "", flat (its line is drawn, too)
///   arc         the marker turned about. Styles: motor, drive, spring, limit (sizes as of a rail), brake, couple
///   arrow       where it acts; direction. Styles: "" (drive or motor), load (quantities force_x, force_y)
///   friction    none: between the contacts that the element names
///   joint       none: a step-lap joint, seen by its sheets
struct Shape {
  std::string type, style;       ///< as listed above
  std::string quantity;          ///< the element's channel that arrows and values show; "" = none
  std::vector<MarkerPlace> at;   ///< as many as the type takes
  std::optional<Vec2> direction; ///< unit, in the axes of the last place's body
  std::vector<double> sizes;     ///< m, in the axes of the last place's body where they are points
};

/// What elements say of a body: m, in its axes about the centre of gravity. Said twice it counts once.
struct BodyGeometry {
  std::set<std::array<double, 4>> circles;               ///< x, y, radius, 1 if it is a ring that is open inside
  std::set<std::array<double, 5>> segments;              ///< from x, y, to x, y, thickness
  std::set<std::vector<std::array<double, 2>>> polygons; ///< corners, m
  std::vector<Vec2> places;                              ///< where elements act
};

/// What a symbol is drawn with: the element's fields by name, its places, what it draws.
class Sketch {
public:
  /// Finds a marker by its name.
  using PlaceOf = std::function<MarkerPlace(const std::string& marker)>;
  /// Finds what is known of a body by its name, to be added to.
  using GeometryOf = std::function<BodyGeometry&(const std::string& body)>;

  /// A sketch without shapes. `entry` has to outlive it.
  Sketch(const ElementEntry& entry, PlaceOf place_of, GeometryOf geometry_of);

  // Fields: zero, empty or nullopt where the kind has no such field or it is not given.
  /// A number, in SI.
  [[nodiscard]] double number(const char* field) const;
  /// A number, in SI; nullopt if it is not given.
  [[nodiscard]] std::optional<double> given_number(const char* field) const;
  /// A field of yes or no.
  [[nodiscard]] bool is(const char* field) const;
  /// A text, or the name that a reference holds.
  [[nodiscard]] std::string text(const char* field) const;
  /// Of a text or a reference: was it given?
  [[nodiscard]] bool is_given(const char* field) const;
  /// A point or a direction, in SI.
  [[nodiscard]] std::optional<Vec2> vector(const char* field) const;
  /// A list of points, in SI.
  [[nodiscard]] std::vector<Vec2> points(const char* field) const;
  /// A list of texts or names.
  [[nodiscard]] std::vector<std::string> texts(const char* field) const;
  /// Of the marker that the field names; nullopt if it names none.
  [[nodiscard]] std::optional<MarkerPlace> place(const char* field) const;
  /// Of a marker by its name.
  [[nodiscard]] MarkerPlace place_of(const std::string& marker) const { return place_of_(marker); }
  /// Of all its marker fields, in order.
  [[nodiscard]] std::vector<MarkerPlace> places() const;
  /// A field's direction, unit, turned from the axes of marker b into its body's.
  [[nodiscard]] std::optional<Vec2> direction(const char* field) const;

  /// Adds a shape; what is returned is good until the next one is added.
  Shape& draw(Shape shape);
  /// Gives the shape that was added last its sizes; nothing happens if there is none.
  void size_last(std::vector<double> sizes);
  /// Takes these shapes instead of all drawn so far.
  void replace(std::vector<Shape> shapes) { shapes_ = std::move(shapes); }
  /// Geometry of the body that carries the place; corners and ends in the marker's axes.
  void circle(const MarkerPlace& centre, double radius, bool is_ring = false);
  /// A bar with round ends; all in m.
  void segment(const MarkerPlace& frame, const Vec2& from, const Vec2& to, double thickness);
  /// A closed outline; corners in m.
  void polygon(const MarkerPlace& frame, const std::vector<Vec2>& corners);
  /// The element acts there.
  void note_place(const MarkerPlace& place) { geometry_of_(place.body).places.push_back(place.point); }

  /// The element that is drawn.
  [[nodiscard]] const ElementEntry& entry() const { return *entry_; }
  /// In the order in which they were drawn.
  [[nodiscard]] const std::vector<Shape>& shapes() const { return shapes_; }

private:
  template <class T> [[nodiscard]] std::optional<T> value(const char* field) const;

  const ElementEntry* entry_;
  PlaceOf place_of_;
  GeometryOf geometry_of_;
  std::vector<Shape> shapes_;
};

/// Draws the element as its kind is drawn, or as its field `draw` asks. What it says of bodies is said in either case.
void draw_element(Sketch& sketch);

} // namespace steplap
