// slip_ends FIRST LAST: random slips that end, against an integration of their own; a line for each that differs.
// slip_ends SEED: that scene as a model file.
#include "tests/random/slip_ends.h"

#include <cstdlib>
#include <exception>
#include <iostream>

int main(int count, char** arguments) {
  if (count == 2) {
    std::cout << steplap::random::model_text(steplap::random::slip_end_scene(std::strtoull(arguments[1], nullptr, 10)));
    return 0;
  }
  if (count != 3) {
    std::cerr << "usage: slip_ends FIRST LAST, or slip_ends SEED\n";
    return 2;
  }
  const std::uint64_t first = std::strtoull(arguments[1], nullptr, 10), last = std::strtoull(arguments[2], nullptr, 10);
  long wrong = 0;
  for (std::uint64_t seed = first; seed <= last; ++seed) {
    const auto scene = steplap::random::slip_end_scene(seed);
    std::string found;
    try {
      found = steplap::random::disagreement(scene);
    } catch (const std::exception& failure) {
      found = failure.what();
    }
    if (found.empty()) continue;
    ++wrong;
    std::cout << seed << " " << scene.integrator << " " << scene.tolerance << ": " << found << std::endl;
  }
  std::cout << last - first + 1 << " slips that end, " << wrong << " otherwise than they should\n";
  return wrong == 0 ? 0 : 1;
}
