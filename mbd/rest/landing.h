// Steps downhill on which many bodies land, each on its own.
//
// Bodies that rows, springs or closed contacts join are an island. Along a step no island knows of another until a contact
// between them closes; so each that nothing carries yet goes as far as to its own first one, and all land in one step. To cut the
// whole step at the first contact that closes, as a small scene's is, takes as many steps as bodies land.
#pragma once

#include "mbd/rest/statics.h"

#include <functional>
#include <vector>

namespace steplap {

class Landing {
public:
  /// At the last evaluation of `statics`.
  Landing(const System& system, const Statics& statics);

  struct Look {
    std::function<void(const VecX& step)> at;     ///< evaluates the statics a step away from where it begins
    std::function<double(const VecX& step)> room; ///< the share of a step from there that may be gone before the next look
  };
  /// Cuts the islands' parts of `step` where their first contact has just closed. `looks`: of each body (0 of the ground), how
  /// often the way it goes is to be looked at; `touch`, m: how far beyond the first contact an island goes, so that rounding does
  /// not open it again. False, and the step is as it was, if none closes or some within an island or between two that are carried
  /// already. The statics is left anywhere.
  bool cut(VecX& step, const std::vector<double>& looks, double touch, const Look& look);

private:
  struct Pair {
    int a = 0, b = 0, contact = 0;
  };
  void join_bodies();
  [[nodiscard]] int island(int body);
  [[nodiscard]] VecX cut_step(const VecX& step, const std::vector<double>& shares);
  [[nodiscard]] int lander(const Pair& pair, const VecX& step);
  [[nodiscard]] double next_share(const VecX& step, const std::vector<double>& looks, const Look& look, double share);
  [[nodiscard]] bool has_stopped(int island, double share) const;
  [[nodiscard]] bool find_first(const VecX& step, const std::vector<double>& looks, const Look& look);
  void close_in(const VecX& step, const Look& look);

  const System& system_;
  const Statics& statics_;
  std::vector<int> parent_;      ///< of bodies, by union and find; 0 is the ground, which joins nothing
  std::vector<Pair> open_;       ///< contacts that may close
  std::vector<char> is_carried_; ///< islands with a closed contact
  // Of each island: between which shares of the step its first contact closes, and the contacts that do.
  std::vector<double> low_, high_;
  std::vector<std::vector<int>> landed_;
};

} // namespace steplap
