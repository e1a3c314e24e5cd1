// A mass of 1 kg on a spring along x, weightless, that leaves the spring's rest at a speed.
#pragma once

#include <string>

/// `tables`: [simulation], [output]; speed in m/s, stiffness in N/m.
inline std::string swing(const std::string& tables, const std::string& speed, const std::string& stiffness) {
  return "gravity = [0, 0]\n" + tables + "[[body]]\nname = \"mass\"\nmass = 1\ninertia = 1\nvelocity = [" + speed +
         ", 0]\n[[element]]\nkind = \"spring_damper\"\nname = \"spring\"\na = \"mass\"\nb = \"ground\"\naxis = [1, 0]\nstiffness = " +
         stiffness + "\n";
}
