// The model: what the user described, by name, before anything is compiled or run.
//
// Bodies, markers, signals and elements refer to each other by name; every entry remembers the
// place in the file it came from, so that an error found later can still point at it.
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
struct ElementJudgement;
struct Model;
struct RunResult;

/// A rigid body. Its frame has the origin `position` and the angle `angle` in the reference pose (the
/// pose the file gives); its centre of gravity lies at `cg` in that frame.
struct Body {
  std::string name;              ///< unique among bodies; not "ground"
  double mass = 0.0;             ///< kg, > 0
  double inertia = 0.0;          ///< kg m², about the centre of gravity, > 0
  Vec2 position = Vec2::Zero();  ///< m, ground axes
  double angle = 0.0;            ///< rad
  Vec2 cg = Vec2::Zero();        ///< m
  Vec2 velocity = Vec2::Zero();  ///< of the centre of gravity, m/s, ground axes
  double angular_velocity = 0.0; ///< rad/s
  bool fixed = false;            ///< it never moves, and needs neither mass nor inertia
  std::string label;             ///< what reports and drawings call it; "": the name
  std::vector<Vec2> outline;     ///< body frame, m; for drawings only
  Location where;                ///< in the model's file; empty of a body made in code
  std::uint32_t given = 0;       ///< bit k: the k-th of fields() stands in the file, whatever its value

  /// (x, y, θ) of the centre of gravity in the reference pose.
  [[nodiscard]] Vec3 reference_pose() const;
  /// Its fields as a model file has them.
  [[nodiscard]] static const FieldTable& fields();
};

/// A point fixed in a body (or the ground), with axes turned by `angle` against the body's.
/// Given either by `point` (body frame) or by `at` (ground frame, reference pose).
struct Marker {
  std::string name;            ///< unique among markers
  std::string body = "ground"; ///< name of a body, or "ground"
  std::optional<Vec2> point;   ///< m, body frame
  std::optional<Vec2> at;      ///< m, ground frame, in the reference pose
  double angle = 0.0;          ///< rad
  Location where;              ///< in the model's file

  /// Its fields as a model file has them.
  [[nodiscard]] static const FieldTable& fields();
};

/// What an element of any kind has. Kinds derive from it and add their fields.
struct Element {
  virtual ~Element() = default;
  std::string name;          ///< unique among elements
  std::string draw = "auto"; ///< how drawings show it; "auto": as its kind is usually drawn
  bool active = true;        ///< it acts from the start; else from where an action says so
  Location where;            ///< in the model's file

  /// Fields that elements of every kind have, besides name and kind.
  [[nodiscard]] static const FieldTable& common_fields();
};

/// One kind of element: its fields and how it becomes part of a compiled system.
struct ElementKind {
  std::string name;  ///< as written in a model file, "spring_damper"
  std::string doc;   ///< a few sentences: what it models, sign convention
  FieldTable fields; ///< of the struct that its elements are; besides common_fields()
  /// Elements of the kind in TOML, with whatever they need besides two bodies 'a' and 'b': for what is found out by making
  /// them (kind_channels.h). "": required fields are enough.
  std::string example = {};
  int stage = 0;                                                      ///< kinds that refer to other elements compile at stage 1
  std::shared_ptr<Element> (*create)() = nullptr;                     ///< a new element with the kind's defaults; set by holds()
  std::shared_ptr<Element> (*copy)(const Element& element) = nullptr; ///< set by holds()
  /// Adds the element to the system; reports what is wrong through the builder's errors.
  void (*compile)(const Element& element, SystemBuilder& builder) = nullptr;
  /// Judges an element of the kind after a run (mbd/trust/element_judgement.h); null if the kind has no limits of its own.
  ElementJudgement (*judge)(const Element& element, const Model& model, const RunResult& result) = nullptr;
  /// Kinds that exert a force that is given, and not the answer to a motion: does an element exert one besides its signals? Null: other kinds.
  bool (*has_constant_load)(const Element& element) = nullptr;
  /// Names of the channels whose extremes `judge` needs to tell whether the run can be trusted.
  std::vector<std::string> (*channels_of_trust)(const Element& element) = nullptr;

  /// Its elements are of type T.
  template <class T> void holds() {
    create = make_held<Element, T>;
    copy = copy_held<Element, T>;
  }
};

/// A copy of an object of that kind. Throws std::logic_error for a kind that does not say how: ElementKind::holds.
template <class Kind, class Object> std::shared_ptr<Object> copied(const Kind& kind, const Object& object) {
  if (!kind.copy) throw std::logic_error("the kind '" + kind.name + "' does not say what it holds: call holds<T>()");
  return kind.copy(object);
}

/// An element of a kind; a copy has an element of its own.
struct ElementEntry {
  const ElementKind* kind = nullptr; ///< never nullptr; has to outlive the model
  std::shared_ptr<Element> element;  ///< of the struct that the kind holds

  /// Takes the element over.
  ElementEntry(const ElementKind* kind_, std::shared_ptr<Element> element_) : kind(kind_), element(std::move(element_)) {}
  ElementEntry(const ElementEntry& other) : kind(other.kind), element(copied(*other.kind, *other.element)) {}
  ElementEntry(ElementEntry&&) = default;
  ElementEntry& operator=(const ElementEntry& other) { return *this = ElementEntry(other); }
  ElementEntry& operator=(ElementEntry&&) = default;
  ~ElementEntry() = default;
};

/// A named signal: a scalar function of time; a copy has a definition of its own.
struct SignalEntry {
  const SignalKind* kind = nullptr;             ///< never nullptr; has to outlive the model
  std::shared_ptr<SignalDefinition> definition; ///< of the struct that the kind holds

  /// Takes the definition over.
  SignalEntry(const SignalKind* kind_, std::shared_ptr<SignalDefinition> definition_) : kind(kind_), definition(std::move(definition_)) {}
  SignalEntry(const SignalEntry& other) : kind(other.kind), definition(copied(*other.kind, *other.definition)) {}
  SignalEntry(SignalEntry&&) = default;
  SignalEntry& operator=(const SignalEntry& other) { return *this = SignalEntry(other); }
  SignalEntry& operator=(SignalEntry&&) = default;
  ~SignalEntry() = default;
};

/// Runs of more steps than this are not begun, or given up when they turn out to need them: days of computing.
inline constexpr double k_most_steps = 1e10;

/// [simulation]: how long the model runs, by which method, from where.
struct SimulationSettings {
  double end = 1.0;                      ///< s
  std::string integrator = "auto";       ///< name of a method (method.h)
  std::optional<double> step;            ///< s, fixed step methods
  std::optional<double> tolerance;       ///< relative, adaptive methods
  std::string coordinates = "automatic"; ///< of small islands with pins: "automatic", "joint" or "absolute"
  std::string initial = "as_given";      ///< "as_given" or "equilibrium"
  Vec2 velocity = Vec2::Zero();          ///< m/s, added to every body's initial velocity
  double projection_tolerance = 1e-12;   ///< largest constraint residual left after a step, m or rad
  long max_events = 100000;              ///< beyond which a run is given up; kinks of characteristics do not count
  Location where;                        ///< of the table, in the model's file

  /// Its fields as a model file has them.
  [[nodiscard]] static const FieldTable& fields();
};

/// [output]: what is written of a run, and how often.
struct OutputSettings {
  double step = 1e-3;                ///< s
  std::vector<std::string> channels; ///< patterns with * and ?; empty = all
  std::vector<std::string> also;     ///< channels on request that there are besides, patterns
  double most_numbers = 1e8;         ///< rows times channels, beyond which a run is not begun: about 2 GB of text
  std::string seen_from;             ///< body that drawings stand still with; "" = chosen by the drawing
  Location where;                    ///< of the table, in the model's file

  /// Its fields as a model file has them.
  [[nodiscard]] static const FieldTable& fields();
};

/// What an array of tables that is none of the kernel's holds: it knows where its fields stand in the file.
struct TableObject : Element {
  std::map<std::string, Location> places; ///< of the fields given

  /// Of the field, or of the whole table if it is not given.
  [[nodiscard]] const Location& place(const std::string& field) const;
};

/// [[plot]]: time histories that belong in one figure, all of one unit.
struct Plot : TableObject {
  std::string title;                 ///< above the figure
  std::vector<std::string> channels; ///< patterns with * and ?
  std::vector<std::string> bounds;   ///< channels drawn dashed at plus and minus their value
};

/// [[channel]]: a formula of other channels (formula/formula.h).
struct DefinedChannel : TableObject {
  std::string expression;    ///< as given: "foot.force + 2 * block.vx"
  std::string unit;          ///< that it is given in; "": SI, as it follows from the operands
  std::string meaning, sign; ///< for documents; may be empty
};

/// [[acceptance]]: what the receiver of a machine may ask of a run. Either of channels (over the samples
/// of the trajectory) or of events that must not happen.
struct Criterion : TableObject {
  std::string channel;                                  ///< pattern with * and ?
  std::string at_least_text, at_most_text, within_text; ///< as given, "300 kN": empty if not
  /// The same in the channels' unit, once these are known; `within` bounds the absolute value.
  std::optional<double> at_least, at_most, within;
  std::string element, event;          ///< patterns: no such event of such an element
  std::string consequence = "inspect"; ///< if it is not met: "inspect" or "reject"
  std::string reason;                  ///< why, or by which document
};

/// Top-level scalars of a model file.
struct ModelHeader {
  std::string title;        ///< one line
  std::string source;       ///< where the values come from
  Vec2 gravity{0.0, -9.81}; ///< m/s², ground axes
  Location where;           ///< of the first key, in the model's file

  /// Its fields as a model file has them.
  [[nodiscard]] static const FieldTable& fields();
};

/// A top-level array of tables that is not the kernel's: handed in by another room (a core's geometry,
/// say), it reads its own fields and adds bodies, markers or elements to the model.
struct TableKind {
  std::string name;                                                 ///< as in [[name]]
  std::string doc;                                                  ///< a few sentences: what it stands for
  FieldTable fields;                                                ///< of the struct that its tables are
  std::shared_ptr<Element> (*create)() = nullptr;                   ///< a new table with the kind's defaults; set by holds()
  std::shared_ptr<Element> (*copy)(const Element& table) = nullptr; ///< set by holds()
  void (*apply)(const Element& table, Model& model) =
      nullptr; ///< adds elements, gives bodies what they lack, or adds what is shown and judged, and changes nothing else; throws ModelError
  /// Does apply() look at bodies' masses and inertias, at plain numbers of elements? If not, they can be changed afterwards.
  bool reads_masses = true, reads_elements = true;

  /// Its tables are of type T.
  template <class T> void holds() {
    create = make_held<Element, T>;
    copy = copy_held<Element, T>;
  }
};

/// A table of such a kind; a copy has a table of its own.
struct TableEntry {
  const TableKind* kind = nullptr; ///< never nullptr; has to outlive the model
  std::shared_ptr<Element> table;  ///< of the struct that the kind holds

  /// Takes the table over.
  TableEntry(const TableKind* kind_, std::shared_ptr<Element> table_) : kind(kind_), table(std::move(table_)) {}
  TableEntry(const TableEntry& other) : kind(other.kind), table(copied(*other.kind, *other.table)) {}
  TableEntry(TableEntry&&) = default;
  TableEntry& operator=(const TableEntry& other) { return *this = TableEntry(other); }
  TableEntry& operator=(TableEntry&&) = default;
  ~TableEntry() = default;
};

/// A key that a model file gives by its earlier name.
struct RenamedKey {
  Location where;      ///< of the key
  std::string earlier; ///< as in the file
  std::string name;    ///< its present name
  std::string subject; ///< what has the key: "spring_damper 'rear block'"
};

/// A value: a copy shares nothing with it. As given by a file or by code, until completed() makes a completed model of it.
struct Model {
  ModelHeader header;                            ///< title, source, gravity
  SimulationSettings simulation;                 ///< [simulation]
  OutputSettings output;                         ///< [output]
  std::vector<Body> bodies;                      ///< [[body]], in the order of the file
  std::vector<Marker> markers;                   ///< [[marker]], and those that references to bodies made
  std::vector<SignalEntry> signals;              ///< [[signal]]
  std::vector<ElementEntry> elements;            ///< [[element]]
  std::vector<DefinedChannel> channels;          ///< [[channel]]
  std::vector<Plot> plots;                       ///< [[plot]]
  std::vector<Criterion> criteria;               ///< [[acceptance]]
  std::vector<TableEntry> tables;                ///< such as [[core]], as given; complete() adds what they stand for
  Parameters parameters;                         ///< [parameters], and the fields that follow from them
  std::vector<std::string> files_without_format; ///< files of the model that do not say `format = 1`
  std::vector<RenamedKey> renamed_keys;          ///< keys that its files give by earlier names
  bool is_completed = false;                     ///< by complete(): until then what its tables stand for is missing

  /// Nullptr if there is none of that name.
  [[nodiscard]] const Body* find_body(const std::string& name) const;
};

/// The kinds a model file may use: the kernel and the reader know none by name.
struct Catalogue {
  std::vector<const ElementKind*> elements; ///< kinds of elements, with names of their own
  std::vector<const SignalKind*> signals;   ///< kinds of signals, with names of their own
  std::vector<const TableKind*> tables;     ///< top-level arrays of tables that are none of the kernel's

  /// Nullptr if there is none of that name.
  [[nodiscard]] const ElementKind* find_element(const std::string& name) const;
};

} // namespace steplap
