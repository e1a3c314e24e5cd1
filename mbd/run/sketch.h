// Describes how elements are drawn: shapes at markers of bodies, and contributions of elements to the geometry of bodies.
//
// Sizes are those of the model: radii, thicknesses, corners. The viewer chooses sizes that the model does not contain (width of a spring,
// of a pin). Fields are read by name, so a drawing needs no header of its kind.
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

/// Position and orientation of a marker in the axes of its body about the centre of gravity, or in the ground's axes.
struct MarkerPlace {
  std::string body;          ///< name of the body; "ground" for the ground
  Vec2 point = Vec2::Zero(); ///< position, m
  double angle = 0.0;        ///< orientation relative to the body's axes, rad
  Vec2 at = Vec2::Zero();    ///< position in ground axes with all bodies in the reference pose, m
  double axes = 0.0;         ///< orientation relative to the ground's axes in the reference pose, rad

  /// Transforms a point from the marker's axes to the body's.
  [[nodiscard]] Vec2 in_body(const Vec2& p) const { return point + rotated(p, angle); }
  /// Rotates a direction from the marker's axes to the body's.
  [[nodiscard]] Vec2 turned(const Vec2& direction) const { return rotated(direction, angle); }
};

/// A shape to draw. Types and the data that they need:
///
///   spring      2 positions; direction if the spring acts along an axis. Styles: "" zigzag, damper (dashpot),
///               both, tie (bar with plates at its ends), cylinder
///   rope        2 or more positions, drawn as a polyline
///   rod, weld, pin, bushing, neutral   positions only
///   rail        direction of the free motion. Styles: "", limit (sizes: lower and upper stop), brake, skate (one position only)
///   contact     touching point, point on the line; direction: normal of the line towards the touching point;
///               sizes: coordinates of the ends of the line along the normal turned clockwise, if it has ends
///   faces       outlines that press on each other: positions of the touching corners (none: all corners of the outline),
///               then a position on the other body; direction: as for contact, if the other side is a half-plane
///   touch       centres of two circles; sizes: both radii, 1 if the first circle is inside the second
///   edge_touch  centre of a circle, marker of a segment; sizes: radius, from x, from y, to x, to y, thickness, then x and y of
///               further points if the segment is a road. Styles: "", flat (the line is also drawn)
///   arc         marker about which something turns. Styles: motor, drive, spring, limit (sizes as for rail), brake, couple
///   arrow       point of action; direction. Styles: "" (drive or motor), load (quantities force_x, force_y)
///   friction    nothing: drawn between the contacts named by the element
///   joint       nothing: a step-lap joint is shown by its sheets
struct Shape {
  std::string type, style;       ///< as listed above
  std::string quantity;          ///< channel of the element whose value the arrow shows; "" = none
  std::vector<MarkerPlace> at;   ///< positions; their number depends on the type
  std::optional<Vec2> direction; ///< unit vector in the axes of the body of the last position
  std::vector<double> sizes;     ///< lengths, m; points are in the axes of the body of the last position
};

/// Geometry that elements contribute to a body, m, in its axes about the centre of gravity. Duplicates are merged.
struct BodyGeometry {
  std::set<std::array<double, 4>> circles;               ///< x, y, radius, 1 if the circle is open inside
  std::set<std::array<double, 5>> segments;              ///< from x, y, to x, y, thickness
  std::set<std::vector<std::array<double, 2>>> polygons; ///< corners, m
  std::vector<Vec2> places;                              ///< points at which elements act, m
};

/// Drawing context of one element: access to its fields by name and to its markers, and the shapes drawn so far.
class Sketch {
public:
  /// Returns the position of a marker by its name.
  using PlaceOf = std::function<MarkerPlace(const std::string& marker)>;
  /// Returns the geometry of a body by its name, for modification.
  using GeometryOf = std::function<BodyGeometry&(const std::string& body)>;

  /// Creates a sketch without shapes. `entry` must outlive it.
  Sketch(const ElementEntry& entry, PlaceOf place_of, GeometryOf geometry_of);

  // Field access. Returns zero, empty or nullopt if the kind has no such field or the field is not given.
  /// Returns a number, SI.
  [[nodiscard]] double number(const char* field) const;
  /// Returns a number, SI; nullopt if not given.
  [[nodiscard]] std::optional<double> given_number(const char* field) const;
  /// Returns a boolean field.
  [[nodiscard]] bool is(const char* field) const;
  /// Returns a text or the name in a reference.
  [[nodiscard]] std::string text(const char* field) const;
  /// Returns true if the text or reference is given.
  [[nodiscard]] bool is_given(const char* field) const;
  /// Returns a point or direction, SI.
  [[nodiscard]] std::optional<Vec2> vector(const char* field) const;
  /// Returns a list of points, SI.
  [[nodiscard]] std::vector<Vec2> points(const char* field) const;
  /// Returns a list of texts or names.
  [[nodiscard]] std::vector<std::string> texts(const char* field) const;
  /// Returns the position of the marker that the field names; nullopt if it names none.
  [[nodiscard]] std::optional<MarkerPlace> place(const char* field) const;
  /// Returns the position of the marker with this name.
  [[nodiscard]] MarkerPlace place_of(const std::string& marker) const { return place_of_(marker); }
  /// Returns the positions of all marker fields, in order.
  [[nodiscard]] std::vector<MarkerPlace> places() const;
  /// Returns the unit direction of a field, rotated from the axes of marker b to those of its body.
  [[nodiscard]] std::optional<Vec2> direction(const char* field) const;

  /// Adds a shape. The reference is valid until the next shape is added.
  Shape& draw(Shape shape);
  /// Sets the sizes of the shape that was added last, if there is one.
  void size_last(std::vector<double> sizes);
  /// Replaces all shapes drawn so far.
  void replace(std::vector<Shape> shapes) { shapes_ = std::move(shapes); }
  /// Adds a circle to the geometry of the body of `centre`. In this and the following functions, corners and end points are in the marker's
  /// axes, m.
  void circle(const MarkerPlace& centre, double radius, bool is_ring = false);
  /// Adds a bar with round ends to the geometry of the body.
  void segment(const MarkerPlace& frame, const Vec2& from, const Vec2& to, double thickness);
  /// Adds a closed polygon to the geometry of the body.
  void polygon(const MarkerPlace& frame, const std::vector<Vec2>& corners);
  /// Records that the element acts at this point.
  void note_place(const MarkerPlace& place) { geometry_of_(place.body).places.push_back(place.point); }

  /// Returns the element that is drawn.
  [[nodiscard]] const ElementEntry& entry() const { return *entry_; }
  /// Returns the shapes in drawing order.
  [[nodiscard]] const std::vector<Shape>& shapes() const { return shapes_; }

private:
  template <class T> [[nodiscard]] std::optional<T> value(const char* field) const;

  const ElementEntry* entry_;
  PlaceOf place_of_;
  GeometryOf geometry_of_;
  std::vector<Shape> shapes_;
};

/// Draws the element with `draw`, the function of its kind, or as its field `draw` requests. Contributions to bodies are added in both
/// cases. Without a function it is drawn as diamonds at its markers with a dotted line between them.
void draw_element(Sketch& sketch, void (*draw)(Sketch& sketch));

} // namespace steplap
