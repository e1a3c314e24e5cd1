// The compiled system: a model prepared for simulation, with flat arrays and indices instead of names. It is constant during a run. The
// quantities that change are in State, scratch memory is in Dynamics.
#pragma once

#include "mbd/model/model.h"
#include "mbd/model/signal_network.h"
#include "mbd/system/endless_face.h"
#include "mbd/system/roles.h"

#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <typeinfo>
#include <unordered_map>
#include <unordered_set>
#include <vector>

namespace steplap {

class RequestedChannels;
class System;

/// Impacts that an inextensible rope or a one-way clutch has taken.
struct Impact {
  double impulse = 0.0; ///< of the last impact, N s or N m s; 0 before the first
  double lost = 0.0;    ///< energy lost in all impacts, J
};

/// Everything that changes during a run. q and v contain (x, y, θ) of each body's centre of gravity and their rates, 3 numbers per body;
/// body 0 is the ground.
struct State {
  double t = 0.0;                      ///< s
  std::vector<double> q, v;            ///< m and rad; m/s and rad/s
  std::vector<UnitMode> mode;          ///< per unit
  std::vector<FrictionState> friction; ///< per friction element
  std::vector<RowBase> bases;          ///< constants of rows that are set during the run (RowSpec::base)
  std::vector<Impact> impacts;         ///< per rope and one-way clutch (OneSidedRow::impact, OneWayLock::impact)
  std::vector<double> inner;           ///< internal states of force elements
  double dissipated = 0.0;             ///< dissipated energy since the start, J
  double work = 0.0;                   ///< work of loads and drives since the start, J
};

/// Time integrals that a run computes in addition to the motion (System::integrands).
class Integrals {
public:
  virtual ~Integrals() = default;
  /// Returns the integral of integrand `slot` from the start to t. Precondition: t is not before the last step.
  [[nodiscard]] virtual double value(int slot, double t) const = 0;
};

/// Data from which channels compute their values: a state with its accelerations and reactions.
struct Snapshot {
  double t = 0.0;                         ///< s
  const Motion<double>* motion = nullptr; ///< per body
  const double* acceleration = nullptr;   ///< 3 per body
  const Evaluation* evaluation = nullptr; ///< contact forces, modes, friction states
  const double* row_force = nullptr;      ///< multiplier of every bilateral row
  const double* friction_force = nullptr; ///< wrench of every friction element along its rows
  const Impact* impacts = nullptr;        ///< State::impacts
  double dissipated = 0.0, work = 0.0;    ///< dissipated energy and work of the whole system since the start, J
  const Integrals* integrals = nullptr;   ///< null outside a run; integrals are then zero
};

/// Interval that contains a value.
struct ValueBounds {
  double low = 0.0, high = 0.0; ///< in the value's unit
};

/// Documentation of a channel.
struct ChannelText {
  std::string_view meaning; ///< measured quantity
  std::string_view sign;    ///< direction in which it is positive, and axes; "" if `meaning` states it
  std::string_view codes;   ///< codes of a mode: "0 free, 1 sticks, 2 slips"

  /// Sets all three texts.
  ChannelText(std::string_view meaning_, std::string_view sign_ = {}, std::string_view codes_ = {})
      : meaning(meaning_), sign(sign_), codes(codes_) {}
  /// Sets the meaning only.
  ChannelText(const char* meaning_) : meaning(meaning_) {}
  /// Sets the meaning only.
  ChannelText(const std::string& meaning_) : meaning(meaning_) {}
};

/// Meaning of a channel that is the same for all kinds of element, whatever the name of the channel.
enum class ChannelRole : std::uint8_t {
  none,         ///< no meaning of this kind
  margin,       ///< capacity of a joint over its load; below 1 the joint does not hold
  friction_use, ///< friction force over the largest one that friction can hold at that time
  strength_use, ///< force over the strength of the element, at which it breaks
};

/// Texts that channels share: a scene has some 50 different ones, and up to a million channels. Addresses are stable.
class SharedTexts {
public:
  /// Returns the stored text, which exists as long as this object.
  [[nodiscard]] const std::string& stored(std::string_view text) { return *texts_.emplace(text).first; }

private:
  std::unordered_set<std::string> texts_;
};

/// A named result of a run: a scalar function of the snapshot. References refer to System::texts.
struct Channel {
  std::string name;                             ///< "<element>.<quantity>"
  const std::string& unit;                      ///< SI; "" = none
  const std::string& doc;                       ///< ChannelText::meaning
  const std::string& sign;                      ///< ChannelText::sign
  const std::string& codes;                     ///< ChannelText::codes
  std::function<double(const Snapshot&)> value; ///< returns the value, in `unit`
  /// Cheap bounds of an expensive value, for the search of extremes; may be empty.
  std::function<ValueBounds(const Snapshot&)> bounds = {};
  bool has_extremes = true;             ///< false if the value can be infinite
  bool is_on_request = false;           ///< computed only if a model requests it
  ChannelRole role = ChannelRole::none; ///< meaning for any kind of element
};

/// A power that a run integrates over time because a channel needs the integral (Snapshot::integrals).
struct Integrand {
  std::function<double(const Snapshot&)> power;  ///< W
  std::function<double(const Snapshot&)> stored; ///< energy, J, whose decrease at an event is added to the integral; null: none
};

/// Mass properties and initial state of a body; index 0 is the ground.
struct BodyData {
  std::string name;                 ///< name in the model; "ground" for the ground
  double mass = 0.0, inertia = 0.0; ///< kg; kg m², about the centre of gravity
  Vec3 pose = Vec3::Zero();         ///< (x, y, θ) of the centre of gravity in the reference pose, m and rad
  Vec3 velocity = Vec3::Zero();     ///< rates of `pose` at the start, m/s and rad/s
};

/// Consecutive rows of one joint or drive.
struct RowBlock {
  int first = 0, count = 0; ///< range in System::rows
  bool is_rigid = false;    ///< two axis rows at one point and an angle row, which hold a and b rigidly together
  int coordinate = -1;      ///< 0, 1, 2: the row drives x, y or θ of the centre of gravity of a, and nothing else; −1: otherwise
  int element = 0;          ///< index in System::element_names
};

/// A force element with modes.
struct Unit {
  const ForceGroup* group = nullptr;    ///< never nullptr
  int index = 0;                        ///< in its group
  int first_event = 0, event_count = 0; ///< index of its first event function, and their number
  int element = 0;                      ///< index in System::element_names
};

class BoundedFriction;
class OneSidedRow;
class OneWayLock;

/// A friction element with its indices in the arrays of a run. The last three pointers give access to its type without a cast.
struct FrictionUnit {
  std::unique_ptr<FrictionElement> friction; ///< never nullptr
  int row = 0;                               ///< index of its first component in Snapshot::friction_force
  int first_event = 0;                       ///< index of its first event function
  int element = 0;                           ///< index in System::element_names
  const BoundedFriction* bounded = nullptr;  ///< the element, if its dimension is 1
  const OneSidedRow* rope = nullptr;         ///< the element, if it is an inextensible rope
  const OneWayLock* clutch = nullptr;        ///< the element, if it is a one-way clutch

  /// Returns the index of an event function of the element.
  [[nodiscard]] int slot(FrictionWatch watch) const { return first_event + static_cast<int>(watch); }
  /// Returns the event function of the element that has this index.
  [[nodiscard]] FrictionWatch watch_of(int slot) const { return static_cast<FrictionWatch>(slot - first_event); }
};

/// Characteristic length and times of a system. Thresholds such as "many events in a short time" are proportional to them, so that a scaled
/// model gives the same result. Some tolerances do not use them yet (KNOWN_ISSUES.md).
struct SceneUnits {
  double length = 1.0;   ///< largest radius of gyration √(J/m), m
  double duration = 1.0; ///< duration of the run, s
  double rate = 1.0;     ///< √(g/length), 1/s; π/duration without gravity

  /// Returns 1/rate, s.
  [[nodiscard]] double time() const { return 1.0 / rate; }
};

/// A compiled model. Keeps no reference to the model, and may be used by several threads at once.
class System {
public:
  System() = default;
  System(const System&) = delete; // channels and rows contain pointers into the object
  System& operator=(const System&) = delete;

  std::string title;                                           ///< title of the model
  Vec2 gravity = Vec2::Zero();                                 ///< m/s², ground axes
  SceneUnits scale;                                            ///< characteristic length and times of the system
  std::vector<BodyData> bodies;                                ///< the ground first
  std::vector<std::string> element_names;                      ///< in the order of the model
  std::vector<std::string> element_kinds;                      ///< of each element
  std::vector<std::unique_ptr<ForceGroup>> groups;             ///< one for each combination of measure and law
  std::vector<RowSpec> rows;                                   ///< bilateral and driven rows
  std::vector<RowBlock> row_blocks;                            ///< blocks of `rows`, in the same order
  LinkTable links;                                             ///< pairs of bodies; those of force elements come first
  int force_link_count = 0;                                    ///< number of `links` used by force elements
  std::vector<Unit> units;                                     ///< force elements with modes
  std::vector<FrictionUnit> frictions;                         ///< in the order of compilation
  SharedTexts texts;                                           ///< of the channels
  std::vector<Channel> channels;                               ///< all available channels
  std::vector<Integrand> integrands;                           ///< powers to be integrated for channels on request
  std::vector<std::unique_ptr<Channel>> operands;              ///< operands of formulas that are not channels themselves
  std::vector<std::unique_ptr<ForceGroup>> shares;             ///< copies of the entries of single elements, for their energy channels
  std::vector<double> breakpoints;                             ///< breakpoints of all signals in use, ascending, s
  std::vector<double> motion_breakpoints;                      ///< breakpoints of signals with SignalUse::motion, ascending, s
  double drives_end = std::numeric_limits<double>::infinity(); ///< time at which a drive would jump, s; no run may continue beyond it
  std::vector<RowBase> initial_bases;                          ///< initial State::bases
  std::vector<int> base_elements;                              ///< element of each of initial_bases
  std::vector<Impact> initial_impacts;                         ///< initial State::impacts: none yet
  std::vector<int> impact_elements;                            ///< element of each of initial_impacts
  std::vector<double> initial_inner;                           ///< initial State::inner
  std::vector<int> inner_elements;                             ///< element of each inner state
  std::vector<const ForceGroup*> inner_groups;                 ///< groups with inner states
  std::vector<char> is_body_used;                              ///< per body: a force or friction element acts on it
  bool has_work = false;                                       ///< a load, motor or drive may do work
  int contact_count = 0;                                       ///< number of normal forces (EvaluationData::contact_force)
  std::vector<EndlessFace> endless_faces;                      ///< contact faces that extend beyond the end of their part
  int event_count = 0;                                         ///< number of event functions
  int friction_row_count = 0;                                  ///< number of rows of all friction elements

  /// Returns a channel that can be added to `channels`; its texts are stored in `texts`.
  [[nodiscard]] Channel make_channel(std::string name, std::string_view unit, const ChannelText& text,
                                     std::function<double(const Snapshot&)> value);
  /// Returns the number of bodies, including the ground.
  [[nodiscard]] int body_count() const { return static_cast<int>(bodies.size()); }
  /// Returns the length of State::inner.
  [[nodiscard]] int inner_count() const { return static_cast<int>(initial_inner.size()); }
  /// Returns the dimension of the packed state if no bodies are merged (dynamics.h), an upper bound.
  [[nodiscard]] int largest_dimension() const { return 6 * body_count() + inner_count() + 2; }
  /// Returns the reference pose and velocity with the modes and anchors that follow from them.
  [[nodiscard]] State initial_state() const;
  /// Returns the potential energy of gravity and of all elements, J; `motion` has one entry per body.
  [[nodiscard]] double potential_energy(const Motion<double>* motion) const;
  /// Returns the kinetic energy of all bodies, J.
  [[nodiscard]] double kinetic_energy(const State& state) const;
  /// Returns the highest angular frequency of all loads and drives between the breakpoints around t, rad/s; 0 if there is none.
  [[nodiscard]] double fastest_at(double t) const;
  /// Returns the channel with this name, or nullptr.
  [[nodiscard]] const Channel* find_channel(const std::string& name) const;

private:
  friend class SystemBuilder;
  std::vector<std::unique_ptr<Signal>> signals_;
  std::vector<const Signal*> motion_signals_; ///< signals with SignalUse::motion
};

/// Computes the motions of all bodies from q and v; `motion` has one entry per body.
void place_bodies(const std::vector<double>& q, const std::vector<double>& v, std::vector<Motion<double>>& motion);

/// Sets the bases of driven rows in `state` such that the drives start from the pose and velocity of `state`. If `begins` is not null, only
/// drives of the elements marked in it (index as in System::element_names) are set.
void start_drives(const System& system, State& state, const std::vector<char>* begins = nullptr);

/// A marker after compilation: body, position relative to the centre of gravity, and angle.
struct CompiledMarker {
  int body = k_ground;       ///< index in System::bodies
  Vec2 point = Vec2::Zero(); ///< position relative to the centre of gravity, m, body axes
  double angle = 0.0;        ///< angle of its axes relative to those of the body, rad
};

/// Indices of the normal force and of the unit of a contact.
struct ContactIndex {
  int force = 0, unit = 0; ///< in EvaluationData::contact_force; in System::units
};

/// Use of a signal by an element: as a force, or in any other way (`motion`: drives, parameters of laws). A force can be averaged exactly
/// over a step of any length, by the integral of the signal. The other uses must be resolved by the steps.
enum class SignalUse : unsigned char { motion, force };

/// Interface for ElementKind::compile. Resolves names, and collects the parts of the system that elements contribute.
class SystemBuilder {
public:
  /// `wanted`: names of the channels to be made; null: all.
  SystemBuilder(const Model& model, const std::vector<std::string>* wanted);

  // --- references -------------------------------------------------------------------------------
  /// Returns the marker with this name. Throws ModelError if there is none.
  [[nodiscard]] CompiledMarker marker(const std::string& name) const;
  /// Returns the index of the body in System::bodies. Throws ModelError if there is none.
  [[nodiscard]] int body(const std::string& name) const;
  /// Returns the signal; null for an empty name. Throws ModelError if the name is unknown.
  [[nodiscard]] const Signal* signal(const std::string& name, SignalUse use = SignalUse::motion);
  /// Returns pose and velocity of a body in the reference pose.
  [[nodiscard]] const Motion<double>& reference(int body) const { return reference_[body]; }
  /// Returns the position of the marker in the reference pose, ground axes, m.
  [[nodiscard]] Vec2 marker_position(const CompiledMarker& marker) const;
  /// Returns a unit vector in the direction of `local`. `local` is in the axes of the marker, the result in the axes of its body.
  [[nodiscard]] Vec2 direction(const CompiledMarker& marker, const Vec2& local) const;
  /// Returns the indices of a contact element compiled at an earlier stage; null if `element` is not a contact.
  [[nodiscard]] const ContactIndex* contact(const std::string& element) const;
  /// Returns the element of the model with this name, or nullptr.
  [[nodiscard]] const ElementEntry* element(const std::string& name) const;
  /// Returns the names of the channels to be made; nullopt: all.
  [[nodiscard]] std::optional<std::vector<std::string>> requested_channel_names() const {
    return wanted_ ? std::optional<std::vector<std::string>>(*wanted_) : std::nullopt;
  }
  /// Adds a time, s, at which a step must end.
  void add_breakpoint(double t) {
    system_->breakpoints.push_back(t);
    system_->motion_breakpoints.push_back(t);
  }
  /// Returns the completed model that is being compiled.
  [[nodiscard]] const Model& model() const { return model_; }
  /// Returns the system as compiled so far. Its bodies and scales are complete before the first element is compiled.
  [[nodiscard]] const System& compiled() const { return *system_; }

  // --- contributions ------------------------------------------------------------------------------
  /// Returns the group of this type, created on the first call. Elements append themselves to its `entries`.
  template <class Group> Group& group();
  /// Makes the last entry of the group a unit, that is, an element with modes: sets its indices of mode and first event function.
  template <class Group> void add_unit(Group& group, int event_count);
  /// Adds a normal force for the current element and returns its index. The contact is pressed while `unit` is in mode 1.
  int add_contact(int unit);
  /// Declares that a contact continues beyond the end of the part that carries it, for warnings (endless_face.h). The face is the line
  /// through marker `b` with `normal`, in the marker's axes; `points` of body a, in its axes, press on it. `remedy` is a clause that says
  /// how a model can give the face an end. Nothing is added if the part has no outline.
  void add_endless_face(int contact, int a, std::vector<Vec2> points, const std::string& b, const Vec2& normal, std::string remedy);
  /// Adds a base (RowSpec::base) for rows of the current element, with this initial value. Returns its index in State::bases.
  int add_base(double value = 0.0);
  /// Adds an entry for the impacts of the current element. Returns its index in State::impacts.
  int add_impacts();
  /// Adds one inner state of the current element, which belongs to `group`, with initial value `start`. Returns its index in State::inner.
  int add_inner(const ForceGroup& group, double start);
  /// Adds rows of the current element; `is_rigid` and `coordinate` as in RowBlock.
  void add_rows(std::vector<RowSpec> rows, bool is_rigid = false, int coordinate = -1);
  /// Adds a friction element and returns its index in System::frictions.
  int add_friction(std::unique_ptr<FrictionElement> friction);
  /// Adds the channel "<element>.<name>" and returns a reference that is valid until the next channel is added. A channel that is not
  /// wanted is not added; the reference is then to a dummy.
  template <class Value> Channel& add_channel(std::string_view name, std::string_view unit, const ChannelText& text, Value&& value);
  /// Adds a channel that is computed only on request (`also` of [output], or a formula). Otherwise like add_channel().
  template <class Value> Channel& offer_channel(std::string_view name, std::string_view unit, const ChannelText& text, Value&& value);
  /// Calls `work` after the rows of all joints are compiled, and before the elements of stage 1. Errors in it are reported for the current
  /// element. Not called for inactive elements.
  void after_joints(std::function<void()> work) {
    if (!acting_) after_joints_.emplace_back(element_, std::move(work));
  }
  /// Returns the index in System::rows of the next row to be added.
  [[nodiscard]] int next_row() const { return static_cast<int>(system_->rows.size()); }
  /// Returns the index in Snapshot::friction_force of the next friction element's first component.
  [[nodiscard]] int next_friction_row() const { return system_->friction_row_count; }
  /// Returns the index in System::frictions of the next friction element.
  [[nodiscard]] int next_friction() const { return static_cast<int>(system_->frictions.size()); }
  /// Returns the index of the current element in System::element_names.
  [[nodiscard]] int element_index() const { return element_; }
  /// Reports an error of the current element. Compilation continues, so that all errors are reported together.
  void error(const std::string& message);

private:
  [[nodiscard]] const Signal* signal_of(const std::string& name);
  friend std::unique_ptr<System> compile(const Model& model, const std::vector<std::string>* wanted);
  friend class RequestedChannels;
  enum class Use { none, operand, channel };
  struct GroupType { ///< functions that copy or classify a group whose type is known only where it is created
    const std::type_info* type;
    std::size_t (*count)(const ForceGroup& group);
    std::unique_ptr<ForceGroup> (*share)(const ForceGroup& group, std::size_t first, std::size_t count);
    bool does_work;
  };
  template <class Group> static GroupType type_of();
  [[nodiscard]] bool is_channel_requested(std::string_view owner, std::string_view name) const;
  [[nodiscard]] Use use_of(std::string_view owner, std::string_view name, bool is_on_request) const;
  Channel& enter_channel(Use use, std::string_view owner, std::string_view name, std::string_view unit, const ChannelText& text,
                         std::function<double(const Snapshot&)> value);
  void compile_bodies();
  void compile_elements(RequestedChannels& requested);
  void compile_inactive(const ElementEntry& entry, RequestedChannels& requested);
  /// Returns the system that owns signals and channels. While an inactive element is compiled into a temporary system, it is the real one.
  [[nodiscard]] System& acting() { return acting_ ? *acting_ : *system_; }
  void finish();
  void add_body_channels();

  const Model& model_;
  std::unique_ptr<System> system_;
  std::vector<Motion<double>> reference_;
  std::unordered_map<std::string, int> body_index_;
  std::unordered_map<std::string, CompiledMarker> marker_index_;
  SignalNetwork signals_;
  std::unordered_map<std::string, const Signal*> signal_index_;
  std::unordered_map<std::string, std::size_t> element_index_;
  std::unordered_map<std::string, ContactIndex> contact_index_;
  std::vector<Diagnostic> errors_;
  int element_ = -1;
  std::vector<std::pair<int, std::function<void()>>> after_joints_; ///< functions with the index of the element to which each belongs
  const std::vector<std::string>* wanted_;
  std::vector<std::string> operand_names_; ///< operands of formulas, sorted
  std::vector<GroupType> group_types_;     ///< one for each group of the system
  System* acting_ = nullptr;               ///< the real system while system_ is the temporary one of an inactive element; null otherwise
  std::string no_text_;
  Channel unwanted_{{}, no_text_, no_text_, no_text_, no_text_, {}};
};

/// Returns for each element of a completed model whether it is active. An element that depends on another, such as a sheet interface on its
/// joint, is active only if that one is.
[[nodiscard]] std::vector<char> acting_elements(const Model& model);

/// Compiles a completed model. `wanted`: names of the channels to be made; null: all. Throws ModelError with all errors found.
[[nodiscard]] std::unique_ptr<System> compile(const Model& model, const std::vector<std::string>* wanted = nullptr);

// ---------------------------------------------------------------------------------------------

template <class Group> Group& SystemBuilder::group() {
  std::size_t i = 0; // linear search; there are a dozen groups at most
  while (i < group_types_.size() && *group_types_[i].type != typeid(Group)) ++i;
  if (i == group_types_.size()) {
    system_->groups.push_back(std::make_unique<Group>());
    group_types_.push_back(type_of<Group>());
  }
  return static_cast<Group&>(*system_->groups[i]);
}

// Returns the functions of a group type. A share is a copy of some entries of a group, with the same indices of modes, event functions and
// links. Groups with k_does_work do work; all others only dissipate and store energy.
template <class Group> SystemBuilder::GroupType SystemBuilder::type_of() {
  GroupType type{};
  type.type = &typeid(Group);
  type.count = [](const ForceGroup& group) { return static_cast<const Group&>(group).entries.size(); };
  type.share = [](const ForceGroup& group, std::size_t first, std::size_t count) -> std::unique_ptr<ForceGroup> {
    const auto begin = static_cast<const Group&>(group).entries.begin() + static_cast<std::ptrdiff_t>(first);
    auto share = std::make_unique<Group>();
    share->entries.assign(begin, begin + static_cast<std::ptrdiff_t>(count));
    return share;
  };
  type.does_work = requires { requires Group::k_does_work; };
  return type;
}

template <class Value>
Channel& SystemBuilder::add_channel(std::string_view name, std::string_view unit, const ChannelText& text, Value&& value) {
  const std::string_view owner = system_->element_names[element_];
  const Use use = use_of(owner, name, false);
  return use == Use::none ? unwanted_ : enter_channel(use, owner, name, unit, text, std::forward<Value>(value));
}

template <class Value>
Channel& SystemBuilder::offer_channel(std::string_view name, std::string_view unit, const ChannelText& text, Value&& value) {
  const std::string_view owner = system_->element_names[element_];
  const Use use = use_of(owner, name, true);
  if (use == Use::none) return unwanted_;
  Channel& channel = enter_channel(use, owner, name, unit, text, std::forward<Value>(value));
  channel.is_on_request = true;
  return channel;
}

template <class Group> void SystemBuilder::add_unit(Group& group, int event_count) {
  auto& entry = group.entries.back();
  entry.unit = static_cast<int>(system_->units.size());
  entry.first_event = system_->event_count;
  system_->units.push_back({&group, static_cast<int>(group.entries.size()) - 1, entry.first_event, event_count, element_});
  system_->event_count += event_count;
}

} // namespace steplap
