// Tables of a model file in one line each: fields are separated by semicolons, names stand in 'quotes'.
//   body("ball", "mass = 2; inertia = 0.008") + element("revolute", "pin", "a = 'ball'")
#pragma once

#include <algorithm>
#include <string>

namespace steplap::testing {

inline std::string table_text(const std::string& array, const std::string& head, std::string fields) {
  std::replace(fields.begin(), fields.end(), ';', '\n');
  return "[[" + array + "]]\n" + head + fields + "\n";
}

inline std::string body(const std::string& name, const std::string& fields) {
  return table_text("body", "name = \"" + name + "\"\n", fields);
}

inline std::string element(const std::string& kind, const std::string& name, const std::string& fields) {
  return table_text("element", "kind = \"" + kind + "\"\nname = \"" + name + "\"\n", fields);
}

inline std::string signal_entry(const std::string& kind, const std::string& name, const std::string& fields) {
  return table_text("signal", "kind = \"" + kind + "\"\nname = \"" + name + "\"\n", fields);
}

inline const std::string k_no_gravity = "gravity = [0.0, 0.0]\n";

} // namespace steplap::testing
