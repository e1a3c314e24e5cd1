#include "mbd/simulation/channel_rates.h"

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>

namespace steplap {

std::vector<int> rates_of(const System& system) {
  static constexpr std::array<std::pair<const char*, const char*>, 6> k_rates = {
      {{".x", ".vx"}, {".y", ".vy"}, {".theta", ".omega"}, {".vx", ".ax"}, {".vy", ".ay"}, {".omega", ".alpha"}}};
  static constexpr std::array<std::pair<const char*, const char*>, 6> k_requested = {
      {{".x", ".vx"}, {".y", ".vy"}, {".vx", ".ax"}, {".vy", ".ay"}, {".angle", ".rate"}, {".displacement", ".rate"}}};
  const auto is_motion = [](std::string_view name) {
    const auto ends_it = [name](const auto& pair) { return name.ends_with(pair.first) || name.ends_with(pair.second); };
    return std::any_of(k_rates.begin(), k_rates.end(), ends_it) || std::any_of(k_requested.begin(), k_requested.end(), ends_it);
  };
  std::vector<int> rates(system.channels.size(), -1);
  if (std::none_of(system.channels.begin(), system.channels.end(), [](const Channel& channel) { return channel.has_extremes; }))
    return rates;
  std::unordered_map<std::string_view, int> place;
  for (std::size_t c = 0; c < system.channels.size(); ++c)
    if (is_motion(system.channels[c].name)) place.emplace(system.channels[c].name, static_cast<int>(c));
  std::string asked;
  const auto find = [&](std::string_view of, std::string_view value) {
    asked.assign(of).append(value);
    return place.find(asked);
  };
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
