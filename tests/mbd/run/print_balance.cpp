// Prints which of many random scenes are taken for what they are: print_balance [first] [count].
#include "balance_scenes.h"

#include "mbd/run/report.h"
#include "transformer/program.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <exception>

int main(int argc, char** argv) {
  using namespace steplap;
  const long first = argc > 1 ? std::atol(argv[1]) : 0, count = argc > 2 ? std::atol(argv[2]) : 1000;
  long balancing = 0, missed = 0, sound = 0, alarms = 0, open = 0, failed = 0;
  for (long seed = first; seed < first + count; ++seed) {
    const BalanceScene scene = balance_scene(static_cast<std::uint64_t>(seed));
    try {
      const Report report = judged_run(load_model_text(scene.text, "scene.toml"));
      const bool is_found =
          std::any_of(report.findings.begin(), report.findings.end(), [](const Finding& f) { return f.code == "balances"; });
      (scene.balances ? balancing : sound) += 1;
      if (is_found != scene.balances) {
        (scene.balances ? missed : alarms) += 1;
        std::printf("%ld %s: %s %s\n", seed, scene.what.c_str(), scene.balances ? "missed" : "false alarm",
                    report.estimate.balance_unknown.c_str());
      } else if (!scene.balances && scene.is_sound && report.judgement.verdict != Verdict::hold) {
        ++open;
        std::printf("%ld %s: not hold\n", seed, scene.what.c_str());
      }
    } catch (const std::exception& failure) {
      ++failed;
      std::printf("%ld %s: %s\n", seed, scene.what.c_str(), failure.what());
    }
  }
  std::printf("%ld scenes that balance, %ld missed; %ld sound ones, %ld false alarms, %ld more not hold; %ld failed\n", balancing, missed,
              sound, alarms, open, failed);
  return 0;
}
