#include "mbd/system/motion_formula.h"

#include "mbd/formula/formula.h"
#include "mbd/formula/unit_dimension.h"
#include "mbd/system/law_group.h"
#include "mbd/system/own_states.h"
#include "mbd/system/requested_channels.h"

#include <algorithm>
#include <stdexcept>

namespace steplap {

namespace {

constexpr int k_chunk = 8; // operands differentiated together
using Chunk = Dual<k_chunk>;

constexpr std::array<const char*, 6> k_coordinates = {"x", "y", "theta", "vx", "vy", "omega"};
constexpr std::array<const char*, 6> k_coordinate_units = {"m", "m", "rad", "m/s", "m/s", "rad/s"};

constexpr int k_deepest_channel = 32; // largest depth of nested formulas

} // namespace

const Signal& clock_signal() {
  static const Signal clock = [] {
    Signal::Piece piece;
    piece.c[1] = 1.0;
    return Signal({piece});
  }();
  return clock;
}

// Resolves names to operands and merges nested formulas into one tree.
class MotionFormula::Resolver {
public:
  Resolver(SystemBuilder& builder, const MotionFormulaText& asked, MotionFormula& made) : builder_(builder), asked_(asked), made_(made) {
    subject_ = "'" + asked.field + "'";
  }

  FormulaTree run() {
    const Formula formula(asked_.text, subject_, {});
    const TypedNode whole = add(formula);
    const bool is_zero =
        formula.tree().size() == 1 && formula.tree().front().op == FormulaOp::number && formula.tree().front().number == 0.0;
    const auto wanted = dimension_of(asked_.unit);
    if (wanted && !is_zero && whole.powers != wanted->powers) {
      const std::string is = unit_text(whole.powers);
      throw std::invalid_argument(subject_ + " has to be in '" + (asked_.unit.empty() ? "1" : asked_.unit) + "', and the formula has " +
                                  (is.empty() ? "no unit" : "the unit '" + is + "'") + ": numbers with units need quotes, '12 N'");
    }
    FormulaNode last;
    last.op = FormulaOp::finite;
    last.of = {whole.node, -1, -1};
    tree_.push_back(last);
    return std::move(tree_);
  }

private:
  struct TypedNode {
    int node = 0;
    std::array<double, 3> powers{};
  };

  TypedNode add(const Formula& formula) {
    std::vector<TypedNode> operands;
    std::vector<std::string> units;
    for (const std::string& name : formula.names()) {
      operands.push_back(operand(name));
      units.push_back(unit_text(operands.back().powers));
    }
    const UnitDimension dimension = formula.dimension(units);
    std::vector<int> place;
    for (FormulaNode node : formula.tree()) {
      for (int& of : node.of)
        if (of >= 0) of = place[static_cast<std::size_t>(of)];
      if (node.op == FormulaOp::operand) {
        place.push_back(operands[static_cast<std::size_t>(node.operand)].node);
        continue;
      }
      tree_.push_back(node);
      place.push_back(static_cast<int>(tree_.size()) - 1);
    }
    return {place.back(), dimension.powers};
  }

  static std::array<double, 3> dimension_exponents(const std::string& unit) {
    const auto known = dimension_of(unit);
    return known ? known->powers : std::array<double, 3>{};
  }

  TypedNode enter(const MotionOperand& operand, const std::array<double, 3>& powers) {
    FormulaNode node;
    node.op = FormulaOp::operand;
    node.operand = static_cast<int>(made_.operands_.size());
    made_.operands_.push_back(operand);
    tree_.push_back(node);
    return {static_cast<int>(tree_.size()) - 1, powers};
  }

  // Returns the operand for a name; the same name always gives the same operand.
  TypedNode operand(const std::string& name) {
    const auto known = std::find_if(names_.begin(), names_.end(), [&](const auto& entry) { return entry.first == name; });
    if (known != names_.end()) return known->second;
    const TypedNode made = find(name);
    names_.emplace_back(name, made);
    return made;
  }

  TypedNode find(const std::string& name) {
    MotionOperand operand;
    if (name == "value" && asked_.own_value != "-") return enter(operand, dimension_exponents(asked_.own_value));
    if (name == "rate" && asked_.own_rate != "-") {
      operand.kind = MotionOperand::Kind::own_rate;
      return enter(operand, dimension_exponents(asked_.own_rate));
    }
    constexpr std::string_view k_channel = ".value"; // suffix of a state's channel in `[[channel]]` formulas
    const OwnState* state = find_own_state(builder_.model(), name);
    if (!state && name.ends_with(k_channel)) state = find_own_state(builder_.model(), name.substr(0, name.size() - k_channel.size()));
    if (state) {
      operand.kind = MotionOperand::Kind::state;
      const StatePlace place = place_of_state(builder_, *state);
      operand.inner = place.inner;
      operand.unit = place.unit;
      return enter(operand, dimension_exponents(state->unit));
    }
    const Parameters& parameters = builder_.model().parameters;
    if (const auto parameter = parameters.find(name)) {
      FormulaNode node;
      node.number = parameters.values[*parameter];
      tree_.push_back(node);
      return {static_cast<int>(tree_.size()) - 1, parameters.entries[*parameter].powers};
    }
    const auto& signals = builder_.model().signals;
    if (std::any_of(signals.begin(), signals.end(), [&](const SignalEntry& signal) { return signal.definition->name == name; })) {
      operand.kind = MotionOperand::Kind::signal;
      operand.signal = builder_.signal(name);
      return enter(operand, {});
    }
    return find_moving(name);
  }

  TypedNode find_moving(const std::string& name) {
    const Model& model = builder_.model();
    const std::size_t point = name.rfind('.');
    const std::string owner = name.substr(0, point), part = point == std::string::npos ? "" : name.substr(point + 1);
    const auto coordinate = static_cast<int>(std::find(k_coordinates.begin(), k_coordinates.end(), part) - k_coordinates.begin());
    if (coordinate < 6) {
      const std::array<double, 3> powers = dimension_exponents(k_coordinate_units[static_cast<std::size_t>(coordinate)]);
      if (const Body* const body = model.find_body(owner); body && !body->fixed) return of_body(builder_.body(owner), coordinate, powers);
      const bool is_marker = std::any_of(model.markers.begin(), model.markers.end(), [&](const Marker& m) { return m.name == owner; });
      if (is_marker && part.size() <= 2) return of_marker(builder_.marker(owner), coordinate, powers);
    }
    for (const DefinedChannel& channel : model.channels)
      if (channel.name == name) return of_channel(channel);
    if (const Channel* const channel = RequestedChannels::made_channel(builder_, name)) return of_measure(*channel);
    throw std::invalid_argument(
        subject_ + ": there is no '" + name + "'" + did_you_mean(name, all_names()) +
        "; a formula here may hold places, angles and velocities of bodies, markers and measures, states, parameters and t");
  }

  TypedNode of_body(int body, int coordinate, const std::array<double, 3>& powers) {
    MotionOperand operand;
    operand.kind = MotionOperand::Kind::coordinate;
    operand.body = body;
    operand.coordinate = coordinate;
    return enter(operand, powers);
  }

  TypedNode of_marker(const CompiledMarker& marker, int coordinate, const std::array<double, 3>& powers) {
    MotionOperand operand;
    operand.kind = MotionOperand::Kind::measure;
    operand.row = row_of(marker.body, k_ground, AxisMeasure{marker.point, Vec2::Zero(), Vec2::Unit(coordinate % 3)});
    operand.is_rate = coordinate >= 3;
    return enter(operand, powers);
  }

  TypedNode of_measure(const Channel& channel) {
    const MeasuredValue* const measured = measured_by(channel);
    if (!measured)
      throw std::invalid_argument(subject_ + ": '" + channel.name +
                                  "' is no place, angle or velocity that follows from the motion alone, so no force can depend on it; " +
                                  "name the places or velocities that it comes from");
    MotionOperand operand;
    operand.kind = MotionOperand::Kind::measure;
    operand.row = measured->measure;
    operand.zero = measured->zero;
    operand.is_rate = measured->is_rate;
    return enter(operand, dimension_exponents(channel.unit));
  }

  TypedNode of_channel(const DefinedChannel& channel) {
    if (depth_ == k_deepest_channel) throw std::invalid_argument(subject_ + ": channel '" + channel.name + "' leads back to itself");
    ++depth_;
    const TypedNode made = add(Formula(channel.expression, "channel '" + channel.name + "'", channel.place("expression")));
    --depth_;
    return made;
  }

  [[nodiscard]] std::vector<std::string> all_names() const {
    const Model& model = builder_.model();
    std::vector<std::string> names;
    if (asked_.own_value != "-") names.emplace_back("value");
    if (asked_.own_rate != "-") names.emplace_back("rate");
    for (const OwnState* state : own_states(model)) names.push_back(state->name);
    for (const Parameter& parameter : model.parameters.entries) names.push_back(parameter.name);
    for (const SignalEntry& signal : model.signals) names.push_back(signal.definition->name);
    for (const DefinedChannel& channel : model.channels) names.push_back(channel.name);
    for (const Body& body : model.bodies)
      for (const char* part : k_coordinates) names.push_back(body.name + "." + part);
    for (const Marker& marker : model.markers)
      for (const char* part : {"x", "y", "vx", "vy"}) names.push_back(marker.name + "." + part);
    for (const std::string& name : RequestedChannels::measured_names(builder_)) names.push_back(name);
    return names;
  }

  SystemBuilder& builder_;
  const MotionFormulaText& asked_;
  MotionFormula& made_;
  std::string subject_;
  FormulaTree tree_;
  std::vector<std::pair<std::string, TypedNode>> names_;
  int depth_ = 0;
};

MotionFormula::MotionFormula(SystemBuilder& builder, const MotionFormulaText& text) {
  FormulaTree tree;
  try {
    tree = Resolver(builder, text, *this).run();
  } catch (const ModelError& error) { // the error belongs to a formula, which has no location other than that of its element
    builder.error(error.diagnostics().front().message);
    return;
  } catch (const std::invalid_argument& error) {
    builder.error(error.what());
    return;
  }
  try {
    programs_.emplace_back(tree);
    tree_ = std::move(tree);
  } catch (const std::invalid_argument& error) {
    builder.error("'" + text.field + "' " + error.what());
    return;
  }
  const auto note = [this](int body) {
    if (body != k_ground && std::find(bodies_.begin(), bodies_.end(), body) == bodies_.end()) bodies_.push_back(body);
  };
  for (const MotionOperand& operand : operands_) {
    if (operand.kind == MotionOperand::Kind::coordinate) note(operand.body);
    if (operand.kind != MotionOperand::Kind::measure) continue;
    note(operand.row.a);
    note(operand.row.b);
  }
}

void MotionFormula::find_bits(const Evaluation& e, const OwnCoordinate<double>& own, FormulaProgram::Bits& bits) const {
  auto& room = motion_formula::Room<double>::kept();
  room.grow(operands_.size(), static_cast<std::size_t>(program().size()));
  read(e, own, NumericSignalEvaluator{e.t}, room.operands.data());
  (void)program().find_bits(room.operands.data(), e.t, bits, room.values.data());
}

double MotionFormula::differentiate(const Evaluation& e, const OwnCoordinate<double>& own, SwitchBits bits, double* derivatives) const {
  auto& room = motion_formula::Room<double>::kept();
  auto& duals = motion_formula::Room<Chunk>::kept();
  room.grow(operands_.size(), 1);
  duals.grow(operands_.size(), static_cast<std::size_t>(program().size()));
  read(e, own, NumericSignalEvaluator{e.t}, room.operands.data());
  double value = 0.0;
  const std::size_t count = operands_.size();
  for (std::size_t first = 0; first == 0 || first < count; first += k_chunk) {
    for (std::size_t i = 0; i < count; ++i) {
      duals.operands[i] = Chunk(room.operands[i]);
      if (i >= first && i < first + k_chunk) duals.operands[i].d[static_cast<Eigen::Index>(i - first)] = 1.0;
    }
    const Chunk f = program().evaluate(duals.operands.data(), Chunk(e.t), bits, duals.values.data(), static_cast<Chunk*>(nullptr));
    value = f.v;
    for (std::size_t i = first; i < std::min(count, first + k_chunk); ++i) derivatives[i] = f.d[static_cast<Eigen::Index>(i - first)];
  }
  return value;
}

std::vector<double> MotionFormula::gains(const Evaluation& e, const OwnCoordinate<double>& own, SwitchBits bits) const {
  auto& room = motion_formula::Room<double>::kept();
  auto& duals = motion_formula::Room<Chunk>::kept();
  room.grow(operands_.size(), 1);
  duals.grow(operands_.size(), static_cast<std::size_t>(program().size()));
  read(e, own, NumericSignalEvaluator{e.t}, room.operands.data());
  std::vector<double> gains(static_cast<std::size_t>(program().switch_count()), 0.0);
  std::vector<Chunk> quantity(gains.size());
  for (std::size_t k = 0; k < operands_.size(); ++k) {
    if (operands_[k].kind == MotionOperand::Kind::state || operands_[k].kind == MotionOperand::Kind::signal) continue;
    for (std::size_t i = 0; i < operands_.size(); ++i) duals.operands[i] = Chunk(room.operands[i]);
    duals.operands[k].d[0] = 1.0;
    (void)program().evaluate(duals.operands.data(), Chunk(e.t), bits, duals.values.data(), quantity.data());
    for (std::size_t s = 0; s < gains.size(); ++s)
      if (std::isfinite(quantity[s].d[0])) gains[s] += std::abs(quantity[s].d[0]);
  }
  return gains;
}

std::array<MotionShare, 2> shares_of(const MotionOperand& operand, const Evaluation& e, const OwnCoordinate<Dual<12>>& own, int own_a,
                                     int own_b) {
  std::array<MotionShare, 2> shares;
  const auto take = [&shares](const Dual<12>& value, int a, int b) {
    for (int side = 0; side < 2; ++side) {
      MotionShare& share = shares[static_cast<std::size_t>(side)];
      share.body = side == 0 ? a : b;
      share.pose = value.d.segment<3>(3 * side).matrix();
      share.velocity = value.d.segment<3>(6 + 3 * side).matrix();
    }
  };
  switch (operand.kind) {
  case MotionOperand::Kind::own_value: take(own.value, own_a, own_b); break;
  case MotionOperand::Kind::own_rate: take(own.rate, own_a, own_b); break;
  case MotionOperand::Kind::coordinate: {
    MotionShare& share = shares[0];
    share.body = operand.body;
    (operand.coordinate < 3 ? share.pose : share.velocity)[operand.coordinate % 3] = 1.0;
    break;
  }
  case MotionOperand::Kind::measure: {
    const RowSpec& row = operand.row;
    const MeasureValue<Dual<12>> m = evaluate_row<false>(row, seeded(e.motion[row.a], 0), seeded(e.motion[row.b], 3));
    take(operand.is_rate ? m.rate : m.value, row.a, row.b);
    break;
  }
  case MotionOperand::Kind::state:
  case MotionOperand::Kind::signal: break;
  }
  return shares;
}

SwitchBits next_bits(const MotionFormula& formula, SwitchBits bits, int slot, const Evaluation& e, const OwnCoordinate<double>& own) {
  const FormulaProgram& program = formula.program();
  FormulaProgram::Bits next{bits ^ (SwitchBits{1} << static_cast<unsigned>(slot)), program.counting(bits)};
  formula.find_bits(e, own, next);
  return next.values;
}

std::vector<SwitchScale> scales_of(const MotionFormula& formula, const Evaluation& e, const OwnCoordinate<double>& own) {
  const FormulaProgram& program = formula.program();
  FormulaProgram::Bits bits{0, 0};
  formula.find_bits(e, own, bits);
  const std::vector<double> gains = formula.gains(e, own, bits.values);
  // Numbers that have underflowed, such as exp(−800), have only a few digits left, and their differences change sign at random.
  constexpr double k_underflow = 1e-290;
  std::vector<SwitchScale> scales(gains.size(), {1.0, k_underflow});
  for (std::size_t s = 0; s < gains.size(); ++s)
    if (gains[s] > k_underflow && !program.is_comparison(static_cast<int>(s))) scales[s] = {1.0 / gains[s], k_met};
  return scales;
}

void MotionFormula::register_turns(TurnTable& turns) const {
  constexpr int k_angle = 2; // index of the angle among a body's coordinates
  const bool is_linear = !is_valid() || program().is_linear();
  for (const MotionOperand& operand : operands_) {
    if (operand.kind == MotionOperand::Kind::coordinate && operand.coordinate == k_angle && !is_linear) turns.add(operand.body, k_ground);
    if (operand.kind != MotionOperand::Kind::measure) continue;
    turns.add(operand.row.a, operand.row.b, turning_of(operand.row));
    if (operand.row.kind == MeasureKind::angle && !is_linear) turns.add(operand.row.a, operand.row.b);
  }
}

} // namespace steplap
