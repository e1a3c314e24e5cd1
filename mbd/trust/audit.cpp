#include "mbd/trust/audit.h"

#include "mbd/base/portable_math.h"
#include "mbd/system/actions.h"
#include "mbd/system/slight_force.h"
#include "mbd/trust/known_to.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <numeric>

namespace steplap {

namespace {

const std::string k_prefix = "audit: ";
constexpr double k_still = 1e-6;
const char* const k_pushes = ".pushes";
const char* const k_overload = ".overload";
const char* const k_shares = ".shares";
const char* const k_unknown = ".unknown";
const char* const k_forces = "forces";
const char* const k_velocities = "velocities";
const char* const k_places = "places";
constexpr double k_one_line = 1e-9; // relative to the size of the bodies, and rad: lines that differ by less are the same line

constexpr double k_no_bound = 1e20; // N or N m: larger bounds count as infinite (one-way clutch), and the present force replaces them

// Returns a bound of the power that friction appears to produce because velocities are rounded, W: Σ (largest possible force · accuracy of
// the rate).
double power_of_rounding(const Snapshot& s, const System& system, std::size_t f, double met) {
  const FrictionUnit& unit = system.frictions[f];
  const FrictionState& state = s.evaluation->friction[f];
  const RowSpec* rows = unit.friction->rows(state);
  double power = 0.0;
  for (int i = 0; i < unit.friction->dimension(); ++i) {
    const double rate = row_rate_known_to(rows[i], s, met);
    double along[3] = {0, 0, 0}, most = 0.0;
    for (const double sign : {1.0, -1.0}) {
      along[i] = sign;
      const double bound = unit.friction->never_slips() ? INFINITY : unit.friction->support(*s.evaluation, state, along);
      most = std::max(most, bound < k_no_bound ? bound : std::abs(s.friction_force[unit.row + i]));
    }
    power += most * rate;
  }
  return power;
}

double power_of_friction(const Snapshot& s, const System& system, std::size_t f) {
  const FrictionUnit& unit = system.frictions[f];
  const FrictionState& state = s.evaluation->friction[f];
  const int n = unit.friction->dimension();
  const RowSpec* rows = unit.friction->rows(state);
  double rate[3] = {0, 0, 0}, power = 0.0;
  for (int i = 0; i < n; ++i) {
    rate[i] = evaluate_row<false>(rows[i], s.motion).rate;
    if (rows[i].drive) rate[i] -= row_target(rows[i], s.evaluation->bases, s.t).rate;
    power += s.friction_force[unit.row + i] * rate[i];
  }
  if (state.phase == FrictionPhase::slip) return power;
  if (unit.friction->never_slips()) return 0.0;
  const double most = unit.friction->support(*s.evaluation, state, rate),
               size = std::max({std::abs(rate[0]), std::abs(rate[1]), std::abs(rate[2])});
  return most > k_no_bound * size ? power : most;
}

// Returns the power of a friction element, W. A positive power is reduced by the part that rounding explains. A negative power is returned
// unchanged, because audited_power() needs it.
double pushing_power(const Snapshot& s, const System& system, std::size_t f, double met) {
  const FrictionPhase phase = s.evaluation->friction[f].phase;
  if (phase == FrictionPhase::free || phase == FrictionPhase::apart) return 0.0;
  const double power = power_of_friction(s, system, f);
  return power > 0.0 ? std::max(0.0, power - power_of_rounding(s, system, f, met)) : power;
}

double overload_of(const Snapshot& s, const System& system, std::size_t f) {
  const FrictionUnit& unit = system.frictions[f];
  const FrictionState& state = s.evaluation->friction[f];
  const double* wrench = s.friction_force + unit.row;
  const int n = unit.friction->dimension();
  // A step-lap joint knows its admissible set only while it sticks. While it slides, its slip law gives wrenches on the boundary.
  if (unit.friction->never_slips() || (n > 1 && state.phase == FrictionPhase::slip)) return 0.0;
  const bool is_bearing = std::any_of(wrench, wrench + n, [](double w) { return w != 0.0; });
  if (!is_bearing) return -1.0;
  if (state.phase == FrictionPhase::apart) return INFINITY;
  // `against` is a rate opposed to the force, for which support() returns the bound on the side of the force.
  double normal[3], against[3] = {n == 1 && wrench[0] > 0.0 ? -1.0 : 1.0, 0.0, 0.0};
  // If that bound is zero, the force must be negligible.
  if (!(unit.friction->support(*s.evaluation, state, against) > 0.0))
    return n == 1 ? std::abs(wrench[0]) / slight_force(system, *unit.friction->rows(state)) - 1.0 : 0.0;
  return unit.friction->gauge(*s.evaluation, state, wrench, normal) - 1.0;
}

// Returns true for friction whose wrench depends on the direction of slip (step-lap joints). A change of slip velocity by dν changes the
// wrench by up to |W| dν/|ν|.
bool may_turn(const FrictionUnit& unit) {
  return unit.friction->dimension() == 3 && unit.friction->is_rigid() && !unit.friction->never_slips();
}

// Returns the sum of the changes of all friction forces with may_turn(), N, if the slip velocities change by `rate`, m/s.
double turned_force(const Snapshot& s, const System& system, double rate) {
  double sum = 0.0;
  for (std::size_t f = 0; f < system.frictions.size(); ++f) {
    const FrictionUnit& unit = system.frictions[f];
    const FrictionState& state = s.evaluation->friction[f];
    if (!may_turn(unit) || state.phase != FrictionPhase::slip) continue;
    double slip[3];
    for (int i = 0; i < 3; ++i) slip[i] = evaluate_row<false>(unit.friction->rows(state)[i], s.motion).rate;
    const SlipScale scale = unit.friction->slip_scale(*s.evaluation, state, slip);
    const double* const wrench = s.friction_force + unit.row;
    const double force = portable::hypot(portable::hypot(wrench[0], wrench[1]), wrench[2] / scale.lever);
    if (std::isfinite(scale.speed) && scale.speed > 0.0) sum += force * rate / scale.speed;
  }
  return sum;
}

double largest_pull(const Snapshot& s, int count) {
  double pull = 0.0;
  for (int i = 0; i < count; ++i) pull = std::max(pull, -s.evaluation->contact_force[i]);
  return pull;
}

std::string element_of(const Channel& channel) {
  const std::size_t end = channel.name.rfind('.');
  return channel.name.substr(k_prefix.size(), end - k_prefix.size());
}

// Returns groups of one-dimensional friction elements that act between the same two bodies along the same line in the initial pose.
std::vector<std::vector<std::size_t>> frictions_on_one_line(const System& system) {
  const State start = system.initial_state();
  std::vector<Motion<double>> motion;
  place_bodies(start.q, start.v, motion);
  const auto is_one_line = [&](std::size_t f, std::size_t g) {
    const RowSpec &one = *system.frictions[f].friction->rows(start.friction[f]),
                  &other = *system.frictions[g].friction->rows(start.friction[g]);
    if (one.a != other.a || one.b != other.b || one.next || other.next) return false;
    const auto m = evaluate_row<false>(one, motion.data()), n = evaluate_row<false>(other, motion.data());
    const Pair<double> along_a = n.lever_a - m.lever_a, along_b = n.lever_b - m.lever_b;
    const double size = k_one_line * (1.0 + portable::hypot(m.lever_a.x, m.lever_a.y) + portable::hypot(n.lever_a.x, n.lever_a.y));
    return std::abs(cross(m.direction, n.direction)) <= k_one_line && std::abs(cross(along_a, m.direction)) <= size &&
           std::abs(cross(along_b, m.direction)) <= size && std::abs(m.couple) + std::abs(n.couple) == 0.0;
  };
  std::vector<std::vector<std::size_t>> groups;
  for (std::size_t f = 0; f < system.frictions.size(); ++f) {
    const FrictionElement& friction = *system.frictions[f].friction;
    if (friction.dimension() != 1 || friction.never_slips()) continue;
    const auto known = std::find_if(groups.begin(), groups.end(), [&](const auto& group) { return is_one_line(group.front(), f); });
    if (known == groups.end()) groups.push_back({f});
    else known->push_back(f);
  }
  std::erase_if(groups, [](const auto& group) { return group.size() < 2; });
  return groups;
}

double shares_of(const Snapshot& s, const std::vector<std::size_t>& group) {
  int loaded = 0, forward = 0, backward = 0;
  for (const std::size_t f : group) {
    const FrictionState& state = s.evaluation->friction[f];
    if (state.phase != FrictionPhase::stick && state.phase != FrictionPhase::slip) continue;
    ++loaded;
    if (state.phase == FrictionPhase::slip) ++(state.sign > 0 ? forward : backward);
  }
  return loaded < 2 || forward == loaded || backward == loaded ? 0.0 : 1.0;
}

double borne_together(const Snapshot& s, const System& system, const std::vector<std::size_t>& group) {
  const auto direction = [&](std::size_t f) {
    return evaluate_row<false>(*system.frictions[f].friction->rows(s.evaluation->friction[f]), s.motion).direction;
  };
  const Pair<double> along = direction(group.front());
  double sum = 0.0;
  for (const std::size_t f : group) sum += s.friction_force[system.frictions[f].row] * dot(along, direction(f));
  return sum;
}

// Adds a `shares` channel for each friction element on one line with others, and a channel with the sum of their forces.
void add_shared_channels(System& system) {
  const System* const self = &system;
  for (const std::vector<std::size_t>& group : frictions_on_one_line(system)) {
    std::string names;
    for (const std::size_t f : group) {
      const std::string& name = system.element_names[system.frictions[f].element];
      names += (names.empty() ? "shared: " : " + ") + name;
      system.channels.push_back(system.make_channel(k_prefix + name + k_shares, "", "1: its force is a share",
                                                    [group](const Snapshot& s) { return shares_of(s, group); }));
    }
    system.channels.push_back(system.make_channel(names, "N", "total of frictions along one line",
                                                  [self, group](const Snapshot& s) { return borne_together(s, *self, group); }));
  }
}

void keep_worst(std::vector<AuditFinding>& list, const AuditFinding& finding) {
  for (AuditFinding& known : list) {
    if (known.what != finding.what) continue;
    if (!(finding.ratio() <= known.ratio())) known = finding; // also if the ratio is not a number
    return;
  }
  list.push_back(finding);
}

double largest_force(const RunResult& run) {
  double force = 0.0;
  const Trajectory& t = *run.trajectory;
  for (std::size_t c = 0; c < t.channels().size(); ++c)
    for (std::size_t row = 0; t.channels()[c]->unit == "N" && row < t.size(); ++row) force = std::max(force, std::abs(t.value(row, c)));
  return force;
}

double kinetic_energy(const System& system, const Trajectory& t, std::size_t row, const std::vector<std::size_t>& rates) {
  double energy = 0.0;
  for (std::size_t b = 1; b < system.bodies.size(); ++b) {
    const BodyData& body = system.bodies[b];
    const double vx = t.value(row, rates[3 * b]), vy = t.value(row, rates[3 * b + 1]), w = t.value(row, rates[3 * b + 2]);
    energy += 0.5 * body.mass * (vx * vx + vy * vy) + 0.5 * body.inertia * w * w;
  }
  return energy;
}

const char* const k_rate_names[3] = {".vx", ".vy", ".omega"};
const char* const k_place_names[3] = {".x", ".y", ".theta"};

std::vector<std::size_t> columns(const System& system, const Trajectory& t, const char* const (&names)[3]) {
  std::vector<std::size_t> list(3 * system.bodies.size(), 0);
  for (std::size_t b = 1; b < system.bodies.size(); ++b)
    for (std::size_t i = 0; i < 3; ++i) list[3 * b + i] = t.column(system.bodies[b].name + names[i]);
  return list;
}

bool may_pull(const Model& model) {
  for (const ElementEntry& entry : model.elements)
    if (const Field* law = entry.kind->fields.find("law"))
      if (std::get<std::string>(law->get(entry.element.get())) == "literal") return true;
  return false;
}

} // namespace

// Adds the `unknown` channels. They are read sample by sample and have no extremes.
void add_unknown_channels(System& system, double met) {
  const auto scratch = std::make_shared<std::vector<PairJacobian>>();
  const System* const self = &system;
  const auto add = [&system](const char* what, const char* doc, std::function<double(const Snapshot&)> value) {
    system.channels.push_back(system.make_channel(k_prefix + what + k_unknown, "", doc, std::move(value)));
    system.channels.back().has_extremes = false;
  };
  add(k_forces, "what forces change by where places and velocities do by what they are known to, N",
      [=](const Snapshot& s) { return known_to(*self, s, met, *scratch).force + turned_force(s, *self, met); });
  add(k_velocities, "what velocities are known to, m/s", [=](const Snapshot& s) { return known_to(*self, s, met, *scratch).rate; });
  add(k_places, "what places are known to, m", [=](const Snapshot& s) { return position_accuracy(*self, s, met); });
}

void add_audit_channels(System& system, const Model& model) {
  System* self = &system;
  const double met = model.simulation.projection_tolerance;
  if (ActionGroup* const actions = action_group(system))
    actions->additions.push_back([](System& made) { add_audit_channels(made, *action_group(made)->model); });
  for (std::size_t f = 0; f < system.frictions.size(); ++f) {
    const std::string name = k_prefix + system.element_names[system.frictions[f].element];
    system.channels.push_back(system.make_channel(name + k_pushes, "W", "power that friction gives",
                                                  [self, f, met](const Snapshot& s) { return pushing_power(s, *self, f, met); }));
    system.channels.push_back(system.make_channel(name + k_overload, "", "share of its bound that friction takes, less 1",
                                                  [self, f](const Snapshot& s) { return overload_of(s, *self, f); }));
  }
  add_shared_channels(system);
  add_unknown_channels(system, met);
  if (may_pull(model)) return;
  system.channels.push_back(system.make_channel(k_prefix + "contacts.pull", "", "largest tension in a contact, N",
                                                [self](const Snapshot& s) { return largest_pull(s, self->contact_count); }));
}

std::string pushes_channel(const std::string& element) { return k_prefix + element + k_pushes; }
std::string shares_channel(const std::string& element) { return k_prefix + element + k_shares; }

UnknownColumns unknown_columns(const Trajectory& trajectory) {
  const auto column = [&trajectory](const char* what) { return trajectory.column(k_prefix + what + k_unknown); };
  return {column(k_forces), column(k_velocities), column(k_places)};
}

bool is_audit_channel(const Channel& channel) { return channel.name.compare(0, k_prefix.size(), k_prefix) == 0; }

double energy_scale(const System& system, const RunResult& run) {
  double size = 0.0;
  for (const BodyData& body : system.bodies)
    if (body.mass > 0.0) size = std::max(size, std::sqrt(body.inertia / body.mass));
  double scale = std::max(run.statistics.energy_exchanged, k_still * largest_force(run) * size);
  const Trajectory& t = *run.trajectory;
  const std::vector<std::size_t> rates = columns(system, t, k_rate_names);
  for (std::size_t row = 0; row < t.size(); ++row) scale = std::max(scale, kinetic_energy(system, t, row, rates));
  return scale;
}

double audited_power(const RunResult& run) {
  double most = 0.0;
  const Trajectory& t = *run.trajectory;
  for (std::size_t row = 0; row < t.size(); ++row) {
    double sum = 0.0;
    for (std::size_t c = 0; c < t.channels().size(); ++c)
      if (is_audit_channel(*t.channels()[c]) && t.channels()[c]->name.ends_with(k_pushes)) sum += std::abs(t.value(row, c));
    most = std::max(most, sum);
  }
  return most;
}

std::vector<AuditFinding> audit(const System& system, const RunResult& run, double share, int persistent) {
  std::vector<AuditFinding> findings;
  const Trajectory& t = *run.trajectory;
  if (t.size() < 2) return findings;
  const double duration = t.times().back() - t.times().front();
  const double power = energy_scale(system, run) / duration + 1e-300, force = largest_force(run) + 1e-300;
  for (std::size_t c = 0; c < t.channels().size(); ++c) {
    const Channel& channel = *t.channels()[c];
    if (!is_audit_channel(channel) || channel.name.ends_with(k_shares) || channel.name.ends_with(k_unknown)) continue;
    AuditFinding finding{"a contact pulls", element_of(channel), 0.0, 0.0, share * force};
    if (channel.name.ends_with(k_pushes)) finding = {"friction does positive work", element_of(channel), 0.0, 0.0, share * power};
    if (channel.name.ends_with(k_overload)) finding = {"friction exceeds its bound", element_of(channel), 0.0, 0.0, share};
    for (std::size_t row = 0; row < t.size(); ++row) {
      finding.t = t.times()[row];
      finding.value = t.value(row, c);
      for (int back = 1; back < persistent && finding.value > 0.0; ++back)
        finding.value = static_cast<std::size_t>(back) > row ? 0.0 : std::min(finding.value, t.value(row - back, c));
      keep_worst(findings, finding);
    }
  }
  return findings;
}

// --- momentum -------------------------------------------------------------------------------------

namespace {

class Groups {
public:
  explicit Groups(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0); }
  int root(int i) const { return parent_[i] == i ? i : root(parent_[i]); }
  void join(int a, int b) { parent_[root(a)] = root(b); }

private:
  std::vector<int> parent_;
};

// Returns the bodies that an element names, directly or by markers, and the ground if it names a single marker (a load).
std::vector<int> bodies_of(const ElementEntry& entry, const std::map<std::string, int>& body_index,
                           const std::map<std::string, int>& marker_body) {
  std::vector<int> bodies;
  for (const Field& field : entry.kind->fields.fields()) {
    if (field.name == "over" && field.type == FieldType::texts) { // bodies over which a rope runs
      const auto names = std::get<std::vector<std::string>>(field.get(entry.element.get()));
      for (const std::string& name : names)
        if (const auto found = marker_body.find(name); found != marker_body.end()) bodies.push_back(found->second);
    }
    if (field.type != FieldType::marker && field.type != FieldType::body) continue;
    const std::string name = std::get<std::string>(field.get(entry.element.get()));
    const auto& index = field.type == FieldType::body ? body_index : marker_body;
    if (const auto found = index.find(name); found != index.end()) bodies.push_back(found->second);
  }
  if (bodies.size() == 1) bodies.push_back(k_ground);
  return bodies;
}

} // namespace

std::vector<std::vector<int>> free_groups(const Model& model, const System& system) {
  std::map<std::string, int> body_index, marker_body; // fixed bodies are the ground
  for (const Body& body : model.bodies) body_index[body.name] = k_ground;
  for (std::size_t b = 1; b < system.bodies.size(); ++b) body_index[system.bodies[b].name] = static_cast<int>(b);
  marker_body["ground"] = k_ground;
  for (const Marker& marker : model.markers) marker_body[marker.name] = marker.body == "ground" ? k_ground : body_index[marker.body];
  Groups groups(system.bodies.size());
  for (const ElementEntry& entry : model.elements) {
    const std::vector<int> bodies = bodies_of(entry, body_index, marker_body);
    for (std::size_t i = 1; i < bodies.size(); ++i) groups.join(bodies[0], bodies[i]);
  }
  std::map<int, std::vector<int>> lists;
  for (int b = 1; b < system.body_count(); ++b)
    if (groups.root(b) != groups.root(k_ground)) lists[groups.root(b)].push_back(b);
  std::vector<std::vector<int>> result;
  for (auto& [root, list] : lists) result.push_back(std::move(list));
  return result;
}

namespace {

// Momentum minus the impulse of gravity, and angular momentum about the group's centre of gravity, of one group. `size` and `turn_size` are
// the sums of absolute values over the bodies, as scales. If all velocities have a rounding error ε, the errors are `mass` ε and `moment`
// ε.
struct Momentum {
  double x = 0.0, y = 0.0, turn = 0.0, size = 0.0, turn_size = 0.0;
  double mass = 0.0, moment = 0.0; ///< kg, kg m
};

Momentum momentum_of(const System& system, const std::vector<int>& group, const Trajectory& t, std::size_t row,
                     const std::vector<std::size_t>& places, const std::vector<std::size_t>& rates) {
  Momentum sum;
  double mass = 0.0, cx = 0.0, cy = 0.0;
  for (const int b : group) {
    const double m = system.bodies[b].mass;
    mass += m;
    cx += m * t.value(row, places[3 * b]);
    cy += m * t.value(row, places[3 * b + 1]);
    sum.x += m * t.value(row, rates[3 * b]);
    sum.y += m * t.value(row, rates[3 * b + 1]);
  }
  const double vx = sum.x / mass, vy = sum.y / mass;
  for (const int b : group) {
    const BodyData& body = system.bodies[b];
    const double rx = t.value(row, places[3 * b]) - cx / mass, ry = t.value(row, places[3 * b + 1]) - cy / mass;
    const double ux = t.value(row, rates[3 * b]) - vx, uy = t.value(row, rates[3 * b + 1]) - vy;
    const double spin = body.inertia * t.value(row, rates[3 * b + 2]);
    sum.turn += body.mass * (rx * uy - ry * ux) + spin;
    sum.turn_size += body.mass * portable::hypot(rx, ry) * portable::hypot(ux, uy) + std::abs(spin);
    sum.moment += body.mass * portable::hypot(rx, ry) + std::sqrt(body.mass * body.inertia);
    sum.size += body.mass * portable::hypot(t.value(row, rates[3 * b]), t.value(row, rates[3 * b + 1]));
  }
  sum.mass = mass;
  sum.x -= mass * system.gravity.x() * t.times()[row];
  sum.y -= mass * system.gravity.y() * t.times()[row];
  return sum;
}

} // namespace

AuditFinding momentum_change(const System& system, const std::vector<std::vector<int>>& groups, const RunResult& run) {
  AuditFinding worst{"momentum is not conserved", "", 0.0, 0.0, 1.0};
  const Trajectory& t = *run.trajectory;
  if (groups.empty() || t.size() < 2) return worst;
  const auto places = columns(system, t, k_place_names), rates = columns(system, t, k_rate_names);
  const std::size_t rate = unknown_columns(t).rate;
  for (const std::vector<int>& group : groups) {
    const Momentum first = momentum_of(system, group, t, 0, places, rates);
    double size = first.size, turn_size = first.turn_size;
    for (std::size_t row = 1; row < t.size(); ++row) {
      const Momentum now = momentum_of(system, group, t, row, places, rates);
      size = std::max(size, now.size);
      turn_size = std::max(turn_size, now.turn_size);
      const double known = t.value(row, rate);
      const double moved = portable::hypot(now.x - first.x, now.y - first.y) - known * now.mass;
      const double turned = std::abs(now.turn - first.turn) - known * now.moment;
      const double change = std::max(size > 0.0 ? moved / size : 0.0, turn_size > 0.0 ? turned / turn_size : 0.0);
      if (!(change <= worst.value)) {
        worst.where = system.bodies[group.front()].name;
        worst.t = t.times()[row];
        worst.value = change;
      }
    }
  }
  return worst;
}

} // namespace steplap
