#include "mbd/model/signal_composites.h"

#include "mbd/model/signal_algebra.h"

namespace steplap {

namespace {

struct Sum : SignalDefinition {
  std::vector<std::string> signals;
  std::vector<double> factors;
};

struct Product : SignalDefinition {
  std::vector<std::string> signals;
};

struct Scaled : SignalDefinition {
  std::string signal;
  double factor = 1.0;
  double offset = 0.0;
  double delay = 0.0;                  // s
  std::optional<double> behind, speed; // m, m/s
};

using Parts = std::vector<const Signal*>;

void check_any(const Parts& parts, const SignalDefinition& definition, const std::string& kind) {
  if (parts.empty()) throw ModelError(definition.where, kind + " '" + definition.name + "': 'signals' names none: give at least one");
}

Signal build_sum(const SignalDefinition& definition, const Parts& parts) {
  const auto& sum = static_cast<const Sum&>(definition);
  check_any(parts, sum, "sum");
  if (!sum.factors.empty() && sum.factors.size() != parts.size())
    throw ModelError(sum.where, "sum '" + sum.name + "': 'factors' must be as many as 'signals', " + std::to_string(parts.size()) +
                                    ", got " + std::to_string(sum.factors.size()));
  return sum_of(parts, sum.factors.empty() ? std::vector<double>(parts.size(), 1.0) : sum.factors);
}

Signal build_product(const SignalDefinition& definition, const Parts& parts) {
  check_any(parts, definition, "product");
  return product_of(parts);
}

Signal build_scaled(const SignalDefinition& definition, const Parts& parts) {
  const auto& scaled = static_cast<const Scaled&>(definition);
  if (scaled.behind && !scaled.speed)
    throw ModelError(scaled.where,
                     "scaled '" + scaled.name + "': 'behind' needs a speed: give 'speed', or a 'signal' that has one, as a road has");
  const double delay = scaled.delay + (scaled.behind ? *scaled.behind / *scaled.speed : 0.0);
  if (scaled.offset == 0.0) return delayed(*parts.at(0), delay, scaled.factor);
  const Signal later = delayed(*parts.at(0), delay), one = Signal::constant(1.0);
  return sum_of({&later, &one}, {scaled.factor, scaled.offset});
}

template <class T>
SignalKind kind_of(const std::string& name, const std::string& doc, Signal (*combine)(const SignalDefinition&, const Parts&)) {
  SignalKind kind;
  kind.name = name;
  kind.doc = doc;
  kind.holds<T>();
  kind.combine = combine;
  return kind;
}

} // namespace

const SignalKind& sum_kind() {
  static const SignalKind kind = [] {
    SignalKind k = kind_of<Sum>("sum", "Sum of other signals, each times its factor.", build_sum);
    k.fields.add("signals", &Sum::signals).as(FieldType::signals).required().doc("signals that are added");
    k.fields.add("factors", &Sum::factors).in("*").doc("one per signal; all 1 if not given");
    return k;
  }();
  return kind;
}

std::optional<std::vector<std::string>> summands_of(const SignalEntry& entry) {
  if (entry.kind != &sum_kind()) return std::nullopt;
  const auto& sum = static_cast<const Sum&>(*entry.definition);
  std::vector<std::string> names;
  for (std::size_t i = 0; i < sum.signals.size(); ++i)
    if (i >= sum.factors.size() || sum.factors[i] != 0.0) names.push_back(sum.signals[i]);
  return names;
}

const SignalKind& product_kind() {
  static const SignalKind kind = [] {
    SignalKind k = kind_of<Product>("product",
                                    "Product of other signals, as a wave and its envelope; the same signal may stand "
                                    "there twice. Zero where one of them is.",
                                    build_product);
    k.fields.add("signals", &Product::signals).as(FieldType::signals).required().doc("signals that are multiplied");
    return k;
  }();
  return kind;
}

const SignalKind& scaled_kind() {
  static const SignalKind kind = [] {
    SignalKind k = kind_of<Scaled>("scaled", "Another signal at another scale: offset + factor signal(t - delay).", build_scaled);
    k.fields.add("signal", &Scaled::signal).as(FieldType::signal).required().doc("signal that is scaled");
    k.fields.add("factor", &Scaled::factor).in("*").doc("factor on its values; -1 turns the sign");
    k.fields.add("offset", &Scaled::offset).in("*").doc("added to its values, from t = 0 on");
    k.fields.add("delay", &Scaled::delay).in("s").doc("by which it comes later (negative: earlier); a constant begins at t = delay");
    k.fields.add("behind", &Scaled::behind)
        .in("m")
        .doc("way by which it comes later, at its speed: from the first axle on a road to this one");
    k.fields.add("speed", &Scaled::speed).in("m/s").positive().doc("at which that way is made; that of the signal if not given");
    return k;
  }();
  return kind;
}

} // namespace steplap
