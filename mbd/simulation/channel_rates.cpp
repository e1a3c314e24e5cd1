#include "mbd/simulation/channel_rates.h"

#include <array>
#include <map>
#include <string_view>
#include <utility>

namespace steplap {

std::vector<int> rates_of(const System& system) {
  static constexpr std::array<std::pair<const char*, const char*>, 6> k_rates = {
      {{".x", ".vx"}, {".y", ".vy"}, {".theta", ".omega"}, {".vx", ".ax"}, {".vy", ".ay"}, {".omega", ".alpha"}}};
  static constexpr std::array<std::pair<const char*, const char*>, 6> k_requested = {
      {{".x", ".vx"}, {".y", ".vy"}, {".vx", ".ax"}, {".vy", ".ay"}, {".angle", ".rate"}, {".displacement", ".rate"}}};
  std::map<std::string, int> place;
  for (std::size_t c = 0; c < system.channels.size(); ++c) place[system.channels[c].name] = static_cast<int>(c);
  std::vector<int> rates(system.channels.size(), -1);
  for (const BodyData& body : system.bodies)
    for (const auto& [value, rate] : k_rates) {
      const auto of = place.find(body.name + value), its = place.find(body.name + rate);
      if (of != place.end() && its != place.end()) rates[of->second] = its->second;
    }
  for (std::size_t c = 0; c < system.channels.size(); ++c) {
    const std::string& name = system.channels[c].name;
    if (!system.channels[c].is_on_request) continue;
    for (const auto& [value, rate] : k_requested)
      if (name.ends_with(value))
        if (const auto its = place.find(name.substr(0, name.size() - std::string_view(value).size()) + rate); its != place.end())
          rates[c] = its->second;
  }
  return rates;
}

} // namespace steplap
