// Computes how far a block slides on a braking vehicle for different frictions of the deck. One model is run with many values on all
// processors:
//   friction_study braked_block.toml
#include <steplap/catalog.h>
#include <steplap/model.h>
#include <steplap/model_file.h>
#include <steplap/simulate.h>
#include <steplap/system.h>

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <thread>
#include <vector>

using namespace steplap;

struct Sample {
  double friction = 0.0;
  double slide = 0.0; // slide of the block forwards, m
};

// Each call has its own system and run. Only the models are shared between threads; they are not changed.
double slide_with(double friction, const Model& given, const Model& whole) {
  const auto system = instantiate(given, {{"element.deck friction.static_friction", friction}});
  const RunResult run = simulate(*system, start_of(whole, *system), options_of(whole));
  return run.trajectory->series("deck friction.slide").back();
}

int main(int argc, char** argv) try {
  if (argc != 2) {
    std::fprintf(stderr, "usage: friction_study braked_block.toml\n");
    return 2;
  }
  const Model given = read_given_model(argv[1], transformer_catalog());
  const Model whole = completed(given);

  std::vector<Sample> samples;
  for (int percent = 20; percent <= 70; percent += 2) samples.push_back({percent / 100.0});

  std::atomic<std::size_t> next = 0;
  const auto work = [&] {
    for (std::size_t i = next++; i < samples.size(); i = next++) samples[i].slide = slide_with(samples[i].friction, given, whole);
  };
  std::vector<std::thread> threads(std::max(1u, std::thread::hardware_concurrency()));
  for (std::thread& thread : threads) thread = std::thread(work);
  for (std::thread& thread : threads) thread.join();

  for (const Sample& sample : samples) std::printf("friction %.2f  slides %7.2f mm\n", sample.friction, 1e3 * sample.slide);
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
