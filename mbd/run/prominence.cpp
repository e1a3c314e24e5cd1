#include "mbd/run/prominence.h"

namespace steplap {

namespace {

// Returns "force" for "front foot.force".
std::string last_part(const std::string& channel) { return channel.substr(channel.rfind('.') + 1); }

} // namespace

bool is_reaction(const std::string& name, const std::string& unit) {
  const bool is_load = unit == "N" || unit == "N m" || unit == "Pa";
  return is_load && last_part(name) != "capacity";
}

bool is_reaction(const Channel& channel) { return is_reaction(channel.name, channel.unit); }

bool is_slide(const std::string& name) {
  const std::string part = last_part(name);
  return part == "slide" || part.rfind("slide_", 0) == 0;
}

bool is_slide(const Channel& channel) { return is_slide(channel.name); }

bool is_main_event(const Event& event) { return is_main(event.kind); }

} // namespace steplap
