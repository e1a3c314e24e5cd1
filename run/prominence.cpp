#include "run/prominence.h"

#include <string>

namespace steplap {

namespace {

// "front foot.force" -> "force"
std::string last_part(const std::string& channel) {
  return channel.substr(channel.rfind('.') + 1);
}

} // namespace

bool is_reaction(const Channel& channel) {
  const bool is_load = channel.unit == "N" || channel.unit == "N m" || channel.unit == "Pa";
  return is_load && last_part(channel.name) != "capacity";
}

bool is_slide(const Channel& channel) {
  const std::string part = last_part(channel.name);
  return part == "slide" || part.rfind("slide_", 0) == 0;
}

bool is_main_event(const Event& event) {
  return is_main(event.kind);
}

} // namespace steplap
