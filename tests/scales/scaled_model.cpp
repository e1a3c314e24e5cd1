#include "tests/scales/scaled_model.h"

#include "mbd/base/name_pattern.h"
#include "mbd/base/number_text.h"
#include "mbd/formula/unit_dimension.h"
#include "mbd/model/field_units.h"
#include "mbd/model/signal_network.h"

#include <cmath>
#include <map>
#include <stdexcept>

namespace steplap::testing {

namespace {

// A signal that is known already.
struct Ready : SignalDefinition {
  Signal signal;
};

const SignalKind& ready_kind() {
  static const SignalKind kind = [] {
    SignalKind k;
    k.name = "ready";
    k.holds<Ready>();
    k.build = [](const SignalDefinition& definition) { return static_cast<const Ready&>(definition).signal; };
    return k;
  }();
  return kind;
}

Signal scaled_signal(const Signal& signal, double value, double time) {
  std::vector<Signal::Piece> pieces = signal.pieces();
  for (Signal::Piece& piece : pieces) {
    piece.start *= time;
    double power = value;
    for (double& c : piece.c) {
      c *= power;
      power /= time;
    }
    for (Signal::Harmonic& h : piece.harmonics) {
      h.amplitude *= value;
      h.frequency /= time;
    }
    for (Signal::Modulated& m : piece.modulated) {
      m.amplitude *= value * std::pow(time, -m.power);
      m.frequency /= time;
    }
  }
  return pieces.empty() ? signal : Signal(std::move(pieces));
}

class Scaler {
public:
  Scaler(const Model& model, const Scaling& by) : given_(model), by_(by), signals_(model) {}

  Model scaled(const System& system) {
    Model model = given_;
    scale(ModelHeader::fields(), &model.header);
    scale(SimulationSettings::fields(), &model.simulation);
    scale(OutputSettings::fields(), &model.output);
    for (Body& body : model.bodies) scale(Body::fields(), &body);
    for (Marker& marker : model.markers) scale(Marker::fields(), &marker);
    for (ElementEntry& entry : model.elements) {
      scale(entry.kind->fields, entry.element.get());
      scale_by_exponent(entry.kind->fields, entry.element.get());
    }
    model.signals = std::move(made_);
    for (Criterion& criterion : model.criteria) scale(criterion, system);
    return model;
  }

private:
  void scale(const FieldTable& table, void* object) {
    for (const Field& field : table.fields()) {
      FieldValue value = field.get(object);
      const std::string unit = unit_in(table, field, object);
      if (field.type == FieldType::signal) {
        const std::string name = std::get<std::string>(value);
        if (!name.empty()) field.set(object, signal_in(name, unit));
        continue;
      }
      if (unit.empty()) continue;
      const double x = by_.factor(unit), y = field.unit2.empty() ? x : by_.factor(field.unit2);
      if (multiply(value, x, y)) field.set(object, value);
    }
  }

  // False for an optional field that is not given.
  static bool multiply(FieldValue& value, double x, double y) {
    if (std::holds_alternative<std::string>(value)) return false;
    if (auto* number = std::get_if<double>(&value)) *number *= x;
    else if (auto* numbers = std::get_if<std::vector<double>>(&value))
      for (double& n : *numbers) n *= x;
    else if (auto* point = std::get_if<Vec2>(&value)) *point = Vec2(point->x() * x, point->y() * y);
    else if (auto* points = std::get_if<std::vector<Vec2>>(&value))
      for (Vec2& p : *points) p = Vec2(p.x() * x, p.y() * y);
    else if (auto* rings = std::get_if<std::vector<std::vector<Vec2>>>(&value)) {
      for (std::vector<Vec2>& ring : *rings)
        for (Vec2& p : ring) p = Vec2(p.x() * x, p.y() * y);
    } else throw std::invalid_argument("a field with a unit that holds no numbers");
    return true;
  }

  // The stiffness of a force that grows with a power n of the depth is in N/mⁿ.
  void scale_by_exponent(const FieldTable& table, void* object) const {
    const Field *const exponent = table.find("exponent"), *const stiffness = table.find("stiffness"), *const law = table.find("law");
    if (!exponent || !stiffness || !law || std::get<std::string>(law->get(object)) != "hunt_crossley") return;
    const double n = std::get<double>(exponent->get(object));
    stiffness->set(object, std::get<double>(stiffness->get(object)) * std::pow(by_.length, 1.0 - n));
  }

  std::string signal_in(const std::string& name, const std::string& unit) {
    const std::string known = name + " in " + unit;
    if (names_.contains(known)) return known;
    const Signal* const signal = signals_.build(name);
    if (!signal) throw std::invalid_argument("no signal '" + name + "'");
    auto definition = std::make_shared<Ready>();
    definition->name = known;
    definition->signal = scaled_signal(*signal, by_.factor(unit), by_.time);
    made_.emplace_back(&ready_kind(), definition);
    names_[known] = true;
    return known;
  }

  void scale(Criterion& criterion, const System& system) const {
    for (const Channel& channel : system.channels) {
      if (criterion.channel.empty() || !matches_pattern(channel.name, criterion.channel)) continue;
      const double factor = by_.factor(channel.unit);
      for (std::optional<double>* limit : {&criterion.at_least, &criterion.at_most, &criterion.within})
        if (*limit) **limit *= factor;
      return;
    }
  }

  const Model& given_;
  Scaling by_;
  SignalNetwork signals_;
  std::vector<SignalEntry> made_;
  std::map<std::string, bool> names_;
};

} // namespace

double Scaling::factor(const std::string& unit) const {
  if (unit == "Hz") return 1.0 / time;
  const std::optional<UnitDimension> dimension = dimension_of(unit);
  if (!dimension) throw std::invalid_argument("unit '" + unit + "' is not known");
  double product = 1.0;
  const double bases[] = {mass, length, time};
  for (std::size_t k = 0; k < 3; ++k) {
    const double power = dimension->powers[k];
    for (int i = 0; i < std::abs(static_cast<int>(power)); ++i) product = power > 0.0 ? product * bases[k] : product / bases[k];
  }
  return product;
}

std::string Scaling::text() const {
  return "lengths × " + number_text(length) + ", times × " + number_text(time) + ", masses × " + number_text(mass);
}

Model scaled(const Model& model, const System& system, const Scaling& by) { return Scaler(model, by).scaled(system); }

} // namespace steplap::testing
