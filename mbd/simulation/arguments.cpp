#include "mbd/simulation/arguments.h"

#include "mbd/base/number_text.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace steplap {

namespace {

void require(bool is_met, const std::string& what, double value, const std::string& wanted) {
  if (!is_met) throw std::invalid_argument(what + " is " + number_text(value) + ", but must be " + wanted);
}

void require_not_negative(double value, const std::string& what) {
  require(std::isfinite(value) && value >= 0.0, what, value, "finite and not negative");
}

void require_size(std::size_t size, std::size_t wanted, const std::string& what) {
  if (size != wanted)
    throw std::invalid_argument("the state has " + std::to_string(size) + " " + what + ", the system " + std::to_string(wanted) +
                                ": begin with System::initial_state()");
}

void require_finite(const std::vector<double>& values, const std::string& what) {
  const auto bad = std::find_if(values.begin(), values.end(), [](double x) { return !std::isfinite(x); });
  if (bad != values.end())
    throw std::invalid_argument("number " + std::to_string(bad - values.begin()) + " of the state's " + what + " is not finite");
}

// Returns both members of all entries as one vector: first and second of entry 0, then of entry 1, and so on.
template <class T> std::vector<double> numbers_of(const std::vector<T>& entries, double T::*first, double T::*second) {
  std::vector<double> numbers;
  for (const T& entry : entries) numbers.insert(numbers.end(), {entry.*first, entry.*second});
  return numbers;
}

} // namespace

SimulationOptions checked(SimulationOptions options, double start) {
  require(std::isfinite(options.end) && options.end >= start, "SimulationOptions::end", options.end, "finite and not before the start");
  require_not_negative(options.output_step, "SimulationOptions::output_step");
  require(std::isfinite(options.storm_step) && options.storm_step > 0.0, "SimulationOptions::storm_step", options.storm_step, "positive");
  require(options.max_events > 0, "SimulationOptions::max_events", static_cast<double>(options.max_events), "positive");
  const IntegratorSettings& settings = options.settings;
  require(std::isfinite(settings.tolerance) && settings.tolerance > 0.0, "IntegratorSettings::tolerance", settings.tolerance, "positive");
  require_not_negative(settings.step, "IntegratorSettings::step");
  require_not_negative(settings.max_step, "IntegratorSettings::max_step");
  require_not_negative(settings.projection_tolerance, "IntegratorSettings::projection_tolerance");
  return options;
}

const State& checked(const State& state, const System& system) {
  require_size(state.q.size(), 3 * system.bodies.size(), "coordinates");
  require_size(state.v.size(), 3 * system.bodies.size(), "velocities");
  require_size(state.mode.size(), system.units.size(), "modes");
  require_size(state.friction.size(), system.frictions.size(), "friction states");
  require_size(state.bases.size(), system.initial_bases.size(), "bases of rows");
  require_size(state.impacts.size(), system.initial_impacts.size(), "impacts");
  require_size(state.inner.size(), system.initial_inner.size(), "inner states");
  if (!std::isfinite(state.t)) throw std::invalid_argument("the state's time is not finite");
  require_finite(state.q, "coordinates");
  require_finite(state.v, "velocities");
  require_finite(numbers_of(state.bases, &RowBase::value, &RowBase::rate), "bases of rows");
  require_finite(numbers_of(state.impacts, &Impact::impulse, &Impact::lost), "impacts");
  require_finite(state.inner, "inner states");
  return state;
}

} // namespace steplap
