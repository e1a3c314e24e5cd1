#include "mbd/rest/indifference.h"

#include <algorithm>

namespace steplap {

namespace {

constexpr std::size_t k_named = 6; // largest number of names in a sentence; further ones are counted

// Returns names as text: "'ball 1', 'ball 2' and 'ball 3'".
std::string names_text(const System& system, const std::vector<int>& bodies) {
  const std::size_t named = bodies.size() > k_named ? k_named - 1 : bodies.size();
  std::string text;
  for (std::size_t i = 0; i < named; ++i) {
    const bool is_last = i + 1 == bodies.size();
    text += std::string(i == 0 ? "" : is_last ? " and " : ", ") + "'" + system.bodies[bodies[i]].name + "'";
  }
  return named < bodies.size() ? text + " and " + std::to_string(bodies.size() - named) + " others" : text;
}

} // namespace

std::vector<std::string> indifference_texts(const System& system, const std::vector<MotionPart>& parts) {
  static constexpr const char* k_ways[] = {"along x", "along y", "from turning"};
  std::vector<std::string> texts;
  for (int coordinate = 0; coordinate < 3; ++coordinate) {
    std::vector<int> bodies;
    const MotionPart* only = nullptr;
    for (const MotionPart& part : parts)
      if (part.coordinate == coordinate) {
        bodies.push_back(part.body);
        only = &part;
      }
    std::sort(bodies.begin(), bodies.end());
    bodies.erase(std::unique(bodies.begin(), bodies.end()), bodies.end());
    if (bodies.size() == 1)
      texts.push_back("indifferent: nothing holds " + part_text(system, *only) + " or against it; it rests wherever it is");
    else if (!bodies.empty())
      texts.push_back("indifferent: nothing holds " + names_text(system, bodies) + " " + k_ways[coordinate] +
                      ", either way; they rest wherever they are");
  }
  return texts;
}

} // namespace steplap
