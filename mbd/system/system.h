// The compiled system: what a model becomes before it runs. Flat arrays, indices instead of names, and
// only what the scene needs; const while running. What changes is in State, scratch is in Dynamics.
#pragma once

#include "mbd/model/model.h"
#include "mbd/model/signal_network.h"
#include "mbd/system/roles.h"
#include "mbd/system/scene_units.h"

#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <typeinfo>
#include <unordered_map>
#include <vector>

namespace steplap {

class RequestedChannels;
class System;

/// Everything that changes during a run. Body 0 is the ground; q and v hold (x, y, θ) and its rate of
/// each body's centre of gravity.
struct State {
  double t = 0.0;                      ///< s
  std::vector<double> q, v;            ///< m and rad; m/s and rad/s
  std::vector<UnitMode> mode;          ///< per unit
  std::vector<FrictionState> friction; ///< per friction element
  std::vector<double> memory;          ///< bases of rows
  std::vector<double> inner;           ///< inner states of force elements
  double dissipated = 0.0;             ///< J, since the start
  double work = 0.0;                   ///< J, of loads and drives since the start
};

/// Integrals over time that a run keeps beside the motion (System::integrands).
class Integrals {
public:
  virtual ~Integrals() = default;
  /// Of integrand `slot`, from the start to t, which is not before the run's last stretch.
  [[nodiscard]] virtual double value(int slot, double t) const = 0;
};

/// What a channel may look at: a state with the accelerations and reactions that belong to it.
struct Snapshot {
  double t = 0.0;                         ///< s
  const Motion<double>* motion = nullptr; ///< per body
  const double* acceleration = nullptr;   ///< 3 per body
  const Evaluation* evaluation = nullptr; ///< contact forces, modes, friction states
  const double* row_force = nullptr;      ///< multiplier of every bilateral row
  const double* friction_force = nullptr; ///< wrench of every friction element along its rows
  const double* memory = nullptr;         ///< of driven rows and anchors (State::memory)
  double dissipated = 0.0, work = 0.0;    ///< J, of all since the start
  const Integrals* integrals = nullptr;   ///< null where no run keeps any: nothing has passed yet
};

/// Between which a value lies.
struct ValueBounds {
  double low = 0.0, high = 0.0; ///< in the value's unit
};

/// What a channel means, in words, given where it is made.
struct ChannelText {
  std::string_view meaning; ///< what it measures
  std::string_view sign;    ///< when it is positive, in whose axes; "" where its meaning says so
  std::string_view codes;   ///< of a mode: "0 free, 1 sticks, 2 slips"

  /// All three from texts.
  ChannelText(std::string_view meaning_, std::string_view sign_ = {}, std::string_view codes_ = {})
      : meaning(meaning_), sign(sign_), codes(codes_) {}
  /// Its meaning alone.
  ChannelText(const char* meaning_) : meaning(meaning_) {}
  /// Its meaning alone.
  ChannelText(const std::string& meaning_) : meaning(meaning_) {}
};

/// A named number that a run writes, bounds and judges.
struct Channel {
  std::string name;                             ///< "<element>.<quantity>"
  std::string unit;                             ///< SI; "" = none
  std::string doc;                              ///< its meaning
  std::function<double(const Snapshot&)> value; ///< at a moment of a run, in `unit`
  /// Of a value that costs much: bounds that cost little, for whoever only wants to know its extremes.
  std::function<ValueBounds(const Snapshot&)> bounds = {};
  bool has_extremes = true;          ///< false: it passes through infinity
  std::string sign = {}, codes = {}; ///< ChannelText
  bool is_on_request = false;        ///< made for a model that asks for it
};

/// A power that a run integrates over time, since some channel wants to know (Snapshot::integrals).
struct Integrand {
  std::function<double(const Snapshot&)> power;  ///< W
  std::function<double(const Snapshot&)> stored; ///< J; what an event takes from it at once counts with the integral. Null: nothing
};

/// Mass properties and start of a body; index 0 is the ground.
struct BodyData {
  std::string name;                 ///< of the model; "ground" for the ground
  double mass = 0.0, inertia = 0.0; ///< kg; kg m², about the centre of gravity
  Vec3 pose = Vec3::Zero();         ///< (x, y, θ) of the centre of gravity in the reference pose, m and rad
  Vec3 velocity = Vec3::Zero();     ///< its rate at the start, m/s and rad/s
};

/// Rows that belong together: a joint's, or a drive's.
struct RowBlock {
  int first = 0, count = 0; ///< in System::rows
  bool is_rigid = false;    ///< two axis rows at one point and the angle: holds a and b rigidly together
  int coordinate = -1;      ///< 0, 1, 2: it drives x, y or θ of the centre of gravity of a, and nothing else
  int element = 0;          ///< index in System::element_names
};

/// A force element with modes.
struct Unit {
  const ForceGroup* group = nullptr; ///< never nullptr
  int index = 0;                     ///< in its group
  int watch = 0, watch_count = 0;    ///< its first watch value, and how many it has
  int element = 0;                   ///< index in System::element_names
};

/// A friction element, with the places that it has in the arrays of a run.
struct FrictionUnit {
  std::unique_ptr<FrictionElement> friction; ///< never nullptr
  int row = 0;                               ///< first slot of its wrench in Snapshot::friction_force
  int watch = 0;                             ///< its first watch value
  int element = 0;                           ///< index in System::element_names
};

/// A compiled model: read by any number of threads at a time. It does not refer to the model.
class System {
public:
  System() = default;
  System(const System&) = delete; // channels and rows refer to what it owns
  System& operator=(const System&) = delete;

  std::string title;                                           ///< of the model
  Vec2 gravity = Vec2::Zero();                                 ///< m/s², ground axes
  SceneUnits scale;                                            ///< the scene's own length and times
  std::vector<BodyData> bodies;                                ///< the ground first
  std::vector<std::string> element_names;                      ///< in the order of the model
  std::vector<std::string> element_kinds;                      ///< of each element
  std::vector<std::unique_ptr<ForceGroup>> groups;             ///< one for each combination of measure and law
  std::vector<RowSpec> rows;                                   ///< bilateral and driven
  std::vector<RowBlock> row_blocks;                            ///< of `rows`, in their order
  LinkTable links;                                             ///< those of force elements first
  int force_link_count = 0;                                    ///< how many of `links` force elements act in
  std::vector<Unit> units;                                     ///< force elements with modes
  std::vector<FrictionUnit> frictions;                         ///< friction elements, in the order in which they were compiled
  std::vector<Channel> channels;                               ///< all that can be written of a run
  std::vector<Integrand> integrands;                           ///< of channels on request
  std::vector<std::unique_ptr<Channel>> operands;              ///< of expressions, where they are no channels themselves
  std::vector<std::unique_ptr<ForceGroup>> shares;             ///< of single elements, whose energy channels ask for
  std::vector<double> breakpoints;                             ///< of all signals in use, ascending
  std::vector<double> motion_breakpoints;                      ///< of those that are no mere forces (SignalUse), ascending
  double drives_end = std::numeric_limits<double>::infinity(); ///< the first drive jumps there: no run may pass it, s
  std::vector<double> initial_memory;                          ///< where State::memory starts
  std::vector<int> memory_elements;                            ///< of each number in it
  std::vector<double> initial_inner;                           ///< where State::inner starts
  std::vector<int> inner_elements;                             ///< of each inner state
  std::vector<const ForceGroup*> inner_groups;                 ///< those with inner states
  std::vector<char> is_body_used;                              ///< per body: some force element or friction refers to it
  bool has_work = false;                                       ///< some load, motor or drive may do work
  int contact_count = 0;                                       ///< of normal forces (Evaluated::contact_force)
  int watch_count = 0;                                         ///< of values watched for events
  int friction_row_count = 0;                                  ///< of rows of all friction elements together

  /// The ground included.
  [[nodiscard]] int body_count() const { return static_cast<int>(bodies.size()); }
  /// Numbers in State::inner.
  [[nodiscard]] int inner_count() const { return static_cast<int>(initial_inner.size()); }
  /// Of the packed state, where nothing is merged (dynamics.h).
  [[nodiscard]] int largest_dimension() const { return 6 * body_count() + inner_count() + 2; }
  /// The reference pose and velocity, modes and anchors that belong to it.
  [[nodiscard]] State initial_state() const;
  /// Potential energy: gravity and all that is stored in elements.
  [[nodiscard]] double potential_energy(const Motion<double>* motion) const;
  /// Of all bodies, J.
  [[nodiscard]] double kinetic_energy(const State& state) const;
  /// Angular frequency of the fastest harmonic of all loads and drives between the breakpoints about t, rad/s; 0: none.
  [[nodiscard]] double fastest_at(double t) const;
  /// Nullptr if there is none of that name.
  [[nodiscard]] const Channel* find_channel(const std::string& name) const;

private:
  friend class SystemBuilder;
  std::vector<std::unique_ptr<Signal>> signals_;
  std::vector<const Signal*> motion_signals_; ///< those with SignalUse::motion
};

/// Fills per-body motions from q and v; `motion` has one entry per body.
void place_bodies(const std::vector<double>& q, const std::vector<double>& v, std::vector<Motion<double>>& motion);

/// Bases of driven rows, so that the drives begin at the pose and velocity of `state`: of all, or of those elements alone
/// (by System::element_names) that `begins` marks.
void start_drives(const System& system, State& state, const std::vector<char>* begins = nullptr);

/// Where a marker ends up: a compiled body and a point and angle in its frame (from its centre of
/// gravity).
struct CompiledMarker {
  int body = k_ground;       ///< index in System::bodies
  Vec2 point = Vec2::Zero(); ///< m, from the centre of gravity, body axes
  double angle = 0.0;        ///< rad, of its axes against the body's
};

/// Indices of a contact's normal force and of its unit.
struct ContactIndex {
  int force = 0, unit = 0; ///< in Evaluated::contact_force; in System::units
};

/// What an element takes a signal for. The impulse of a force is known for a step of any length from the signal's
/// integral; what moves something, or enters a law otherwise, acts through what follows it: no step may pass over a part.
enum class SignalUse : unsigned char { motion, force };

/// Handed to ElementKind::compile: names in, indices out.
class SystemBuilder {
public:
  /// Of the channels, those named in `wanted`; null: all.
  SystemBuilder(const Model& model, const std::vector<std::string>* wanted);

  // --- references -------------------------------------------------------------------------------
  /// By its name. Throws ModelError if there is none.
  [[nodiscard]] CompiledMarker marker(const std::string& name) const;
  /// Its index in System::bodies. Throws ModelError if there is none.
  [[nodiscard]] int body(const std::string& name) const;
  /// Null for an empty name.
  [[nodiscard]] const Signal* signal(const std::string& name, SignalUse use = SignalUse::motion);
  /// Pose and velocity of a body in the reference pose.
  [[nodiscard]] const Motion<double>& reference(int body) const { return reference_[body]; }
  /// In the reference pose, ground axes, m.
  [[nodiscard]] Vec2 marker_position(const CompiledMarker& marker) const;
  /// A direction given in a marker's axes, in the axes of its body, length 1.
  [[nodiscard]] Vec2 direction(const CompiledMarker& marker, const Vec2& local) const;
  /// A contact element compiled at an earlier stage; null if `element` is none.
  [[nodiscard]] const ContactIndex* contact(const std::string& element) const;
  /// Of the model, by its name; nullptr if there is none.
  [[nodiscard]] const ElementEntry* element(const std::string& name) const;
  /// Of the channels, those that are wanted; not given: all.
  [[nodiscard]] std::optional<std::vector<std::string>> wanted_channels() const {
    return wanted_ ? std::optional<std::vector<std::string>>(*wanted_) : std::nullopt;
  }
  /// No step passes over this time, s.
  void add_breakpoint(double t) {
    system_->breakpoints.push_back(t);
    system_->motion_breakpoints.push_back(t);
  }
  /// The completed model that is being compiled.
  [[nodiscard]] const Model& model() const { return model_; }
  /// What is compiled so far: bodies and scales are complete before the first element.
  [[nodiscard]] const System& compiled() const { return *system_; }

  // --- contributions ------------------------------------------------------------------------------
  /// The group of type Group, made on first use; append to its `entries`.
  template <class Group> Group& group();
  /// Makes a unit of an entry: sets its mode and watch indices.
  template <class Group> void add_unit(Group& group, int watch_count);
  /// Index of a new normal force, registered under the current element's name; `unit` tells whether
  /// it is pressed (mode 1).
  int add_contact(int unit);
  /// Room for a base and its rate in State::memory; returns the index of the base.
  int add_memory(double base = 0.0, double base_rate = 0.0);
  /// One number of the inner state of an element of `group`: where it starts.
  int add_inner(const ForceGroup& group, double start);
  /// Rows of the current element. `is_rigid`, `coordinate`: as in RowBlock.
  void add_rows(std::vector<RowSpec> rows, bool is_rigid = false, int coordinate = -1);
  /// Returns its index in System::frictions.
  int add_friction(std::unique_ptr<FrictionElement> friction);
  /// "<element>.<name>"; what is returned is good until the next one is added. A channel that nobody wants is not made:
  /// what is returned then is forgotten.
  template <class Value> Channel& add_channel(std::string_view name, std::string_view unit, const ChannelText& text, Value&& value);
  /// The same for one that is made for a model that asks for it ([output] also, an expression), and costs nothing else.
  template <class Value> Channel& offer_channel(std::string_view name, std::string_view unit, const ChannelText& text, Value&& value);
  /// Calls `work` when the rows of all joints are compiled, before the elements of the second stage. What it calls error() for is noted
  /// at the current element. Not called for an element that does not act.
  void after_joints(std::function<void()> work) {
    if (!acting_) after_joints_.emplace_back(element_, std::move(work));
  }
  /// Index in System::rows that the next row will get.
  [[nodiscard]] int next_row() const { return static_cast<int>(system_->rows.size()); }
  /// Slot in Snapshot::friction_force that the next friction element will get.
  [[nodiscard]] int next_friction_row() const { return system_->friction_row_count; }
  /// Index in System::frictions that the next friction element will get.
  [[nodiscard]] int next_friction() const { return static_cast<int>(system_->frictions.size()); }
  /// Of the element that is being compiled, in System::element_names.
  [[nodiscard]] int element_index() const { return element_; }
  /// Notes an error at the current element: compile goes on and reports all of them.
  void error(const std::string& message);

private:
  [[nodiscard]] const Signal* signal_of(const std::string& name);
  friend std::unique_ptr<System> compile(const Model& model, const std::vector<std::string>* wanted);
  friend class RequestedChannels;
  enum class Use { none, operand, channel };
  struct GroupType { ///< what to do with a group of a type known where it was made
    const std::type_info* type;
    std::size_t (*count)(const ForceGroup& group);
    std::unique_ptr<ForceGroup> (*share)(const ForceGroup& group, std::size_t first, std::size_t count);
    bool does_work;
  };
  template <class Group> static GroupType type_of();
  [[nodiscard]] bool wants_channel(std::string_view owner, std::string_view name) const;
  [[nodiscard]] Use use_of(std::string_view owner, std::string_view name, bool is_on_request) const;
  Channel& enter_channel(Use use, std::string_view owner, std::string_view name, std::string_view unit, const ChannelText& text,
                         std::function<double(const Snapshot&)> value);
  void compile_bodies();
  void compile_elements(RequestedChannels& requested);
  void compile_inactive(const ElementEntry& entry, RequestedChannels& requested);
  /// What signals and channels belong to, whatever the element being compiled adds to.
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
  std::vector<std::pair<int, std::function<void()>>> after_joints_; ///< with the element that each belongs to
  const std::vector<std::string>* wanted_;
  std::vector<std::string> operand_names_; ///< of expressions, sorted
  std::vector<GroupType> group_types_;     ///< of each of the system's groups
  System* acting_ = nullptr;               ///< while system_ takes what an inactive element adds: the system being made
  Channel unwanted_;
};

/// Per element of a completed model: it acts, and so does that on which it hangs, as a sheet interface on its joint.
[[nodiscard]] std::vector<char> acting_elements(const Model& model);

/// Compiles a completed model. Of the channels, only those named in `wanted` are made; null: all. Throws ModelError with
/// all errors found.
[[nodiscard]] std::unique_ptr<System> compile(const Model& model, const std::vector<std::string>* wanted = nullptr);

// ---------------------------------------------------------------------------------------------

template <class Group> Group& SystemBuilder::group() {
  std::size_t i = 0; // a dozen at most
  while (i < group_types_.size() && *group_types_[i].type != typeid(Group)) ++i;
  if (i == group_types_.size()) {
    system_->groups.push_back(std::make_unique<Group>());
    group_types_.push_back(type_of<Group>());
  }
  return static_cast<Group&>(*system_->groups[i]);
}

// A copy of some entries keeps their places among modes, watches and links. Work is done by groups that say so, with
// k_does_work; all others dissipate and store.
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

template <class Group> void SystemBuilder::add_unit(Group& group, int watch_count) {
  auto& entry = group.entries.back();
  entry.unit = static_cast<int>(system_->units.size());
  entry.watch = system_->watch_count;
  system_->units.push_back({&group, static_cast<int>(group.entries.size()) - 1, entry.watch, watch_count, element_});
  system_->watch_count += watch_count;
}

} // namespace steplap
