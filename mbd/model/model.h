// The model as described by the user, before compilation.
//
// Entries (bodies, markers, signals, elements) refer to each other by name. Each entry keeps its location in the file, so that later error
// messages can refer to it.
#pragma once

#include "mbd/base/diagnostics.h"
#include "mbd/base/types.h"
#include "mbd/model/fields.h"
#include "mbd/model/parameters.h"
#include "mbd/model/signal.h"

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace steplap {

class SystemBuilder;
struct ContactDescription;
struct ElementJudgement;
struct Model;
struct RunResult;

/// A rigid body. `position` and `angle` are the pose of its frame in the reference pose, which is the pose given in the file; `cg` is the
/// centre of gravity in this frame.
struct Body {
  std::string name;              ///< unique among bodies; not "ground"
  double mass = 0.0;             ///< kg, > 0
  double inertia = 0.0;          ///< kg m², about the centre of gravity, > 0
  Vec2 position = Vec2::Zero();  ///< origin of the body frame, m, ground axes
  double angle = 0.0;            ///< rad
  Vec2 cg = Vec2::Zero();        ///< centre of gravity, m, body frame
  Vec2 velocity = Vec2::Zero();  ///< velocity of the centre of gravity, m/s, ground axes
  double angular_velocity = 0.0; ///< rad/s
  bool fixed = false;            ///< the body does not move; mass and inertia are not required
  std::string label;             ///< name in reports and drawings; "": `name`
  std::vector<Vec2> outline;     ///< body frame, m; for drawings only
  Location where;                ///< location in the model file; empty for a body made in code
  std::uint32_t given = 0;       ///< bit k is set if field k of fields() was given in the file, whatever its value

  /// Returns (x, y, θ) of the centre of gravity in the reference pose.
  [[nodiscard]] Vec3 reference_pose() const;
  /// Returns the fields as in a model file.
  [[nodiscard]] static const FieldTable& fields();
};

/// A point fixed to a body or to the ground, with axes turned by `angle` relative to those of the body. Its position is given either by
/// `point` (body frame) or by `at` (ground frame, reference pose).
struct Marker {
  std::string name;            ///< unique among markers
  std::string body = "ground"; ///< name of a body, or "ground"
  std::optional<Vec2> point;   ///< m, body frame
  std::optional<Vec2> at;      ///< m, ground frame, in the reference pose
  double angle = 0.0;          ///< rad
  Location where;              ///< location in the model file

  /// Returns the fields as in a model file.
  [[nodiscard]] static const FieldTable& fields();
};

/// Common members of all elements. Kinds derive from it and add their own fields.
struct Element {
  virtual ~Element() = default;
  std::string name;          ///< unique among elements
  std::string draw = "auto"; ///< symbol in drawings; "auto": the usual one of its kind
  bool active = true;        ///< acts from the start; otherwise after an action activates it
  Location where;            ///< location in the model file

  /// Returns the fields that all kinds have, except name and kind.
  [[nodiscard]] static const FieldTable& common_fields();
};

/// The largest coefficient of dry friction that an element gives, and its origin.
struct GivenFriction {
  const char* field = "";   ///< field of the coefficient
  double coefficient = 0.0; ///< static friction [1]
  std::string source;       ///< as the model states it; empty: not stated
};

/// One kind of element: its fields and its compilation into a system.
struct ElementKind {
  std::string name;  ///< name in model files, such as "spring_damper"
  std::string doc;   ///< a few sentences: what it models, sign convention
  FieldTable fields; ///< fields of its struct, in addition to common_fields()
  /// TOML text with an element of the kind and everything it needs except two bodies 'a' and 'b'. It is used to find the channels of the
  /// kind by making an element (kind_channels.h). "": an element with only the required fields is sufficient.
  std::string example = {};
  int stage = 0;                                                      ///< 0, or 1 for kinds that refer to other elements and are compiled
                                                                      ///< after these
  std::shared_ptr<Element> (*create)() = nullptr;                     ///< returns a new element with default values; set by holds()
  std::shared_ptr<Element> (*copy)(const Element& element) = nullptr; ///< returns a copy; set by holds()
  /// Adds the element to the system. Errors are reported to the builder.
  void (*compile)(const Element& element, SystemBuilder& builder) = nullptr;
  /// Judges an element by its built-in limits after a run (mbd/trust/element_judgement.h); null if the kind has none.
  ElementJudgement (*judge)(const Element& element, const Model& model, const RunResult& result) = nullptr;
  /// Returns true if the element exerts a constant prescribed force in addition to its signals. Null for kinds whose forces depend on the
  /// motion alone.
  bool (*has_constant_load)(const Element& element) = nullptr;
  /// Returns true for loads and prescribed motions: they act whatever the bodies do, so they hold no body. Null: false.
  bool (*acts_from_outside)(const Element& element, const Model& model) = nullptr;
  /// Returns the largest friction coefficient of the element and its source. Null for kinds without dry friction, and for tyres and sheets,
  /// whose coefficients have fixed ranges.
  GivenFriction (*friction)(const Element& element) = nullptr;
  /// Returns the description of the element's contact, for plots and checks (mbd/system/contact_description.h). Null for kinds without a
  /// contact.
  ContactDescription (*contact)(const Element& element, const Model& model) = nullptr;
  /// True for ropes: reports say "goes slack" instead of "opens", and "becomes taut" instead of "closes".
  bool goes_slack = false;
  /// Returns the channels whose extremes `judge` uses; their errors decide whether its result can be trusted.
  std::vector<std::string> (*channels_of_trust)(const Element& element) = nullptr;

  /// Declares T as the struct of the elements of this kind.
  template <class T> void holds() {
    create = create_object<Element, T>;
    copy = copy_object<Element, T>;
  }
};

/// Returns a copy of an object of this kind. Throws std::logic_error if the kind has not declared its struct by holds().
template <class Kind, class Object> std::shared_ptr<Object> copied(const Kind& kind, const Object& object) {
  if (!kind.copy) throw std::logic_error("the kind '" + kind.name + "' does not say what it holds: call holds<T>()");
  return kind.copy(object);
}

/// An element with its kind. Copying it copies the element.
struct ElementEntry {
  const ElementKind* kind = nullptr; ///< not null; must outlive the model
  std::shared_ptr<Element> element;  ///< instance of the kind's struct

  /// Takes ownership of the element.
  ElementEntry(const ElementKind* kind_, std::shared_ptr<Element> element_) : kind(kind_), element(std::move(element_)) {}
  ElementEntry(const ElementEntry& other) : kind(other.kind), element(copied(*other.kind, *other.element)) {}
  ElementEntry(ElementEntry&&) = default;
  ElementEntry& operator=(const ElementEntry& other) { return *this = ElementEntry(other); }
  ElementEntry& operator=(ElementEntry&&) = default;
  ~ElementEntry() = default;
};

/// A signal, a scalar function of time, with its kind. Copying it copies the definition.
struct SignalEntry {
  const SignalKind* kind = nullptr;             ///< not null; must outlive the model
  std::shared_ptr<SignalDefinition> definition; ///< instance of the kind's struct

  /// Takes ownership of the definition.
  SignalEntry(const SignalKind* kind_, std::shared_ptr<SignalDefinition> definition_) : kind(kind_), definition(std::move(definition_)) {}
  SignalEntry(const SignalEntry& other) : kind(other.kind), definition(copied(*other.kind, *other.definition)) {}
  SignalEntry(SignalEntry&&) = default;
  SignalEntry& operator=(const SignalEntry& other) { return *this = SignalEntry(other); }
  SignalEntry& operator=(SignalEntry&&) = default;
  ~SignalEntry() = default;
};

/// Largest number of steps of a run. A run that needs more would take days; it is refused or aborted.
inline constexpr double k_most_steps = 1e10;

/// Table [simulation]: duration, method, initial state.
struct SimulationSettings {
  double end = 1.0;                      ///< s
  std::string integrator = "auto";       ///< name of a method (method.h)
  std::optional<double> step;            ///< step length, s, for methods with fixed steps
  std::optional<double> tolerance;       ///< relative tolerance, for adaptive methods
  std::string coordinates = "automatic"; ///< coordinates of small islands with pin joints: "automatic", "joint" or "absolute"
  std::string initial = "as_given";      ///< "as_given" or "equilibrium"
  Vec2 velocity = Vec2::Zero();          ///< m/s, added to every body's initial velocity
  double projection_tolerance = 1e-12;   ///< largest constraint residual left after a step, m or rad
  long max_events = 100000;              ///< number of events after which a run is aborted; kinks of force laws are not counted
  Location where;                        ///< location of the table in the model file

  /// Returns the fields as in a model file.
  [[nodiscard]] static const FieldTable& fields();
};

/// Table [output]: which results are written, and at which times.
struct OutputSettings {
  double step = 1e-3;                ///< sampling interval, s
  std::vector<std::string> channels; ///< patterns with * and ?; empty = all
  std::vector<std::string> also;     ///< patterns of channels that are computed only on request
  double most_numbers = 1e8;         ///< largest number of rows × channels (about 2 GB of text); a larger run is refused
  std::string seen_from;             ///< body whose frame drawings use; "" = chosen by the drawing
  Location where;                    ///< location of the table in the model file

  /// Returns the fields as in a model file.
  [[nodiscard]] static const FieldTable& fields();
};

/// Base class of array tables that are not defined in mbd/model itself, such as [[plot]] or [[core]]; it keeps the location of each given
/// field.
struct TableObject : Element {
  std::map<std::string, Location> places; ///< locations of the fields that were given

  /// Returns the location of the field, or of the whole table if the field is not given.
  [[nodiscard]] const Location& place(const std::string& field) const;
};

/// Table [[plot]]: time histories for one figure, all in the same unit.
struct Plot : TableObject {
  std::string title;                 ///< above the figure
  std::vector<std::string> channels; ///< patterns with * and ?
  std::vector<std::string> bounds;   ///< channels drawn dashed at ± their value
};

/// Table [[channel]]: a channel defined as a formula of others (formula/formula.h).
struct DefinedChannel : TableObject {
  std::string expression;    ///< formula as given, such as "foot.force + 2 * block.vx"
  std::string unit;          ///< unit of the result; "": the SI unit that follows from the operands
  std::string meaning, sign; ///< description and sign convention; may be empty
};

/// Table [[acceptance]]: a criterion for a run. It limits channels over the whole run, or forbids events.
struct Criterion : TableObject {
  std::string channel;                                  ///< pattern with * and ?
  std::string at_least_text, at_most_text, within_text; ///< limits as given, such as "300 kN"; empty if not given
  /// Limits in the unit of the channels, set once this unit is known; `within` limits the absolute value.
  std::optional<double> at_least, at_most, within;
  std::string element, event;          ///< patterns of an element and of an event that must not occur
  std::string consequence = "inspect"; ///< consequence of a violation: "inspect" or "reject"
  std::string reason;                  ///< justification, such as a document
};

/// Top-level keys of a model file.
struct ModelHeader {
  std::string title;        ///< one line
  std::string source;       ///< source of the values
  Vec2 gravity{0.0, -9.81}; ///< m/s², ground axes
  Location where;           ///< location of the first key in the model file

  /// Returns the fields as in a model file.
  [[nodiscard]] static const FieldTable& fields();
};

/// A kind of top-level array table defined in another folder, for example the dimensions of a core. Its tables add bodies, markers or
/// elements to the model.
struct TableKind {
  std::string name;                                                 ///< NAME in [[NAME]]
  std::string doc;                                                  ///< a few sentences: what it models
  FieldTable fields;                                                ///< fields of its struct
  std::shared_ptr<Element> (*create)() = nullptr;                   ///< returns a new table with default values; set by holds()
  std::shared_ptr<Element> (*copy)(const Element& table) = nullptr; ///< returns a copy; set by holds()
  void (*apply)(const Element& table, Model& model) =
      nullptr; ///< adds elements, missing data of bodies, or channels and criteria, and changes nothing else; throws ModelError
  /// True if apply() reads masses and inertias of bodies (first member), or numbers of elements (second). If false, these may be changed
  /// after completion without effect on the entries that apply() added.
  bool reads_masses = true, reads_elements = true;

  /// Declares T as the struct of the tables of this kind.
  template <class T> void holds() {
    create = create_object<Element, T>;
    copy = copy_object<Element, T>;
  }
};

/// A table with its kind. Copying it copies the table.
struct TableEntry {
  const TableKind* kind = nullptr; ///< not null; must outlive the model
  std::shared_ptr<Element> table;  ///< instance of the kind's struct

  /// Takes ownership of the table.
  TableEntry(const TableKind* kind_, std::shared_ptr<Element> table_) : kind(kind_), table(std::move(table_)) {}
  TableEntry(const TableEntry& other) : kind(other.kind), table(copied(*other.kind, *other.table)) {}
  TableEntry(TableEntry&&) = default;
  TableEntry& operator=(const TableEntry& other) { return *this = TableEntry(other); }
  TableEntry& operator=(TableEntry&&) = default;
  ~TableEntry() = default;
};

/// A key given under its earlier name.
struct RenamedKey {
  Location where;      ///< of the key
  std::string earlier; ///< name in the file
  std::string name;    ///< present name
  std::string subject; ///< entry with this key, such as "spring_damper 'rear block'"
};

/// A model as given by a file or by code; completed() makes a completed model of it. Copies share nothing.
struct Model {
  ModelHeader header;                            ///< title, source, gravity
  SimulationSettings simulation;                 ///< [simulation]
  OutputSettings output;                         ///< [output]
  std::vector<Body> bodies;                      ///< [[body]], in the order of the file
  std::vector<Marker> markers;                   ///< [[marker]], and markers made for references to bodies
  std::vector<SignalEntry> signals;              ///< [[signal]]
  std::vector<ElementEntry> elements;            ///< [[element]]
  std::vector<DefinedChannel> channels;          ///< [[channel]]
  std::vector<Plot> plots;                       ///< [[plot]]
  std::vector<Criterion> criteria;               ///< [[acceptance]]
  std::vector<TableEntry> tables;                ///< tables such as [[core]], as given; complete() makes bodies and elements of them
  Parameters parameters;                         ///< [parameters], and the fields whose values are formulas of parameters
  std::vector<std::string> files_without_format; ///< files of the model without `format = 1`
  std::vector<RenamedKey> renamed_keys;          ///< keys given under earlier names
  bool is_completed = false;                     ///< set by complete()

  /// Returns the body with this name, or nullptr.
  [[nodiscard]] const Body* find_body(const std::string& name) const;
};

/// Kinds that a model file may use. The kernel mbd refers to no kind by name.
struct Catalogue {
  std::vector<const ElementKind*> elements; ///< kinds of elements, unique names
  std::vector<const SignalKind*> signals;   ///< kinds of signals, unique names
  std::vector<const TableKind*> tables;     ///< kinds of array tables defined in other folders

  /// Returns the kind with this name, or nullptr.
  [[nodiscard]] const ElementKind* find_element(const std::string& name) const;
};

} // namespace steplap
