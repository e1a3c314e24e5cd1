#include "mbd/simulation/channel_rates.h"

#include <array>
#include <map>
#include <string>
#include <string_view>
#include <utility>

namespace steplap {

std::vector<int> rates_of(const System& system) {
  static constexpr std::array<std::pair<const char*, const char*>, 6> k_rates = {
      {{".x", ".vx"}, {".y", ".vy"}, {".theta", ".omega"}, {".vx", ".ax"}, {".vy", ".ay"}, {".omega", ".alpha"}}};
  static constexpr std::array<std::pair<const char*, const char*>, 6> k_requested = {
      {{".x", ".vx"}, {".y", ".vy"}, {".vx", ".ax"}, {".vy", ".ay"}, {".angle", ".rate"}, {".displacement", ".rate"}}};
  std::map<std::string_view, int> place;
  for (std::size_t c = 0; c < system.channels.size(); ++c) place[system.channels[c].name] = static_cast<int>(c);
  std::string asked;
  const auto find = [&](std::string_view of, std::string_view value) {
    asked.assign(of).append(value);
    return place.find(asked);
  };
  std::vector<int> rates(system.channels.size(), -1);
  for (const BodyData& body : system.bodies)
    for (const auto& [value, rate] : k_rates) {
      const auto of = find(body.name, value);
      if (of == place.end()) continue;
      const auto its = find(body.name, rate);
      if (its != place.end()) rates[of->second] = its->second;
    }
  for (std::size_t c = 0; c < system.channels.size(); ++c) {
    const std::string& name = system.channels[c].name;
    if (!system.channels[c].is_on_request) continue;
    for (const auto& [value, rate] : k_requested)
      if (name.ends_with(value))
        if (const auto its = find(std::string_view(name).substr(0, name.size() - std::string_view(value).size()), rate); its != place.end())
          rates[c] = its->second;
  }
  return rates;
}

} // namespace steplap
